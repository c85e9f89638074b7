"""Options of the command `tune`."""

from __future__ import annotations

from typing import Final

from synth.frame.settings.options import flag_option
from synth.retarder.solving_options import SolvingOptions

TUNE: Final = "tune"
"""Name of the command, with a radar and with point sensors."""


class TuneOptions(SolvingOptions):
    """Options of the command line."""

    pareto: bool = flag_option("--pareto", "Also tell what less time in the position costs; takes long.")
