"""The park position of an aim configuration as it obeys commands: with a normal error, or as its own tables make it."""

from __future__ import annotations

from pathlib import Path

from plant_models import PlantError
from synth.faults.input_error import InputError
from synth.yard.position_models import NormalPosition, PositionModel
from synth.yard.resolved_aim import ResolvedAim


def position_of(config: ResolvedAim) -> PositionModel:
    """The model that the configuration asks for; `InputError` for a book that does not fit, `TableError` if damaged."""
    if config.book is None:
        assert config.exit_std_m_s is not None
        return NormalPosition(config.exit_std_m_s)
    return tabled(config, *config.book)


def tabled(config: ResolvedAim, book: Path, tuned_with: Path | None) -> PositionModel:
    """The closed loops of the tables in `book`, for every category and number of cars that is asked for."""
    from synth.book.forms.table_file import read_tables
    from synth.configuration.config_file import BUILT_IN, load_config
    from synth.yard.table_position import table_position

    (file,) = read_tables(book)
    for table in file.tables:
        if table.retarder.name != config.position_name:
            raise InputError(
                f"{config.place}: aim.tables names {book}, whose table {table.id} is for the position "
                f"{table.retarder.name}, but position.name is {config.position_name}; give a book of that position"
            )
    plant = load_config(tuned_with)
    try:
        position = table_position(file.tables, plant, str(tuned_with or BUILT_IN))
        for member in config.members:
            for cars in config.cars:
                position.able(config.scene.draw(member, cars, config.simulation.seed, 0, 1))
    except PlantError as fault:
        raise InputError(f"{config.place}: aim.tables names {book}, which does not fit: {fault}") from None
    return position
