"""Couplings and gaps by the exactness of the positions, with commands chosen for it or as they were."""

from __future__ import annotations

from dataclasses import dataclass

from scripts.studies.humping.base_trial import READING, Day, with_free
from scripts.studies.humping.day_figures import Pair, PairFigures
from scripts.studies.study import Tell

SHARES = (1.0, 0.5, 0.25)
"""Of the error of the positions: as it was, halved, quartered."""

FREE = ((0.1, 0.5), (0.2, 0.9))
"""Free shares of the tracks, from and to; assumed, the source tells none."""

CAREFUL = 0.05


@dataclass(frozen=True)
class Aimed:
    """All positions have the error `std_m_s`; the last one's commands were chosen for `aim_std_m_s` and a share of
    over-speeds. Tracks are free on a share of their length between both of `free`. `measured`: commands follow the
    measured resistance of a cut, not the mean of its category."""

    std_m_s: float
    aim_std_m_s: float
    p_overspeed: float
    free: tuple[float, float]
    measured: bool = False

    @property
    def name(self) -> str:
        """Tells it from the others."""
        return (
            f"σ {self.std_m_s:.3g}, commands for σ {self.aim_std_m_s:.3g} and {self.p_overspeed:g}, free "
            f"{self.free[0]:g}–{self.free[1]:g}{', measured' * self.measured}"
        )


@dataclass(frozen=True)
class AimedFigures:
    """What it came to."""

    aimed: Aimed
    found: PairFigures


def coupling_pairs(day: Day, stds_m_s: tuple[float, ...], tell: Tell) -> dict[Aimed, Pair]:
    """A pair a position, way of choosing commands, and length of the free tracks: the position of `day` and better
    ones, then positions with `stds_m_s` and commands of their own."""
    usual = day.p_overspeed
    ways = [
        (day.std_m_s * part, aim_std, p)
        for part in SHARES
        for aim_std, p in ((day.std_m_s, usual), (day.std_m_s * part, usual), (day.std_m_s * part, CAREFUL))
    ]
    known = [*((*way, False) for way in ways), *((std, std, usual, m) for m in (False, True) for std in stds_m_s)]
    pairs: dict[Aimed, Pair] = {}
    for std, aim_std, p, measured in dict.fromkeys(known):
        made = Day(day.seed, day.cuts, std, aim_std, p, day.design_cuts, measured).trial()
        for free in FREE:
            aimed = Aimed(std, aim_std, p, free, measured)
            pairs[aimed] = Pair(aimed.name, with_free(made, free), READING if measured else None)
    tell("commands chosen for every exactness")
    return pairs
