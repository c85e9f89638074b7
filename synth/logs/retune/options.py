"""Options of the command `retune`."""

from __future__ import annotations

from pathlib import Path

from synth.frame.settings.options import word_option
from synth.logs.log_options import LogOptions


class RetuneOptions(LogOptions):
    """Options of the command line."""

    table: Path | None = word_option(
        "--table", "TABLE|BOOK|DIR", None, "What runs now; the configuration's own tables unless given."
    )
