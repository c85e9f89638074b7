"""Whether aim tables keep the probability that is asked of them, on cuts that their speeds were not chosen on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import betainc

from synth.aim.aim_book import MadeAim
from synth.frame.interval import Interval
from synth.frame.printed_numbers import counted, percent
from synth.simulation.exit_statistics import clopper_pearson

CHANCE = 0.025
"""Of calling a table that keeps its limit one that misses it, all its cells together."""


@dataclass(frozen=True)
class AimVerdict:
    """One table: `missed` names the cells whose over-speeds cannot be chance; `told` of `cells` have figures, and
    `without` have no speed at all. `worst`: the share of over-speed of the cell that is most surely above the limit, of
    its cuts, with an interval that holds for all cells of the table at once; None where no cell has figures."""

    table: str
    cells: int
    told: int
    without: int
    missed: tuple[str, ...]
    worst: Interval | None


@dataclass(frozen=True)
class AimBookVerdict:
    """`accepted`: some cell has figures and no table misses the limit; `sentence` says it in words."""

    accepted: bool
    sentence: str
    tables: tuple[AimVerdict, ...]


def judge_aims(made: Sequence[MadeAim], p_excess: float) -> AimBookVerdict:
    """The verdict on all tables: a cell misses where so many over-speeds at the required probability and `p_excess`
    would be rarer than `CHANCE` over the number of the table's cells."""
    judged = tuple(judge_aim(each, p_excess) for each in made)
    told, without = sum(each.told for each in judged), sum(each.without for each in judged)
    bad = [each for each in judged if each.missed]
    required = made[0].speeds.order.requirement.p_overspeed
    limit = f"{100.0 * (required + p_excess):g} %"
    if not told:
        return AimBookVerdict(False, "no exit speed keeps the required probability anywhere", judged)
    if bad:
        first = "; ".join(f"{each.table}: {each.missed[0]}" for each in bad)
        cells = sum(len(each.missed) for each in bad)
        where = f"{counted(cells, 'cell')} of {told} ({first})"
        sentence = f"more than {limit} of the cuts surely couple too fast in {where}"
    else:
        sentence = f"in none of {counted(told, 'cell')} are more than {limit} of the cuts shown to couple too fast"
    if without:
        cells = sum(each.cells for each in judged)
        sentence += (
            f"; in {without} of {counted(cells, 'cell')} no exit speed keeps it, for the track falls more than such "
            "cuts resist: there they are let go at the lowest speed"
        )
    return AimBookVerdict(not bad, sentence, judged)


def judge_aim(made: MadeAim, p_excess: float) -> AimVerdict:
    """The verdict on one table."""
    speeds = made.speeds
    told = speeds.cuts > 0
    hits = np.rint(np.where(told, speeds.overspeed * speeds.cuts, 0.0))
    limit = speeds.order.requirement.p_overspeed + p_excess
    n = np.maximum(speeds.cuts, 1).astype(np.float64)
    # P(at least `hits` of `n`), a binomial tail, is the incomplete beta function; without a hit it is 1.
    chance = np.where(hits > 0.0, betainc(np.maximum(hits, 1.0), n - hits + 1.0, min(limit, 1.0)), 1.0)
    each_chance = CHANCE / max(int(told.sum()), 1)
    over = told & (chance < each_chance)
    cells = [cell_name(made, tuple(int(i) for i in place)) for place in np.argwhere(over)]
    worst = None
    if told.any():
        place = np.unravel_index(np.argmin(np.where(told, chance, np.inf)), told.shape)
        of_it, cuts = int(hits[place]), int(speeds.cuts[place])
        worst = Interval(of_it / cuts, *clopper_pearson(of_it, cuts, 1.0 - 2.0 * each_chance), cuts)
    without = int(np.isnan(speeds.speed_m_s).sum())
    return AimVerdict(made.table.id, told.size, int(told.sum()), without, tuple(cells), worst)


def cell_name(made: MadeAim, place: tuple[int, ...]) -> str:
    """A cell in words."""
    speeds = made.speeds
    cars, distance = speeds.order.cars[place[0]], speeds.order.free_distances_m[place[1]]
    p = speeds.overspeed[place]
    name = f"{counted(cars, 'car')} at {distance:g} m"
    if speeds.readings is not None:
        name += f" and {speeds.readings[place[2]]:.2f} N/kN"
    return f"{name}: {percent(float(p))} % of {speeds.cuts[place]}"
