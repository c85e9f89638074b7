"""What is typed behind `hump watch`."""

from __future__ import annotations

from pathlib import Path

from synth.frame.settings.options import BY_PLACE, NEEDED, Options, word_option, words_option


class YardWatchOptions(Options):
    """The file of the yard, which has no default, and what was repaired since the last run."""

    config: Path | None = word_option(BY_PLACE, "YARD.toml", NEEDED, "The positions that are watched.")
    repaired: tuple[str, ...] = words_option(
        "--repaired", "POSITION", (), "A position that is in order again: its watch begins anew with the passes of now."
    )
