"""Tables from which a controller takes stages, of both kinds of decision, wherever they lie."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tuning_tables.table_kinds import StageTable


def any_tables(source: Path) -> list[StageTable]:
    """The tables at `source`, of both kinds of decision; faults as `read_tables` has them."""
    from synth.retarder.forms.passage_file import read_passages
    from synth.retarder.forms.table_file import holds_tables, read_tables

    passages = read_passages(source)
    if passages and not holds_tables(source):
        return list(passages)
    return [*passages, *(table for file in read_tables(source, directory_allowed=True) for table in file.tables)]
