"""Options of the command `hump design`."""

from __future__ import annotations

from pathlib import Path

from synth.frame.settings.options import BY_PLACE, Options, configured, word_option
from synth.hump.configuration.sections import DesignSettings


class DesignOptions(Options):
    """Which hump, and how fast cars are pushed over it."""

    config: Path | None = word_option(
        BY_PLACE, "CONFIG.toml|HUMP", None, "A hump trial, or a hump for the built-in trial."
    )
    speed: float | None = configured("--speed", "M/S", DesignSettings, "hump_speed_m_s", "Hump speed of the test, m/s")
