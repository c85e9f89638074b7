"""What is shown of aim tables first: the exit speeds that the position is told, as pictures and as cards."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from synth.aim.aim_book import AimBook, MadeAim
from synth.frame.exhibits import Chart, Column, Exhibit, Table
from synth.frame.printed_numbers import decimals
from synth.retarder.tuned_case import file_stem
from tuning_tables.aim import AimTable


def command_charts(book: AimBook) -> Iterator[Exhibit]:
    """Exit speeds over free distance, by cars and by measured resistance."""
    if "category" in book.config.aim.knowledge:
        yield Chart(
            "aim-commands-by-cars",
            "Exit speed by category and cars",
            "Exit speeds of the tables by category: what the park position is told. No mark: no exit speed keeps the "
            "required chance.",
            lambda: _pictures().commands_by_cars(tables_of(book, measured=False)),
        )
    if "measured" in book.config.aim.knowledge:
        yield Chart(
            "aim-commands-by-resistance",
            "Exit speed by measured resistance",
            "Exit speeds of the tables by measured resistance, for the shortest cuts, at some resistances between the "
            "ends that each panel names. No mark: no exit speed keeps the required chance.",
            lambda: _pictures().commands_by_resistance(tables_of(book, measured=True)),
        )


def cards(book: AimBook) -> Iterator[Exhibit]:
    """A table of exit speeds for each category, where it is all that is known of a cut besides its cars."""
    distances = book.config.aim.free_distances_m
    columns = (
        Column("cars", "cars"),
        *(Column(f"at_{distance:g}_m", f"at {distance:g} m", "m/s", decimals(3)) for distance in distances),
    )
    for made in book.tables:
        if not made.table.is_measured:
            title = f"Exit speed by cars and free distance: category {made.category.label}"
            yield Table(file_stem("card", made.category.latin), title, columns, tuple(card_rows(made)))


def card_rows(made: MadeAim) -> Iterator[dict[str, Any]]:
    """A row for each number of cars; no figure where no exit speed keeps what is asked."""
    order = made.speeds.order
    for cars, speeds in zip(order.cars, made.speeds.speed_m_s, strict=True):
        told = zip(order.free_distances_m, speeds.reshape(len(order.free_distances_m), -1)[:, 0], strict=True)
        yield {"cars": cars, **{f"at_{distance:g}_m": float(speed) for distance, speed in told}}


def tables_of(book: AimBook, *, measured: bool) -> list[AimTable]:
    """The tables of one kind of knowledge."""
    return [made.table for made in book.tables if made.table.is_measured is measured]


def _pictures() -> Any:
    from synth.aim import pictures  # matplotlib

    return pictures
