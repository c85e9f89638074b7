"""Options of the command `sensors tune`."""

from __future__ import annotations

from pathlib import Path

from synth.frame.settings.options import BY_PLACE, word_option
from synth.retarder.solving_options import SolvingOptions


class SensorsTuneOptions(SolvingOptions):
    """Options of the command line."""

    config: Path | None = word_option(
        BY_PLACE, "CONFIG.toml", None, "With [sensors]; what 'init point-sensors' prints unless given."
    )
