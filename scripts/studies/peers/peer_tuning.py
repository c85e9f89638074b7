"""How a peer is tuned: a grid on few passes, then simplex searches from its best points, for the least cost."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np

from plant_models.frozen_arrays import Floats
from scripts.studies.peers.peer_loop import PeerLoop, PeerRegulator, PredictiveController, PulseController
from synth.simulation.common_passes import CommonPasses
from synth.simulation.passes import ExitSample
from tuning_tables import Decisions, Estimator

STEP = 0.02
"""Of the bounds of a number, where its grid has one point."""

HELD = "held_share"
"""The number that says most about how a peer brakes, early or late: searches begin at different values of it."""


@dataclass(frozen=True)
class PeerFamily:
    """A peer with free numbers; `build(target, decisions, estimator, *values)` makes one of it.

    `names`, `grids` and `bounds` belong to the values; a simplex begins half a step of the grid wide, or `STEP`.
    """

    name: str
    build: Callable[..., PeerRegulator]
    names: tuple[str, ...]
    grids: tuple[tuple[float, ...], ...]
    bounds: tuple[tuple[float, float], ...]

    @property
    def steps(self) -> tuple[float, ...]:
        """How wide a simplex begins."""
        pairs = zip(self.grids, self.bounds, strict=True)
        return tuple(0.5 * (g[1] - g[0]) if len(g) > 1 else STEP * (high - low) for g, (low, high) in pairs)


@dataclass(frozen=True)
class Search:
    """`look`: passes for the grid; `starts` simplex searches of `evaluations` each, on all passes for tuning."""

    look: int
    starts: int
    evaluations: int


@dataclass(frozen=True)
class Aimed:
    """What is wanted of a peer: `price_m2_s2` is what a command costs beside the squared error, as in the criterion of
    tables; `estimator`: that of the table."""

    target_m_s: float
    price_m2_s2: float
    decisions: Decisions
    estimator: Estimator


@dataclass(frozen=True)
class TunedPeer:
    """A peer with the numbers found, its cost on the passes for tuning, and how many evaluations that took."""

    regulator: PeerRegulator
    parameters: Mapping[str, float]
    cost_m2_s2: float
    evaluations: int


def without_estimator(
    target_m_s: float, decisions: Decisions, _: Estimator, held: float, gain: float, integral_s: float, period_s: float
) -> PulseController:
    """The PI regulator by the measured speed."""
    return PulseController(target_m_s, decisions, None, held, gain, integral_s, period_s)


PREDICTIVE = PeerFamily(
    name="predictive",
    build=PredictiveController,
    names=("horizon_s", HELD, "shift_m_s", "price_m2_s2"),
    grids=((0.6, 0.9, 1.2), (0.03, 0.12, 0.24, 0.4), (0.0,), (0.0, 0.07, 0.2)),
    bounds=((0.2, 2.0), (0.0, 1.0), (-0.5, 0.5), (0.0, 3.0)),
)

PULSE_NUMBERS = (
    (HELD, "gain_per_m_s", "integral_s", "period_s"),
    ((0.05, 0.15, 0.25, 0.4), (1.0, 2.0, 4.0), (1.0, 3.0, 10.0), (0.15, 0.3, 0.6)),
    ((0.0, 1.0), (0.01, 20.0), (0.1, 1000.0), (0.1, 4.0)),
)

PULSES_MEASURED = PeerFamily("PI, measured speed", without_estimator, *PULSE_NUMBERS)
PULSES_ESTIMATED = PeerFamily("PI, estimated speed", PulseController, *PULSE_NUMBERS)

FAMILIES = (PREDICTIVE, PULSES_ESTIMATED, PULSES_MEASURED)


def tuned_peer(family: PeerFamily, loop: PeerLoop, passes: CommonPasses, aimed: Aimed, search: Search) -> TunedPeer:
    """The member of `family` of least cost on `passes`: mean square of the exit error and price of the commands.

    Deterministic.
    """
    from scipy.optimize import minimize  # start-up: scipy only where it is needed

    low, high = np.transpose(family.bounds)
    count = 0

    def regulator(values: Floats) -> PeerRegulator:
        numbers = np.clip(values, low, high).tolist()
        return family.build(aimed.target_m_s, aimed.decisions, aimed.estimator, *numbers)

    def cost(values: Floats, on: CommonPasses) -> float:
        nonlocal count
        count += 1
        return cost_of(loop.run(regulator(values), on.draws), aimed)

    def by_all(values: Any) -> Any:
        return cost(values, passes)

    few = passes.first(search.look)
    points = [np.array(point) for point in product(*family.grids)]
    costs = [cost(point, few) for point in points]
    found = []
    for start in apart(points, costs, family.names.index(HELD), search.starts):
        simplex = np.vstack([start, start + np.diag(family.steps)])
        limits: Any = {"initial_simplex": simplex, "maxfev": search.evaluations, "xatol": 1e-4, "fatol": 1e-8}
        found.append(minimize(by_all, start, method="Nelder-Mead", options=limits))
    best = min(found, key=lambda each: float(each.fun))
    values = np.clip(best.x, low, high)
    parameters = dict(zip(family.names, values.tolist(), strict=True))
    return TunedPeer(regulator(values), parameters, float(best.fun), count)


def apart(points: Sequence[Floats], costs: Sequence[float], number: int, count: int) -> list[Floats]:
    """The `count` best points that differ in `number`: neighbours of the best would find the same valley."""
    found: list[Floats] = []
    for i in sorted(range(len(points)), key=costs.__getitem__):
        if all(points[i][number] != each[number] for each in found):
            found.append(points[i])
    return found[:count]


def cost_of(sample: ExitSample, aimed: Aimed) -> float:
    """Mean square of the exit error, and the price of the mean number of commands, m²/s²."""
    square = (sample.exit_speed_m_s - aimed.target_m_s) ** 2 + aimed.price_m2_s2 * sample.switchings
    return float(np.average(square, weights=sample.weight))
