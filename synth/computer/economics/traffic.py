"""The traffic of a hump, and how the yard handles it."""

from __future__ import annotations

from pydantic import model_validator

from plant_models.errors import require
from plant_models.library.sourced_value import JUDGEMENT
from synth.computer.origins import USUAL
from synth.frame.settings.section import Section, setting


class Traffic(Section):
    """Cars that are humped, and the trains that bring them."""

    cars_per_day: float = setting(4000.0, "1/d", 1.0, 1e6, "cars humped a day", f"{JUDGEMENT}: a large yard")
    cars_per_train: float = setting(72.0, "1", 1.0, 1000.0, "mean cars of a train", USUAL)
    cars_per_train_std: float = setting(12.0, "1", 0.0, 1000.0, "their standard deviation", USUAL)
    cars_per_cut: float = setting(1.8, "1", 1.0, 100.0, "mean cars of a cut", "as hump trials have it")
    arrival_scv: float = setting(
        1.0, "1", 0.0, 100.0, "squared coefficient of variation of times between trains: 1 is Poisson, 0 a timetable",
        f"{JUDGEMENT}: as by chance",
    )  # fmt: skip
    loaded_share: float = setting(0.6, "1", 0.0, 1.0, "share of loaded cars", USUAL)
    load_t: float = setting(50.0, "t", 0.0, 1000.0, "mean load of those", USUAL)
    leads: int = setting(1, "1", 1, 10, "trains humped at the same time, each on a lead", USUAL)
    days_per_year: float = setting(365.0, "d", 1.0, 366.0, "days of humping in a year", USUAL)

    @model_validator(mode="after")
    def _cut_within_train(self) -> Traffic:
        require(
            self.cars_per_cut <= self.cars_per_train,
            f"cars_per_cut is {self.cars_per_cut:g}; it must be from 1 to cars_per_train, {self.cars_per_train:g}",
        )
        return self

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


class Handling(Section):
    """What the yard does around the humping of a train."""

    between_trains_h: float = setting(
        0.1, "h", 0.0, 24.0, "mean time from the last cut of a train to the first of the next one that waits", USUAL
    )
    between_trains_std_h: float = setting(0.03, "h", 0.0, 24.0, "its standard deviation", USUAL)
    locomotive_h_per_gap_m: float = setting(
        1e-4, "h/m", 0.0, 1.0, "locomotive hours to push up a metre of gap", f"{JUDGEMENT}: many gaps in one trip"
    )
    locomotive_h_per_misrouted_cut: float = setting(
        0.25, "h", 0.0, 240.0, "to fetch a cut from a wrong track and sort it again", USUAL
    )
    blocked_share: float = setting(0.3, "1", 0.0, 1.0, "of both, in which nothing can be humped on this lead", USUAL)
