"""Options of the command `hump compare`."""

from __future__ import annotations

from pathlib import Path

from synth.frame.settings.options import BY_PLACE, NEEDED, Options, word_option, words_option


class CompareOptions(Options):
    """The directories of runs; the first is what others are compared with."""

    config: Path | None = word_option(BY_PLACE, "DIR", NEEDED, "A directory of 'hump simulate': the first run.")
    others: tuple[Path, ...] = words_option(BY_PLACE, "DIR...", NEEDED, "Others, which are compared with the first.")
