"""The default of studies whose findings are those of a regulator that acts from the entrance on."""

from __future__ import annotations

from pathlib import Path

from synth.retarder.configuration.config_file import load_config, parse_config
from synth.retarder.configuration.resolved_config import ResolvedConfig


def from_the_entrance(config: Path | None) -> ResolvedConfig:
    """The configuration in the file `config`; without one, the default book without approach."""
    if config is not None:
        return load_config(config)
    return parse_config("[regulator]\napproach_m = 0.0\n", "the default book without approach")
