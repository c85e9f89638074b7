"""A task that comes again and again with a least distance in time, and must be done by a deadline."""

from __future__ import annotations

import math
from dataclasses import dataclass

from plant_models.errors import require


@dataclass(frozen=True)
class PeriodicTask:
    """Jobs at least `period_s` apart, each with `work_s` of processor time at most, to be done `deadline_s` after it.

    A job may be let in up to `jitter_s` late; the response counts from when it should have been. Tasks of lower
    priority, or disabled interrupts, hold it up by `blocking_s` at most. `priority`: 1 is the most urgent; deadlines
    may be beyond the period. All times are worst cases. Raises `PlantError`.
    """

    name: str
    period_s: float
    work_s: float
    deadline_s: float
    priority: int
    jitter_s: float = 0.0
    blocking_s: float = 0.0

    def __post_init__(self) -> None:
        for name, value in (("period_s", self.period_s), ("work_s", self.work_s), ("deadline_s", self.deadline_s)):
            require(
                math.isfinite(value) and value > 0.0,
                f"task {self.name}: {name} is {value!r}; it must be a finite number above 0",
            )
        for name, value in (("jitter_s", self.jitter_s), ("blocking_s", self.blocking_s)):
            require(
                math.isfinite(value) and value >= 0.0,
                f"task {self.name}: {name} is {value!r}; it must be a finite number from 0 on",
            )
        require(
            isinstance(self.priority, int) and self.priority >= 1,
            f"task {self.name}: priority is {self.priority!r}; it must be a whole number from 1, the most urgent, on",
        )
