"""Options of the command `sweep run`."""

from __future__ import annotations

from pathlib import Path

from synth.frame.settings.options import BY_PLACE, NEEDED, word_option
from synth.frame.workers.engine_options import EngineOptions


class SweepOptions(EngineOptions):
    """What is swept, and by whom."""

    config: Path = word_option(BY_PLACE, "CONFIG.toml", NEEDED, "Its table [sweep] says what is swept.")
