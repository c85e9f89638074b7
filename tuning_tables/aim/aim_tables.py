"""The aim table: the exit speed at which a park position lets a cut go, so that it couples as fast as allowed; as
Python asks it (the rule itself is `programs.aim_speed`); and the aim tables of one position, with the choice among
them by weight category and by what is known of a cut.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated

import numpy as np

from tuning_tables.aim.axes import AimAxes, aim_grid
from tuning_tables.aim.nodes import NodeNumbers, Nodes, Reported, nodes_of, require_all
from tuning_tables.aim.purpose import FASTEST_M_S, AimCategory, MeasuredResistance, ParkPosition, Required
from tuning_tables.declared.members import require_declared
from tuning_tables.declared.numbers import Number, Row
from tuning_tables.errors import InvalidTable, require_kind, require_tuple
from tuning_tables.programs.aim_speed import AimGrid, exit_speed
from tuning_tables.provenance import CREATED, TABLE_NAME, Generator

LOWEST_M_S = 0.01


@dataclass(frozen=True, eq=False)
class AimTable:
    """A complete, checked aim table; it cannot be built otherwise, and nothing in it can be changed.

    There are resistances exactly where they were measured. The exit speeds have the shape of the axes, NaN where none
    keeps what is required.

    No exit speed is less than one for a smaller resistance, at the same cars and distance. With the distance and with
    the number of cars a speed may fall: where the track is steeper than a cut resists, it has to.

    Derived from these: `held`, what a controller holds, with one resistance of 0 in a table by category.

    Raises `InvalidTable`.

    Examples
    --------
    >>> from tuning_tables import Generator
    >>> from tuning_tables.aim import (
    ...     AimAxes,
    ...     AimCategory,
    ...     AimTable,
    ...     ParkPosition,
    ...     Reported,
    ...     Required,
    ... )
    >>> table = AimTable(
    ...     id="by-hand",
    ...     created="2026-11-27T12:00:00Z",
    ...     generator=Generator("by hand", "1", "0" * 64),
    ...     position=ParkPosition("my-park", exit_at_m=330.0),
    ...     category=AimCategory(3, "С"),
    ...     required=Required(p_overspeed=0.1, coupling_speed_m_s=1.4),
    ...     measured=None,
    ...     axes=AimAxes(cars=[1], free_distance_m=[100.0, 300.0]),
    ...     exit_speed_m_s=[[1.5, 2.5]],
    ...     bounds_m_s=(0.5, 7.0),
    ...     interpolation_error_m_s=0.05,
    ...     reported=Reported(
    ...         2000,
    ...         [[0.08, 0.09]],
    ...         [[0.07, 0.08]],
    ...         [[0.09, 0.1]],
    ...         mean_gap_m=[[12.5, 40.0]],
    ...     ),
    ... )
    >>> table
    AimTable(by-hand: 1 x 2 exit speeds)
    """

    id: Annotated[str, TABLE_NAME]
    created: Annotated[str, CREATED]
    generator: Generator
    position: ParkPosition
    category: AimCategory
    required: Required
    measured: MeasuredResistance | None
    axes: AimAxes
    exit_speed_m_s: Annotated[
        Nodes,
        NodeNumbers(
            "at cars, free distance and resistance; null: none keeps what is required", LOWEST_M_S, FASTEST_M_S
        ),
    ]
    bounds_m_s: Annotated[
        tuple[float, float],
        Row(Number("lowest and highest exit speed that the position is told", LOWEST_M_S, FASTEST_M_S), "end", 2, 2),
    ]
    interpolation_error_m_s: Annotated[
        float, Number("largest shortfall against an exact solution between nodes, as measured", 0.0, FASTEST_M_S)
    ]
    reported: Reported
    held: AimGrid = field(init=False, repr=False)

    def __post_init__(self) -> None:
        self._require_fields()
        speeds = nodes_of(self.exit_speed_m_s, "exit_speed_m_s", self.axes.shape)
        self._require_speeds(speeds)
        self.reported.require_nodes(speeds)
        speeds.setflags(write=False)
        object.__setattr__(self, "exit_speed_m_s", speeds)
        required = (self.required.p_overspeed, self.required.coupling_speed_m_s)
        held = aim_grid(self.axes, speeds, self.bounds_m_s, self.category.number, *required)
        object.__setattr__(self, "held", held)

    def __repr__(self) -> str:
        return f"AimTable({self.id}: {' x '.join(map(str, self.axes.shape))} exit speeds)"

    @property
    def is_measured(self) -> bool:
        """Whether the measured resistance of a cut is asked for."""
        return self.axes.resistance_n_per_kn is not None

    def _require_fields(self) -> None:
        require_declared(self)
        if self.is_measured is (self.measured is None):
            wanted = "null where" if self.measured is None else "an axis unless"
            raise InvalidTable(f"axes.resistance_n_per_kn must be {wanted} the category alone is known.")
        if not self.bounds_m_s[0] < self.bounds_m_s[1]:
            raise InvalidTable(f"bounds_m_s is {self.bounds_m_s!r}, but the lower bound must come first.")

    def _require_speeds(self, speeds: Nodes) -> None:
        key, (low, high) = "exit_speed_m_s", self.bounds_m_s
        null = np.isnan(speeds)
        require_all(null | ((low <= speeds) & (speeds <= high)), speeds, key, f"null, or within [{low!r}, {high!r}]")
        if self.is_measured:
            before = np.fmax.accumulate(speeds, axis=2)[:, :, :-1]
            holds = np.ones(speeds.shape, np.bool_)
            holds[:, :, 1:] = ~(speeds[:, :, 1:] < before)
            require_all(holds, speeds, key, "no less than for a smaller resistance")


def aim_exit_speed(
    table: AimTable, cars: int, free_distance_m: float, resistance_n_per_kn: float | None = None
) -> float | None:
    """Ask an aim table for a cut.

    Parameters
    ----------
    table
        The table of the category of the cut, and of what is known of it.
    cars
        Number of its cars.
    free_distance_m
        From the head of the cut to the standing cars, when its last axle leaves the position, m.
    resistance_n_per_kn
        Its rolling resistance as measured, N/kN. A table by category alone does not look at it; one by measured
        resistance has no answer without.

    Returns
    -------
    float or None
        The exit speed to command, m/s, a float32 number; None where the table has no answer.

    Raises
    ------
    TypeError
        `cars` is no whole number.

    Examples
    --------
    With `table` from the example of `AimTable`:

    >>> from tuning_tables.aim import aim_exit_speed
    >>> aim_exit_speed(table, cars=1, free_distance_m=200.0)
    2.0
    >>> aim_exit_speed(
    ...     table, cars=1, free_distance_m=50.0
    ... ) is None  # nearer than the table knows
    True
    """
    if not isinstance(cars, int | np.integer) or isinstance(cars, bool):
        raise TypeError(f"cars is {cars!r:.60}, but a cut has a whole number of cars.")
    with np.errstate(over="ignore"):  # what overflows gets no answer
        distance = np.float32(free_distance_m)
        resistance = np.float32(np.nan if resistance_n_per_kn is None else resistance_n_per_kn)
    speed = exit_speed(table.held, int(cars), distance, resistance)
    return float(speed) if speed >= 0.0 else None


@dataclass(frozen=True)
class AimTables:
    """The `tables` of one position, numbered in their order from 0; ids differ.

    There is one table at most for a category and a kind of knowledge; a category has one name, and a name one number.
    Raises `InvalidTable`.

    Examples
    --------
    With `table` from the example of `AimTable`:

    >>> from tuning_tables.aim import AimTables
    >>> AimTables((table,)).select(3, measured=False).id
    'by-hand'
    """

    tables: tuple[AimTable, ...]

    def __post_init__(self) -> None:
        require_tuple(self.tables, "tables")
        if not self.tables:
            raise InvalidTable("a set of aim tables holds at least one.")
        for index, table in enumerate(self.tables):
            require_kind(table, f"tables[{index}]", AimTable)
        first, times = self.tables[0], Counter(table.id for table in self.tables)
        places: dict[tuple[int, bool], str] = {}
        names: dict[int, str] = {}
        for table in self.tables:
            number, name = table.category.number, table.category.name
            if table.position != first.position:
                raise InvalidTable(
                    f"{table.id} is for the position {table.position.name}, {first.id} for {first.position.name}, or "
                    "they end elsewhere, but a set serves one position: export them apart."
                )
            if times[table.id] > 1:
                raise InvalidTable(f"the id {table.id} is given to {times[table.id]} aim tables.")
            if names.setdefault(number, name) != name:
                raise InvalidTable(f"the category number {number} stands for {names[number]} and for {name}.")
            other = places.setdefault((number, table.is_measured), table.id)
            if other != table.id:
                known = "its measured resistance" if table.is_measured else "it alone"
                raise InvalidTable(f"{other} and {table.id} are both for the category {name} by {known}: give one.")
        if len(set(names.values())) < len(names):
            raise InvalidTable(f"two of the category numbers {sorted(names)} stand for one name.")

    def __repr__(self) -> str:
        return f"AimTables({len(self.tables)} tables of {self.tables[0].position.name})"

    def select(self, category: int, measured: bool) -> AimTable | None:
        """The table for cuts of a category.

        Parameters
        ----------
        category
            Number of the weight category.
        measured
            Whether the resistance of the cut was measured.

        Returns
        -------
        AimTable or None
            None where there is no such table.
        """
        found = (each for each in self.tables if (each.category.number, each.is_measured) == (category, measured))
        return next(found, None)

    def exported_numbers(self) -> Mapping[str, int]:
        """The categories of the set and their numbers."""
        return {table.category.name: table.category.number for table in self.tables}
