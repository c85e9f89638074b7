"""Rules of practice that the control may follow besides the published model."""

from __future__ import annotations

from dataclasses import dataclass

from plant_models.errors import require_between


@dataclass(frozen=True)
class PracticeRules:
    """Which rules hold.

    `counters`: points are not thrown while the counters of their section wait for axles, so a long car is held that
    stands over a short section (long-base rule), and so are a falsely free section and the rest of a split cut.
    `fouling_m_s`: points are not thrown while a cut behind them is slower than this limit and short of the fouling
    point; None: no such rule. `lone_axle_s`: counters that contradict each other on a free section are put right after
    this time, if the next section counted the whole cut (filter of lone axles). `usual_base_m`, `longest_base_m`: no
    car has more between two axles, the latter if its cut has the mark long-base; a longer gap in a cut is a wrong
    uncoupling. `coupled_gap_m`: the last and the first axle of two coupled cars are no further apart. `bogie_m`:
    between the axles of a bogie. `slowest_m_s`: moving cuts are no slower.
    """

    counters: bool = True
    fouling_m_s: float | None = 1.0
    lone_axle_s: float = 1.0
    usual_base_m: float = 12.0
    longest_base_m: float = 30.0
    coupled_gap_m: float = 6.0
    bogie_m: float = 1.85
    slowest_m_s: float = 2.0

    def __post_init__(self) -> None:
        if self.fouling_m_s is not None:
            require_between("rules: fouling_m_s", self.fouling_m_s, 0.0, 10.0)
        require_between("rules: lone_axle_s", self.lone_axle_s, 0.0, 60.0)
        require_between("rules: longest_base_m", self.longest_base_m, 5.0, 60.0)
        require_between("rules: usual_base_m", self.usual_base_m, 2.0, self.longest_base_m)
        require_between("rules: coupled_gap_m", self.coupled_gap_m, 2.0, 20.0)
        require_between("rules: bogie_m", self.bogie_m, 1.0, 4.0)
        require_between("rules: slowest_m_s", self.slowest_m_s, 0.1, 10.0)

    @property
    def crawl_m_s(self) -> float:
        """A gap next to an axle that was slower on the first section is not judged: it may have stood there."""
        return 0.5 * self.slowest_m_s

    @property
    def bogie_s(self) -> float:
        """An axle that comes so soon behind another is of the same car."""
        return self.bogie_m / self.slowest_m_s

    @property
    def patience_s(self) -> float:
        """How long a free section may wait for axles of a cut before they count as missing."""
        return self.longest_base_m / self.slowest_m_s


PUBLISHED_MODEL = PracticeRules(counters=False, fouling_m_s=None)
"""The published model alone: a free section is enough."""
