"""What is typed behind `hump make`."""

from __future__ import annotations

from pathlib import Path

from synth.frame.settings.options import BY_PLACE, NEEDED, Options, word_option


class MakeOptions(Options):
    """The short file, which has no default."""

    config: Path | None = word_option(BY_PLACE, "SHORT.toml", NEEDED, "The short hump file.")
