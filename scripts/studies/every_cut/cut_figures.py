"""Ordinary cases drawn at random over the whole library (a position, a cut of equal cars, a usual exit speed), and
what is found of one: its table, and the best of the tuned rules on the same passes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from random import Random
from typing import TypeVar

from plant_models.library import PositionEntry, car_names, load_car, load_position, position_names
from synth.simulation.replicates import Interval

CARS_OF_A_CUT = (1, 2, 3, 4, 6, 8, 10)
LIGHTEST_T, HEAVIEST_T = 23.0, 84.0
"""Of one car, within tare and gross mass of its type."""

BELOW_USUAL_M_S = 0.2
"""So much slower than the slowest usual exit speed of a position may be asked for, within its sensible range."""

TARGETS = "targets.exit_speeds_m_s"

_T = TypeVar("_T")


@dataclass(frozen=True)
class RandomCase:
    """Case `number` of a row: a cut of `cars` equal cars and of `mass_t` as a whole, to leave at `target_m_s`."""

    number: int
    position: str
    car: str
    cars: int
    mass_t: float
    target_m_s: float

    @property
    def name(self) -> str:
        """'17: knp-5-bunch, 3 × box-4, 180.3 t to 2.4 m/s'."""
        return f"{self.number}: {self.position}, {self.cars} × {self.car}, {self.mass_t:g} t to {self.target_m_s:g} m/s"

    def text(self, passes: int, seed: int) -> str:
        """The configuration of this case alone, simulated on so many passes of `seed`, in TOML."""
        return (
            f'[position]\nname = "{self.position}"\n\n[targets]\nexit_speeds_m_s = [{self.target_m_s}]\n\n'
            f"[validation]\npasses = {passes}\nseed = {seed}\n\n"
            f'[[cut]]\ncar = "{self.car}"\ncars = {self.cars}\nmass_t = {self.mass_t}\n'
        )


def random_case(seed: int, number: int) -> RandomCase:
    """Case `number` of the endless row that `seed` stands for; it depends on these two and the library alone."""
    random = Random(f"{seed}:{number}")
    position = load_position(one_of(position_names(), random))
    car = load_car(one_of(car_names(), random))
    cars = one_of(CARS_OF_A_CUT, random)
    mass_t = between(max(LIGHTEST_T, car.car.tare_t), min(HEAVIEST_T, car.car.gross_t), random)
    target_m_s = round(between(*usual_targets_m_s(position), random), 1)
    return RandomCase(number, position.name, car.name, cars, round(cars * mass_t, 1), target_m_s)


def one_of(members: Sequence[_T], random: Random) -> _T:
    """One of `members`, all alike. Of `Random` only `random` is the same in every version of Python."""
    return members[int(random.random() * len(members))]


def between(low: float, high: float, random: Random) -> float:
    """Uniform between `low` and `high`."""
    return low + (high - low) * random.random()


def usual_targets_m_s(position: PositionEntry) -> tuple[float, float]:
    """From somewhat below the slowest usual exit speed to the fastest, sensible and no faster than any cut enters."""
    (usual,) = (value for value in position.provenance if value.key == TARGETS)
    assert usual.range is not None
    least, most = usual.range
    speeds = position.target_speeds_m_s
    return max(least, min(speeds) - BELOW_USUAL_M_S), min(most, max(speeds), position.entry.low_m_s)


ALLOWED_LOSS = 1.02
"""A table is worse than a rule if its rms is more than so many times the rule's, and the interval leaves no doubt."""

HONEST = (0.90, 1.10)
"""Predicted rms / simulated rms."""


@dataclass(frozen=True)
class Beside:
    """A tuned rule on the passes of the table; `ratio`: rms of the table / its own, paired, with its 95 % interval."""

    rule: str
    rms_m_s: float
    switchings: float
    ratio: float
    ratio_ci95: Interval

    @property
    def beaten_by(self) -> bool:
        """Whether the rule is better than the table."""
        return self.ratio > ALLOWED_LOSS and self.ratio_ci95[0] > 1.0


@dataclass(frozen=True)
class BesideWithout:
    """The table beside that of the same tune without estimator: rms / its rms, paired, with the 95 % interval.

    `ratio`: on the plant of the tables; `weak_ratio`: where all friction is 0.8 of it.
    """

    ratio: float
    ratio_ci95: Interval
    weak_ratio: float
    weak_ratio_ci95: Interval

    @property
    def worse(self) -> bool:
        """Whether the table is worse on one of the plants."""
        pairs = (self.ratio, self.ratio_ci95), (self.weak_ratio, self.weak_ratio_ci95)
        return any(ratio > ALLOWED_LOSS and ci95[0] > 1.0 for ratio, ci95 in pairs)


@dataclass(frozen=True)
class CutFigures:
    """The table of a case, simulated; `length_m`: path of a pass, from where the regulator acts to the exit.

    `designed_again`: the grid of the first design was not believed.
    `feasible`: the position does not forbid the limit on the rms. `best`: of all rules. `without`: no estimator.
    """

    case: RandomCase
    length_m: float
    rms_m_s: float
    rms_ci95_m_s: Interval
    predicted_rms_m_s: float
    designed_again: bool
    switchings: float
    feasible: bool
    best: Beside
    without: BesideWithout

    @property
    def prediction_ratio(self) -> float:
        """Predicted / simulated rms."""
        return self.predicted_rms_m_s / self.rms_m_s

    @property
    def prediction_ratio_ci95(self) -> Interval:
        """Its 95 % interval."""
        low, high = self.rms_ci95_m_s
        return self.predicted_rms_m_s / high, self.predicted_rms_m_s / low

    @property
    def honest(self) -> bool:
        """Whether the passes leave it open that the prediction is as near as asked."""
        low, high = self.prediction_ratio_ci95
        return low <= HONEST[1] and high >= HONEST[0]


@dataclass(frozen=True)
class Untuned:
    """A case that no table could be made for, and why."""

    case: RandomCase
    reason: str


Outcome = CutFigures | Untuned
