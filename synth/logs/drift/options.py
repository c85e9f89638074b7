"""Options of the command `watch`."""

from __future__ import annotations

from pathlib import Path

from synth.frame.settings.options import words_option
from synth.logs.log_options import LogOptions


class WatchOptions(LogOptions):
    """Options of the command line."""

    reference: tuple[Path, ...] = words_option(
        "--reference", "LOG", (), "Passes known to be in order: drifts are counted from their numbers."
    )
