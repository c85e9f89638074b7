"""How fast may trains be humped at a share of catch-ups: over the least interval of the program, on common trains."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from plant_models.frozen_arrays import Floats
from scripts.studies.aiming.trial import Value
from scripts.studies.humping.base_trial import FEEDBACK, MEASURED, OPEN, SLOWING, with_interval_std, with_planner
from scripts.studies.humping.day_figures import DayFigures, day_figures, fewer_catch_ups
from scripts.studies.humping.runs import Group
from synth.hump.capacity.curves import Sums, decided, drawn_weights, enough_for, sums_of
from synth.hump.rolling.outcomes import TrainOutcomes
from synth.hump.trial.trial import HumpTrial

CONTROLS = {
    "open loop": OPEN,
    "feedback": FEEDBACK,
    "feedback, resistance measured": MEASURED,
    "feedback, train slowed down": SLOWING,
}
OPEN_LOOP, WITH_FEEDBACK, WITH_MEASURED, WITH_SLOWING = CONTROLS


@dataclass(frozen=True)
class Point:
    """One program of a curve; `fewer`: by how much the share of catch-ups is less than in open loop, None there and
    where the positions were not run in open loop."""

    least_s: float
    figures: DayFigures
    fewer: Value | None


@dataclass(frozen=True)
class AtLimit:
    """Where a curve has the share `limit` of catch-ups: mean hump speed and cars an hour, with bootstrap intervals.

    None where the trains do not decide it. `least_m_s`, `most_m_s`: ends of the curve.
    """

    limit: float
    hump_speed_m_s: Value | None
    cars_per_hour: Value | None
    least_m_s: float
    most_m_s: float


@dataclass(frozen=True)
class AtSpeed:
    """Share of catch-ups where a curve has a mean hump speed; None where it is beyond the ends of the curve."""

    hump_speed_m_s: float
    catch_ups: Value | None


@dataclass(frozen=True)
class Curve:
    """All programs with one kind of positions and one control."""

    positions: str
    control: str
    points: tuple[Point, ...]
    at_limits: tuple[AtLimit, ...]
    at_speeds: tuple[AtSpeed, ...]

    @property
    def name(self) -> str:
        """Tells it from the others."""
        return name_of(self.positions, self.control)


@dataclass(frozen=True)
class Gain:
    """Mean hump speed at a limit that one curve has more than another, on the same trains; None: not decided."""

    limit: float
    more: str
    than: str
    hump_speed_m_s: Value | None
    cars_per_hour: Value | None


@dataclass(frozen=True)
class Family:
    """The curves of one kind of positions, one for each of `controls`."""

    trial: HumpTrial
    controls: tuple[str, ...]


Families = Mapping[str, Family]
"""By the names of their positions."""

Line = tuple[str, str]
"""Positions and control of a curve."""


def sigma(std_m_s: float) -> str:
    """Normal positions by name."""
    return f"σ {std_m_s:g}"


def name_of(positions: str, control: str, least_s: float | None = None) -> str:
    """The trial of a point, or a curve."""
    curve = f"{positions}, {control}"
    return curve if least_s is None else f"{curve}, {least_s:g} s"


def normal_families(base: HumpTrial, stds_m_s: tuple[float, ...]) -> Families:
    """A family an exactness of the interval positions, with every control."""
    return {sigma(std): Family(with_interval_std(base, std), tuple(CONTROLS)) for std in stds_m_s}


def frontier_groups(families: Families, least_s: tuple[float, ...]) -> list[Group]:
    """A group a program: all curves at it. Families must share what programs depend on."""
    first = next(iter(families.values())).trial
    groups = []
    for least in least_s:
        planner = with_planner(first, least_s=least).planner
        groups.append(
            Group(
                {
                    name_of(positions, control, least): replace(
                        family.trial, planner=planner, control=CONTROLS[control]
                    )
                    for positions, family in families.items()
                    for control in family.controls
                }
            )
        )
    return groups


@dataclass(frozen=True)
class Frontier:
    """All curves on the same trains, from the outcomes of their trials by name."""

    outcomes: dict[str, TrainOutcomes]
    lines: tuple[Line, ...]
    least_s: tuple[float, ...]
    limits: tuple[float, ...]
    speeds_m_s: tuple[float, ...]
    seed: int

    def curves(self) -> tuple[Curve, ...]:
        """Those of all lines."""
        return tuple(map(self.curve, self.lines))

    def of(self, line: Line) -> list[TrainOutcomes]:
        """The outcomes of a curve, safest program first."""
        return [self.outcomes[name_of(*line, least)] for least in self.least_s]

    def sums(self, line: Line) -> Sums:
        """The sums of a curve over common bootstrap draws."""
        outcomes = self.of(line)
        return sums_of(outcomes, drawn_weights(len(outcomes[0]), self.seed))

    def curve(self, line: Line) -> Curve:
        """One of them."""
        positions, control = line
        outcomes, sums = self.of(line), self.sums(line)
        figures = list(map(day_figures, outcomes))
        fewer: list[Value | None] = [None] * len(outcomes)
        if control != OPEN_LOOP and (positions, OPEN_LOOP) in self.lines:
            fewer = [fewer_catch_ups(*both) for both in zip(self.of((positions, OPEN_LOOP)), outcomes, strict=True)]
        limits = tuple(self.at_limit(sums, limit, outcomes[0]) for limit in self.limits)
        speeds = tuple(AtSpeed(each, told(sums.at_speed(each), len(outcomes[0]))) for each in self.speeds_m_s)
        return Curve(*line, tuple(map(Point, self.least_s, figures, fewer)), limits, speeds)

    def at_limit(self, sums: Sums, limit: float, trains: TrainOutcomes) -> AtLimit:
        """Where a curve has this share."""
        speed, cars = sums.crossing(limit) if self.enough(limit, trains) else (np.full(2, np.nan),) * 2
        ends = float(sums.hump_speed_m_s[0].min()), float(sums.hump_speed_m_s[0].max())
        return AtLimit(limit, told(speed, len(trains)), told(cars, len(trains)), *ends)

    def enough(self, limit: float, trains: TrainOutcomes) -> bool:
        """Whether the trains carry a share as small as this."""
        return enough_for(limit, int(trains.cuts.sum()))

    def gain(self, more: Line, than: Line, limit: float) -> Gain:
        """Of one curve over another, at a limit."""
        found: list[Value | None] = [None, None]
        if self.enough(limit, self.of(more)[0]):
            with np.errstate(invalid="ignore"):  # ∞ − ∞ decides nothing
                between = [
                    one - other
                    for one, other in zip(self.sums(more).crossing(limit), self.sums(than).crossing(limit), strict=True)
                ]
            found = [told(each, len(self.of(more)[0])) for each in between]
        return Gain(limit, name_of(*more), name_of(*than), *found)


def told(values: Floats, trains: int) -> Value | None:
    """What bootstrap values decide, as studies hold it."""
    found = decided(values, trains)
    return None if found is None else Value(found.value, (found.low95, found.high95))


def lines_of(*parts: Families) -> tuple[Line, ...]:
    """Those of all families."""
    return tuple((name, control) for part in parts for name, family in part.items() for control in family.controls)
