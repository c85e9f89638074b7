"""Options of the command `sensitivity`."""

from __future__ import annotations

from pathlib import Path

from synth.frame.settings.options import Options, number_option, word_option


class SensitivityOptions(Options):
    """Options of the command line."""

    table: Path | None = word_option("--table", "TABLE|BOOK|DIR", None, "Tables to ask; those of a tune unless given.")
    points: int = number_option("--points", "N", 1000, 200, 100_000, "Plants that are tried.")
    passes: int = number_option("--passes", "N", 200, 100, 100_000, "Passes of a table on each plant.")
    seed: int | None = number_option("--seed", "N", None, 0, 2**53, "Of plants and passes; as configured unless given.")
