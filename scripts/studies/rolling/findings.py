"""What the study of rolling has found."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from scripts.studies.study import ABSENT, Findings, MarkdownTable, table
from scripts.studies.timing import Machine, Times, speed_against, three_digits

LARGEST_SPEED_ERROR_M_S, LARGEST_STOP_ERROR_M = 1e-3, 0.1
SLOW_M_S = 0.3
"""Errors of speeds count above this: near a stop the speed has an infinite slope over the path."""


@dataclass(frozen=True)
class Way:
    """One way of rolling `cuts` cuts; `direction`: 'forwards' or 'backwards'. `error_m_s`: largest of the speeds above
    `SLOW_M_S`, None where it is in the table of errors."""

    name: str
    direction: str
    cuts: int
    times: Times
    error_m_s: float | None = None

    @property
    def of_a_cut(self) -> Times:
        """Processor times of one cut."""
        each = tuple(seconds / self.cuts for seconds in self.times.processor_s)
        return Times(each, each)

    @property
    def per_s(self) -> float:
        """Rolls a second of wall time, median."""
        return self.cuts / self.times.median_s

    @property
    def per_core_s(self) -> float:
        """Rolls a second of processor time, median."""
        return self.cuts / self.times.median_processor_s


@dataclass(frozen=True)
class StepError:
    """Errors of one longest step (of single cars, and of these): of speeds at stations, stops, times, and of the speed
    that is found backwards; root mean squares over all cuts, and the largest. None: there is none to compare."""

    case: str
    cars: int
    step_m: float
    longest_m: float
    speed_rms_m_s: float
    speed_max_m_s: float
    stop_rms_m: float | None
    stop_max_m: float | None
    time_max: float
    back_max_m_s: float | None


@dataclass(frozen=True)
class RollingFindings(Findings):
    """Speed, errors, and how the time goes with cuts and cars.

    `reference_step_m` and `reference_node_m` stand for the truth of the errors; the reference itself is
    `reference_error_m_s` and `reference_stop_error_m` off scipy's solution of `scipy_cuts` cuts of each case.
    """

    machine: Machine
    seed: int
    used_step_m: float
    length_m: float
    error_cuts: int
    reference_step_m: float
    reference_node_m: float
    scipy_cuts: int
    reference_error_m_s: float
    reference_stop_error_m: float
    ways: tuple[Way, ...]
    errors: tuple[StepError, ...]
    by_cuts: tuple[Way, ...]
    by_cars: tuple[Way, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`speed`: a row a way of rolling; `error`: a row a case and step; `scaling`: by number of cuts and cars."""
        return {"speed": self.speed_table(), "error": self.error_table(), "scaling": self.scaling_table()}

    def speed_table(self) -> MarkdownTable:
        """Ways side by side; the first of each direction is the kernel."""
        rows = []
        for way in self.ways:
            first = next(each for each in self.ways if each.direction == way.direction)
            ratio = "1" if way is first else speed_against(way.of_a_cut, first.of_a_cut).cell
            error = ABSENT if way.error_m_s is None else f"{1e3 * way.error_m_s:.2f}"
            rows.append(
                (
                    way.name,
                    way.direction,
                    f"{way.cuts}",
                    per_second(way.per_s),
                    per_second(way.per_core_s),
                    ratio,
                    error,
                )
            )
        heads = (
            "", "direction", "cuts", "rolls a second", "a second of processor", "the kernel by processor, times",
            "largest error, mm/s",
        )  # fmt: skip
        return table(f"Single light cars, {self.length_m:g} m", heads, rows)

    def error_table(self) -> MarkdownTable:
        """Errors by the step."""
        rows = [
            (each.case, f"{each.cars}", f"{each.step_m:g}{' (used)' if each.step_m == self.used_step_m else ''}",
             f"{each.longest_m:.1f}", f"{1e3 * each.speed_rms_m_s:.3f}", f"{1e3 * each.speed_max_m_s:.2f}",
             cell(each.stop_rms_m, 4), cell(each.stop_max_m, 3), f"{1e3 * each.time_max:.2f}",
             cell(each.back_max_m_s, 2, 1e3))
            for each in self.errors
        ]  # fmt: skip
        heads = (
            "case", "cars", "step, m", "of these cuts", "speed rms, mm/s", "speed max, mm/s", "stop rms, m",
            "stop max, m", "time max, ‰", "backwards max, mm/s",
        )  # fmt: skip
        return table("Errors by the longest step of a single car", heads, rows)

    def scaling_table(self) -> MarkdownTable:
        """Time of a cut against the number of cuts and of cars."""
        rows = [
            (way.name, way.direction, f"{way.cuts}", per_second(way.per_core_s), f"{1e6 * way.of_a_cut.median_s:.3f}")
            for way in (*self.by_cuts, *self.by_cars)
        ]
        heads = ("", "direction", "cuts", "rolls a second of processor", "µs a cut")
        return table("The kernel by the number of cuts and of cars", heads, rows)

    def sentences(self) -> tuple[str, ...]:
        """Machine, what errors are against, and the sample."""
        return (
            self.machine.sentence,
            f"{self.error_cuts} cuts a row, seed {self.seed}; errors of speeds count above {SLOW_M_S} m/s; they are "
            f"against steps of {self.reference_step_m:g} m and nodes of {self.reference_node_m:g} m, which are within "
            f"{1e3 * self.reference_error_m_s:.3f} mm/s and {self.reference_stop_error_m:.4f} m of scipy's solution of "
            f"{self.scipy_cuts} cuts of each case",
        )

    def faults(self) -> tuple[str, ...]:
        """The step in use has an error above what is promised for single cars on the park track."""
        return tuple(
            f"{each.case}, {each.cars} cars: {1e3 * each.speed_max_m_s:.2f} mm/s or {each.stop_max_m} m is more than "
            f"{1e3 * LARGEST_SPEED_ERROR_M_S:g} mm/s or {LARGEST_STOP_ERROR_M:g} m"
            for each in self.errors
            if each is self.promised
            and (each.speed_max_m_s > LARGEST_SPEED_ERROR_M_S or (each.stop_max_m or 0.0) > LARGEST_STOP_ERROR_M)
        )

    @property
    def promised(self) -> StepError | None:
        """The row that the promise is about: the first case at the step in use."""
        return next((each for each in self.errors if each.step_m == self.used_step_m), None)


def per_second(rate: float) -> str:
    """'3 210 000': three digits count."""
    digits = len(f"{rate:.0f}")
    return f"{round(rate, 3 - digits):,.0f}".replace(",", " ") if digits > 3 else three_digits(rate)


def cell(value: float | None, digits: int, scale: float = 1.0) -> str:
    """A number, or what stands for none."""
    return ABSENT if value is None else f"{scale * value:.{digits}f}"
