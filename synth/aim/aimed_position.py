"""The park position of an aim configuration as it obeys commands: with a normal error, or as its own tables make it."""

from __future__ import annotations

from pathlib import Path

from plant_models import PlantError
from synth.aim.position_models import NormalPosition, PositionModel
from synth.aim.resolved_aim import ResolvedAim
from synth.frame.input_error import InputError


def position_of(config: ResolvedAim) -> PositionModel:
    """The model that the configuration asks for; `InputError` for a book that does not fit, `TableError` if damaged."""
    if config.book is None:
        assert config.exit_std_m_s is not None
        return NormalPosition(config.exit_std_m_s)
    return tabled(config, *config.book)


def tabled(config: ResolvedAim, book: Path, tuned_with: Path | None) -> PositionModel:
    """The closed loops of the tables in `book`, for every category and number of cars that is asked for."""
    from synth.aim.table_position import TablePosition
    from synth.retarder.book_classes import book_classes, unfitting

    named = f"{config.place}: aim.tables"
    position = TablePosition(book_classes(named, book, tuned_with, config.position_name))
    try:
        for member in config.members:
            for cars in config.cars:
                position.able(config.scene.draw(member, cars, config.simulation.seed, 0, 1))
    except PlantError as fault:
        raise InputError(unfitting(named, book, fault)) from None
    return position
