"""The classes of a book that a file of the user names: read, and of the position that the file means."""

from __future__ import annotations

from pathlib import Path

from plant_models import PlantError
from synth.frame.input_error import InputError
from synth.frame.settings.settings_file import BUILT_IN
from synth.retarder.configuration.config_file import load_config
from synth.retarder.forms.tables_at import tables_at
from synth.retarder.table_class import TableClass, table_classes


def book_classes(
    named: str, book: Path, tuned_with: Path | None, position: str, position_key: str = "position.name"
) -> tuple[TableClass, ...]:
    """The classes of the tables in `book`, in the closed loops of the configuration `tuned_with`, None: built in.

    `named` is what names the book, 'my.toml: aim.tables'; `position_key` names there the `position` that it must be of.
    Raises `InputError` for a book of another position or one that does not fit its configuration, `TableError` for a
    damaged one.
    """
    tables = tables_at(book).only_lines(named)
    for table in tables:
        if table.retarder.name != position:
            raise InputError(
                f"{named} names {book}, whose table {table.id} is for the position {table.retarder.name}, but "
                f"{position_key} is {position}; give a book of that position"
            )
    config = load_config(tuned_with)
    try:
        return table_classes(tables, config, str(tuned_with or BUILT_IN))
    except PlantError as fault:
        raise InputError(unfitting(named, book, fault)) from None


def unfitting(named: str, book: Path, fault: PlantError) -> str:
    """The sentence for a book that does not fit what it is named for."""
    return f"{named} names {book}, which does not fit: {fault}"
