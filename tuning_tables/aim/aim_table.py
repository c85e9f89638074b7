"""The aim table: the exit speed at which a park position lets a cut go, so that it couples as fast as allowed."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from tuning_tables.aim.axes import AimAxes
from tuning_tables.aim.held_aim import aim_grid
from tuning_tables.aim.nodes import Nodes, nodes_of, require_all
from tuning_tables.aim.purpose import FASTEST_M_S, AimCategory, CategoryAlone, Knowledge, ParkPosition, Required
from tuning_tables.aim.reported import Reported
from tuning_tables.errors import InvalidTable
from tuning_tables.programs.aim_table import AimGrid
from tuning_tables.provenance import Generator
from tuning_tables.requirement import (
    UTC_INSTANT,
    require_between,
    require_kind,
    require_match,
    require_text,
    require_tuple,
)

LOWEST_M_S = 0.01


@dataclass(frozen=True, eq=False)
class AimTable:
    """A complete, checked aim table; it cannot be built otherwise, and nothing in it can be changed.

    id, created       name of the table; UTC instant "2026-11-20T22:46:00Z", given by the caller
    generator         what made it
    position, category, required, knowledge   what it is for
    axes              with resistances exactly where `knowledge` is a `MeasuredResistance`
    exit_speed_m_s    at the nodes, the shape of `axes`; NaN where no exit speed keeps what is required
    bounds_m_s        (lowest, highest) exit speed that the position is told, within [0.01, 40]
    interpolation_error_m_s   largest shortfall against an exact solution between nodes, as the maker measured it
    reported          what cuts did, at the same nodes

    No exit speed is less than one for a smaller resistance, at the same cars and distance. With the distance and with
    the number of cars a speed may fall: where the track is steeper than a cut resists, it has to.

    Derived from these: `held`, what a controller holds, with one resistance of 0 in a table by category.

    Raises `InvalidTable`.
    """

    id: str
    created: str
    generator: Generator
    position: ParkPosition
    category: AimCategory
    required: Required
    knowledge: Knowledge
    axes: AimAxes
    exit_speed_m_s: Nodes
    bounds_m_s: tuple[float, float]
    interpolation_error_m_s: float
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

    @property
    def is_measured(self) -> bool:
        """Whether the measured resistance of a cut is asked for."""
        return self.axes.resistance_n_per_kn is not None

    def _require_fields(self) -> None:
        require_text(self.id, "id")
        require_match(self.created, "created", UTC_INSTANT, "2026-11-20T22:46:00Z")
        require_kind(self.generator, "generator", Generator)
        require_kind(self.position, "position", ParkPosition)
        require_kind(self.category, "category", AimCategory)
        require_kind(self.required, "required", Required)
        require_kind(self.axes, "axes", AimAxes)
        require_kind(self.reported, "reported", Reported)
        if self.is_measured is isinstance(self.knowledge, CategoryAlone):
            wanted = "null where" if isinstance(self.knowledge, CategoryAlone) else "an axis unless"
            raise InvalidTable(f"axes.resistance_n_per_kn must be {wanted} the category alone is known.")
        require_tuple(self.bounds_m_s, "bounds.exit_speed_m_s", 2)
        low, high = self.bounds_m_s
        require_between(low, "bounds.exit_speed_m_s[0]", LOWEST_M_S, FASTEST_M_S)
        require_between(high, "bounds.exit_speed_m_s[1]", LOWEST_M_S, FASTEST_M_S)
        if not low < high:
            raise InvalidTable(f"bounds.exit_speed_m_s is {self.bounds_m_s!r}, but the lower bound must come first.")
        require_between(self.interpolation_error_m_s, "interpolation.error_m_s", 0.0, FASTEST_M_S)

    def _require_speeds(self, speeds: Nodes) -> None:
        key, (low, high) = "exit_speed_m_s", self.bounds_m_s
        null = np.isnan(speeds)
        require_all(null | ((low <= speeds) & (speeds <= high)), speeds, key, f"null, or within [{low!r}, {high!r}]")
        if self.is_measured:
            before = np.fmax.accumulate(speeds, axis=2)[:, :, :-1]
            holds = np.ones(speeds.shape, np.bool_)
            holds[:, :, 1:] = ~(speeds[:, :, 1:] < before)
            require_all(holds, speeds, key, "no less than for a smaller resistance")
