"""Options of commands on exported tables: which, and by which configuration."""

from __future__ import annotations

from pathlib import Path

from synth.frame.settings.options import BY_PLACE, NEEDED, Options, word_option


class TablesOptions(Options):
    """Options of the command line of a command on tables; `loop` and `explore` have no other."""

    source: Path = word_option(BY_PLACE, "TABLE|BOOK|DIR", NEEDED, "A table, a book, or a folder of tables.")
    config: Path | None = word_option(
        "--config", "C", None, "Configuration with the plant; that of the tables, or built-in, unless given."
    )
