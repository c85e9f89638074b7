"""An aim table read from its JSON document, as docs/reference/aim-table.md has it, and its rule in binary32
arithmetic, each operation stored and loaded.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from synth.checker.document_shape import (
    CHECKSUM,
    COUNT,
    NUMBER,
    ORIGIN,
    TEXT,
    Nodes,
    OrNull,
    Pair,
    Row,
    checked_document,
    refuse_unless,
    require_shape,
)
from synth.checker.float32 import rounded

NodeValues = tuple[tuple[tuple[float | None, ...], ...], ...]
"""By cars, free distance, resistance; one resistance in a table by category alone. None: no exit speed."""

AIM: Final = "aim"
FIGURES: Final = ("p_overspeed", "p_overspeed_low95", "p_overspeed_high95", "mean_gap_m")
AIM_SHAPE: Final[Mapping[str, Any]] = {
    **ORIGIN,
    "position": {"name": TEXT, "exit_at_m": NUMBER},
    "category": {"number": COUNT, "name": TEXT},
    "required": {"p_overspeed": NUMBER, "coupling_speed_m_s": NUMBER},
    "measured": OrNull({"from_m": NUMBER, "to_m": NUMBER, "speed_std_m_s": NUMBER}),
    "axes": {
        "cars": Row("cars", COUNT),
        "free_distance_m": Row("free_distance", NUMBER),
        "resistance_n_per_kn": OrNull(Row("resistance", NUMBER)),
    },
    "exit_speed_m_s": Nodes(),
    "bounds_m_s": Pair(),
    "interpolation_error_m_s": NUMBER,
    "reported": {"passes": COUNT, **dict.fromkeys(FIGURES, Nodes())},
    **CHECKSUM,
}
"""Of aim tables."""


@dataclass(frozen=True)
class Aim:
    """An aim table as the controller must understand it, and the document it was read from (less its checksum).

    `resistances` is empty in a table by category alone. `figures`: what was reported at the nodes, by name.
    """

    id: str
    category: int
    category_name: str
    p_overspeed: float
    coupling_m_s: float
    cars: tuple[int, ...]
    distances_m: tuple[float, ...]
    resistances: tuple[float, ...]
    speeds: NodeValues
    bounds_m_s: tuple[float, float]
    figures: Mapping[str, NodeValues]
    document: Mapping[str, Any]

    @property
    def is_measured(self) -> bool:
        """Whether the resistance of the cut is asked for."""
        return bool(self.resistances)

    def places(self) -> list[tuple[int, int, int]]:
        """The indices of all nodes, in their order in the file."""
        return [
            (c, d, r)
            for c in range(len(self.cars))
            for d in range(len(self.distances_m))
            for r in range(max(1, len(self.resistances)))
        ]


def read_aim(content: bytes) -> Aim:
    """The table in the JSON text `content`; `DamagedError` for whatever is not one, a wrong checksum among it."""
    return aim_of(checked_document(content, AIM, AIM_SHAPE))


def aim_of(document: Mapping[str, Any]) -> Aim:
    """The table in a document of the right shape; `DamagedError` where its arrays do not fit its axes."""
    axes, required = document["axes"], document["required"]
    resistances = tuple(map(float, axes["resistance_n_per_kn"] or ()))
    lengths = (len(axes["cars"]), len(axes["free_distance_m"]), *([len(resistances)] if resistances else []))
    low, high = document["bounds_m_s"]
    told = document["measured"] is not None
    refuse_unless(
        told == bool(resistances), axes["resistance_n_per_kn"], "axes.resistance_n_per_kn", "as it is measured"
    )
    return Aim(
        id=document["id"],
        category=document["category"]["number"],
        category_name=document["category"]["name"],
        p_overspeed=float(required["p_overspeed"]),
        coupling_m_s=float(required["coupling_speed_m_s"]),
        cars=tuple(axes["cars"]),
        distances_m=tuple(map(float, axes["free_distance_m"])),
        resistances=resistances,
        speeds=nodes_of(document["exit_speed_m_s"], lengths, "exit_speed_m_s"),
        bounds_m_s=(float(low), float(high)),
        figures={name: nodes_of(document["reported"][name], lengths, f"reported.{name}") for name in FIGURES},
        document=document,
    )


def nodes_of(value: Any, lengths: tuple[int, ...], path: str) -> NodeValues:
    """The numbers at the nodes, with a third axis in any case."""
    refuse_unless(isinstance(value, list) and len(value) == lengths[0], value, path, f"an array of {lengths[0]}")
    for c, rows in enumerate(value):
        right = isinstance(rows, list) and len(rows) == lengths[1]
        refuse_unless(right, rows, f"{path}[{c}]", f"an array of {lengths[1]}")
        for d, row in enumerate(rows if len(lengths) > 2 else ()):
            right = isinstance(row, list) and len(row) == lengths[2]
            refuse_unless(right, row, f"{path}[{c}][{d}]", f"an array of {lengths[2]}")
    plain = value if len(lengths) > 2 else [[[cell] for cell in rows] for rows in value]
    for c, rows in enumerate(plain):
        for d, row in enumerate(rows):
            for x in row:
                require_shape(x, OrNull(NUMBER), f"{path}[{c}][{d}]")
    return tuple(tuple(tuple(None if x is None else float(x) for x in row) for row in rows) for rows in plain)


def exit_speed(aim: Aim, cars: int, distance_m: float, resistance: float) -> float | None:
    """The exit speed in m/s that docs/reference/aim-table.md gives for a cut; None for no answer."""
    d, w = rounded(distance_m), rounded(resistance)
    if not aim.cars[0] <= cars <= aim.cars[-1] or not math.isfinite(d) or d < rounded(aim.distances_m[0]):
        return None
    if aim.is_measured and not math.isfinite(w):
        return None
    lower, upper, share = between(aim.resistances, w) if aim.is_measured else (0, 0, 0.0)
    # The listed numbers of cars between which the cut is; one where it is a listed number itself.
    around = {
        max(number for number in aim.cars if number <= cars),
        min(number for number in aim.cars if number >= cars),
    }
    found: list[float] = []
    for number in around:
        rows = aim.speeds[aim.cars.index(number)]
        first, second = (over_distance([row[column] for row in rows], aim.distances_m, d) for column in (lower, upper))
        speed = along(first, second, share)
        if speed is None:
            return None
        found.append(speed)
    return min(found)


def over_distance(speeds: Sequence[float | None], distances_m: Sequence[float], d: float) -> float | None:
    """The speed at distance `d` among those at the nodes; beyond the last its own, if it does not fall there."""
    if d > rounded(distances_m[-1]):
        before, last = speeds[-2:] if len(speeds) > 1 else (None, None)
        return rounded(last) if before is not None and last is not None and rounded(before) <= rounded(last) else None
    near, far, way = between(distances_m, d)
    return along(speeds[near], speeds[far], way)


def between(axis: Sequence[float], x: float) -> tuple[int, int, float]:
    """Node below, node above, part of the way; clamped to the axis."""
    nodes = [rounded(node) for node in axis]
    if x <= nodes[0]:
        return 0, 0, 0.0
    below = max(place for place, node in enumerate(nodes) if node <= x)
    if x == nodes[below] or below == len(nodes) - 1:
        return below, below, 0.0
    part = rounded(rounded(x - nodes[below]) / rounded(nodes[below + 1] - nodes[below]))
    return below, below + 1, part


def along(begin: float | None, end: float | None, part: float) -> float | None:
    """begin + part * (end - begin), not beyond end; None where there is none."""
    if begin is None or end is None:
        return None
    a, b = rounded(begin), rounded(end)
    speed = rounded(a + rounded(part * rounded(b - a)))
    return min(speed, b) if a < b else max(speed, b)
