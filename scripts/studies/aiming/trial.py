"""An aim tried several times: commands chosen on some cuts, judged on others, and both anew in each replicate."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Floats
from plant_models.library.weight_category import WeightCategory
from scripts.studies.aiming.aimed_cuts import AimedCuts, RolledCuts, rolled_cuts
from scripts.studies.aiming.levelled import levelled
from scripts.studies.aiming.places import Places
from synth.aim.knowledge import Knowledge
from synth.aim.outcome import Couplings
from synth.aim.position_models import PositionModel
from synth.aim.scene import AimScene, SceneCuts
from synth.simulation.replicates import Interval, student_quantile

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
