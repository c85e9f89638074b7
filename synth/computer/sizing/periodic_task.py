"""A task that comes again and again with a least distance in time."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class PeriodicTask:
    """Jobs at least `period_s` apart, each with `work_s` of processor time at most.

    A job may be let in up to `jitter_s` late; the response counts from when it should have been. Tasks of lower
    priority, or disabled interrupts, hold it up by `blocking_s` at most. `priority`: 1 is the most urgent. All
    times are worst cases.
    """

    name: str
    period_s: float
    work_s: float
    priority: int
    jitter_s: float = 0.0
    blocking_s: float = 0.0
