"""An aim tried several times: commands chosen on some cuts at one probability of over-speed, judged on others, and
both anew in each replicate; and how far from the crest a norm of the gap is met.

Commands that keep the probability of over-speed over all cuts, whatever is known of them. A kind of knowledge gives
commands for a level of probability. Cuts that no command serves are commanded the lowest one, and couple too fast more
often than that level; so the level for all is lowered until the share over all cuts is kept. Every kind of knowledge is
compared at the same share of over-speeds so.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Floats, frozen_arrays
from plant_models.library.weight_category import WeightCategory
from scripts.studies.aiming.cuts import AimedCuts, FromCrest, Places, RolledCuts, rolled_cuts
from scripts.studies.aiming.refinements import NearestRecord
from synth.aim.knowledge import Commands, Knowledge, Requirement
from synth.aim.position_models import Couplings, PositionModel
from synth.aim.scene import AimScene, SceneCuts
from synth.simulation.replicates import Interval, student_quantile

BOUNDS_M_S = (0.5, 7.0)
"""Commands that a park position is given."""

NOT_SERVED_M_S = 0.4
"""Stands for every threshold below the lowest command: no command serves such a cut, however far below it is."""

TRIES = 12
"""Levels tried at most; where cuts that nothing serves are many, the share jumps, and the best one below counts."""

NEAR = 0.001
"""A share that is so near below what is required is near enough."""


@frozen_arrays
class Commanded:
    """What n cuts are commanded, `speed_m_s` (n,), and the share `unserved` that is commanded the lowest speed because
    no command serves it."""

    speed_m_s: Floats
    unserved: float


@dataclass(frozen=True)
class LevelledCommands:
    """Commands for one place; a cut that they do not serve is commanded the lowest."""

    commands: Commands
    level: float

    def of(self, cuts: SceneCuts) -> Commanded:
        """For each of these cuts."""
        told = self.commands.of(cuts)[:, 0]
        served = told >= BOUNDS_M_S[0]  # false for NaN, too
        return Commanded(np.where(served, told, BOUNDS_M_S[0]), 1.0 - float(served.mean()))


def levelled(knowledge: Knowledge, design: AimedCuts, place: int, p_overspeed: float) -> LevelledCommands | None:
    """The commands for one place with which at most the share `p_overspeed` of `design` couples too fast; None where
    no level gives so few."""
    thresholds = np.maximum(design.thresholds_m_s[:, place : place + 1], NOT_SERVED_M_S)
    others = slice(knowledge.records if isinstance(knowledge, NearestRecord) else 0, None)  # a record finds itself

    def tried(level: float) -> tuple[LevelledCommands, float]:
        requirement = Requirement(level, (NOT_SERVED_M_S, BOUNDS_M_S[1]))
        commands = LevelledCommands(knowledge.commands(design.cuts, thresholds, requirement), level)
        over = commands.of(design.cuts).speed_m_s > thresholds[:, 0]
        return commands, float(over[others].mean())

    found, low, high, level = None, 0.0, 2.0 * p_overspeed, p_overspeed
    for _ in range(TRIES):
        commands, share = tried(level)
        if share <= p_overspeed:
            found, low = commands, level
            if share >= p_overspeed - NEAR:
                break
        else:
            high = level
        level += p_overspeed - 0.5 * NEAR - share  # the share follows the level nearly one to one
        if not low < level < high:
            level = 0.5 * (low + high)
    return found


HARD_M_S = (1.5, 2.0)
"""Coupling speeds that the dissertation counts besides the limit."""

FIGURES = 2 + len(HARD_M_S) + 2
"""Of a trial: gap a car, shares above the limit and above HARD_M_S, mean command, share that no command serves."""


@dataclass(frozen=True)
class Value:
    """A figure with its 95 % interval; both are of independent replicates (Student's law)."""

    value: float
    ci95: Interval


@dataclass(frozen=True)
class Draws:
    """`replicates` times `design` cuts to choose commands on, and as many again, `report`, to judge them on; all of the
    row `seed`."""

    replicates: int
    design: int
    report: int
    seed: int


@dataclass(frozen=True)
class Cuts:
    """Which cuts: where they roll, their category, and the cars of each."""

    scene: AimScene
    category: WeightCategory
    cars: int = 1

    def unrolled(self, draws: Draws) -> Iterator[tuple[SceneCuts, SceneCuts]]:
        """(design, report) of each replicate."""
        together = draws.design + draws.report
        for first in range(0, draws.replicates * together, together):
            design = self.scene.draw(self.category, self.cars, draws.seed, first, draws.design)
            report = self.scene.draw(self.category, self.cars, draws.seed, first + draws.design, draws.report)
            yield design, report

    def drawn(self, draws: Draws, places: Places) -> Iterator[tuple[RolledCuts, RolledCuts]]:
        """(design, report) of each replicate, rolled back from `places`."""
        for design, report in self.unrolled(draws):
            yield rolled_cuts(design, places), rolled_cuts(report, places)


@dataclass(frozen=True)
class Outcome:
    """What an aim gives at one place: gap a car, and shares of the cuts that couple above the limit, above 1.5 and
    above 2 m/s. `mean_command_m_s`: of the cuts; `unserved`: share that no command serves, and that gets the lowest."""

    gap_m: Value
    overspeed: Value
    above_1_5: Value
    above_2: Value
    mean_command_m_s: float
    unserved: float


def tried(
    cuts: Cuts, places: Places, position: PositionModel, knowledge: Knowledge, p_overspeed: float, draws: Draws
) -> tuple[Outcome | None, ...]:
    """The outcome at each place; None where no commands keep `p_overspeed`."""
    return outcomes(samples(cuts, places, position, knowledge, p_overspeed, draws))


def samples(
    cuts: Cuts, places: Places, position: PositionModel, knowledge: Knowledge, p_overspeed: float, draws: Draws
) -> Floats:
    """The figures of every replicate, (replicates, places, FIGURES); equal draws belong together row by row."""
    found = [
        judged(design.at(position), report.at(position), knowledge, p_overspeed)
        for design, report in cuts.drawn(draws, places)
    ]
    return np.array(found)


def judged(design: AimedCuts, report: AimedCuts, knowledge: Knowledge, p_overspeed: float) -> Floats:
    """Figures of one replicate, (places, FIGURES); NaN where no commands keep the share."""
    rows = np.full((design.thresholds_m_s.shape[1], FIGURES), np.nan)
    for place, row in enumerate(rows):
        commands = levelled(knowledge, design, place, p_overspeed)
        if commands is not None:
            commanded = commands.of(report.cuts)
            met = report.couplings(commanded.speed_m_s, place)
            row[:] = (*figures_of(met), commanded.speed_m_s.mean(), commanded.unserved)
    return rows


def figures_of(met: Couplings) -> tuple[float, ...]:
    """Gap a car, and the shares of cuts that couple too fast, above 1.5 and above 2 m/s."""
    shares = (float((met.speed_m_s > limit).mean()) for limit in (met.limit_m_s, *HARD_M_S))
    return (float(met.gap_m.mean()) / met.cars, *shares)


def outcomes(found_in: Floats) -> tuple[Outcome | None, ...]:
    """Of `found_in` (replicates, places, FIGURES), one a place; None where a replicate has none."""
    found: list[Outcome | None] = []
    for place in np.moveaxis(found_in, 1, 0):
        if np.isnan(place).any():
            found.append(None)
        else:
            gap, over, harder, hardest = (value_of(column) for column in place.T[:-2])
            command, unserved = place[:, -2:].mean(axis=0)
            found.append(Outcome(gap, over, harder, hardest, float(command), float(unserved)))
    return tuple(found)


def value_if_known(replicates: Floats) -> Value | None:
    """As `value_of`; None where a replicate has no figure."""
    return None if np.isnan(replicates).any() else value_of(replicates)


def value_of(replicates: Floats) -> Value:
    """Mean of independent, alike figures with its interval."""
    count = len(replicates)
    half = student_quantile(count - 1) * float(replicates.std(ddof=1)) / count**0.5
    mean = float(replicates.mean())
    return Value(mean, (mean - half, mean + half))


NORM_GAP_M = 3.0
"""Mean gap a car that is allowed at a probability of over-speed of 0.1 ([kozachenko-aimed], its reference 1)."""

BEYOND = 0.3
"""Metres; the root is found so nearly."""


def norm_distance(
    cuts: Cuts, position: PositionModel, knowledge: Knowledge, p_overspeed: float, draws: Draws, last_m: float
) -> Floats:
    """Metres from the crest at which the mean gap a car reaches NORM_GAP_M, in each replicate, (replicates,); infinite
    where it is met at `last_m` still."""
    nearest = cuts.scene.exit_m + 1.0
    rows = []
    for drawn in cuts.unrolled(draws):

        def beyond(metres: float, both: tuple[SceneCuts, SceneCuts] = drawn) -> float:
            places = FromCrest((metres,))
            chosen_on, judged_on = (rolled_cuts(each, places).at(position) for each in both)
            gap = float(judged(chosen_on, judged_on, knowledge, p_overspeed)[0, 0])
            return 1e3 if np.isnan(gap) else gap - NORM_GAP_M

        rows.append(root(beyond, nearest, last_m))
    return np.array(rows)


def root(rising: Callable[[float], float], low: float, high: float) -> float:
    """Where a function that rises passes 0; infinite if it is below at `high`, `low` if above at `low`."""
    below, above = rising(low), rising(high)
    if below >= 0.0 or above <= 0.0:
        return low if below >= 0.0 else float("inf")
    while high - low > BEYOND:
        part = np.clip(-below / (above - below), 0.1, 0.9) if above < 100.0 else 0.5
        middle = low + part * (high - low)
        value = rising(middle)
        if value < 0.0:
            low, below = middle, value
        else:
            high, above = middle, value
    return 0.5 * (low + high)
