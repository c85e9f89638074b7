"""The traffic of a hump, and how the yard handles it."""

from __future__ import annotations

from dataclasses import dataclass

from plant_models.errors import require, require_between


@dataclass(frozen=True)
class Traffic:
    """Cars that are humped, and the trains that bring them.

    `cars_per_train`, `cars_per_train_std`: mean and standard deviation. `arrival_scv`: squared coefficient of variation
    of the times between trains; 1 is Poisson, 0 is a timetable that is kept. `leads`: trains that are humped at the
    same time, each on a lead with the cars an hour of the hump figures. `loaded_share` of the cars carry
    `load_t` each. `PlantError` for a value outside its range.
    """

    cars_per_day: float
    cars_per_train: float
    cars_per_train_std: float
    cars_per_cut: float
    arrival_scv: float
    loaded_share: float
    load_t: float
    leads: int = 1
    days_per_year: float = 365.0

    def __post_init__(self) -> None:
        require_between("cars_per_day", self.cars_per_day, 1.0, 1e6)
        require_between("cars_per_train", self.cars_per_train, 1.0, 1000.0)
        require_between("cars_per_train_std", self.cars_per_train_std, 0.0, 1000.0)
        require_between("cars_per_cut", self.cars_per_cut, 1.0, self.cars_per_train)
        require_between("arrival_scv", self.arrival_scv, 0.0, 100.0)
        require_between("loaded_share", self.loaded_share, 0.0, 1.0)
        require_between("load_t", self.load_t, 0.0, 1000.0)
        require_between("days_per_year", self.days_per_year, 1.0, 366.0)
        require(self.leads >= 1, f"leads is {self.leads!r}; a hump has 1 lead or more")

    @property
    def trains_per_day(self) -> float:
        """Trains humped a day."""
        return self.cars_per_day / self.cars_per_train

    @property
    def cuts_per_day(self) -> float:
        """Cuts humped a day."""
        return self.cars_per_day / self.cars_per_cut

    @property
    def squared_cars_per_train(self) -> float:
        """E[n²] of the cars n of a train."""
        return self.cars_per_train**2 + self.cars_per_train_std**2


@dataclass(frozen=True)
class Handling:
    """What the yard does around the humping of a train.

    `between_trains_h`: mean time from the last cut of a train to the first of the next one that waits already, with its
    standard deviation `between_trains_std_h`. `locomotive_h_per_gap_m`: time of a locomotive to push up one metre of
    gap. `locomotive_h_per_misrouted_cut`: to fetch a cut from a wrong track and sort it again. `blocked_share`: part
    of both during which nothing can be humped on this lead. `PlantError` for a value outside its range.
    """

    between_trains_h: float
    between_trains_std_h: float
    locomotive_h_per_gap_m: float
    locomotive_h_per_misrouted_cut: float
    blocked_share: float

    def __post_init__(self) -> None:
        for name in ("between_trains_h", "between_trains_std_h", "locomotive_h_per_gap_m"):
            require_between(name, getattr(self, name), 0.0, 24.0)
        require_between("locomotive_h_per_misrouted_cut", self.locomotive_h_per_misrouted_cut, 0.0, 240.0)
        require_between("blocked_share", self.blocked_share, 0.0, 1.0)
