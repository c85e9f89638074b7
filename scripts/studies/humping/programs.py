"""Programs of hump speeds: what is known before the train, by which method, under which limits; and constant speeds."""

from __future__ import annotations

from dataclasses import replace

from scripts.studies.humping.base_trial import Locomotive, with_known_resistance, with_planner
from scripts.studies.humping.day_figures import Pair
from synth.hump.trains.hump_speed import pair_by_pair
from synth.hump.trains.trial import HumpTrial

CONSTANT_M_S = (1.7, 2.2, 2.7)

CAPS_M_S = (3.0, 2.5)
"""Fastest at which cuts are uncoupled by hand; assumed, the source tells none."""

WEAK_M_S2 = 0.05
"""Acceleration of a weaker locomotive."""

KNOWN, MEAN, WORST = "resistance known", "mean of the category", "worst pair"
PAIRWISE, WEAK = "mean of the category, pair by pair", f"mean of the category, locomotive {WEAK_M_S2:g} m/s²"


def program_pairs(base: HumpTrial) -> list[Pair]:
    """A pair a program."""
    worst = with_planner(base, worst_pair=True)
    weak = Locomotive(acceleration_m_s2=WEAK_M_S2)
    pairs = [
        Pair(KNOWN, with_known_resistance(base)),
        Pair(MEAN, base),
        Pair(WORST, worst),
        *(Pair(capped(cap), with_planner(worst, locomotive=Locomotive(cap))) for cap in CAPS_M_S),
        Pair(WEAK, with_planner(base, locomotive=weak)),
        Pair(PAIRWISE, with_planner(base, method=pair_by_pair)),
        Pair(f"{PAIRWISE}, locomotive {WEAK_M_S2:g} m/s²", with_planner(base, method=pair_by_pair, locomotive=weak)),
    ]
    return pairs + [Pair(f"{each:g} m/s for all", constant(base, each)) for each in CONSTANT_M_S]


def constant(base: HumpTrial, speed_m_s: float) -> HumpTrial:
    """All cuts pushed at one speed."""
    limits = replace(base.planner.limits, steps_m_s=(speed_m_s,))
    return replace(base, planner=replace(base.planner, limits=limits))


def capped(cap_m_s: float) -> str:
    """The row of a program with uncoupling by hand."""
    return f"{WORST}, at most {cap_m_s:g} m/s"
