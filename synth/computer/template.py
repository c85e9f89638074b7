"""A commented configuration of a control computer to start from."""

from __future__ import annotations

from synth.computer.settings import ComputerSettings
from synth.frame.settings.template import template


def default_computer_toml() -> str:
    """The defaults as TOML; it reads back to the same configuration."""
    return template(ComputerSettings(), "Control computer of a hump", "computer")
