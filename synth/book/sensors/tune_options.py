"""Options of the command `sensors tune`."""

from __future__ import annotations

from pathlib import Path

from synth.frame.settings.options import BY_PLACE, Options, number_option, word_option


class SensorsTuneOptions(Options):
    """Options of the command line."""

    config: Path | None = word_option(
        BY_PLACE, "CONFIG.toml", None, "With [sensors]; what 'init --sensors' prints unless given."
    )
    workers: int | None = number_option(
        "--workers", "N", None, 1, 256, "Cut classes solved at once; by default one a processor."
    )
