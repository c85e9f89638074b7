"""The commented table [sweep] of a configuration to start from."""

from __future__ import annotations

from synth.frame.settings.template import template
from synth.retarder.sweep.sweep_settings import SweepTable


def default_sweep_toml() -> str:
    """The defaults as TOML; it reads back to the same sweep."""
    return template(SweepTable(), "Sweep over classes, targets and conditions", "sweep run")
