"""Options of the command `replay`."""

from __future__ import annotations

from pathlib import Path

from synth.frame.settings.options import NEEDED, word_option
from synth.logs.log_options import LogOptions


class ReplayOptions(LogOptions):
    """Options of the command line."""

    table: Path = word_option("--table", "TABLE|BOOK|DIR", NEEDED, "The tables to try.")
    own: Path | None = word_option(
        "--own", "TABLE|BOOK|DIR", None, "What drove the log; the configuration's own tables unless given."
    )
