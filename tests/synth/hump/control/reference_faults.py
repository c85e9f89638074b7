"""Faults of the equipment that a reference track can have."""

from __future__ import annotations

from dataclasses import dataclass

from plant_models.errors import require


@dataclass(frozen=True)
class StuckSwitch:
    """Commands that come between two times move no points."""

    switch: int
    from_s: float
    to_s: float


@dataclass(frozen=True)
class LateSwitch:
    """Points need so much more time."""

    switch: int
    extra_s: float


@dataclass(frozen=True)
class CounterSlip:
    """The counter at `end` of an element (ENTRY or a branch) misses (−1) the axle that passes it as number `axle`, from
    0 on, or counts it twice (1)."""

    element: int
    end: int
    axle: int
    change: int

    def __post_init__(self) -> None:
        require(self.change in (-1, 1), f"counter slip: change is {self.change}; it must be −1 or 1")


@dataclass(frozen=True)
class FalselyOccupied:
    """A section is told occupied by nobody known."""

    element: int
    from_s: float
    to_s: float


@dataclass(frozen=True)
class FalselyFree:
    """A section is told free."""

    element: int
    from_s: float
    to_s: float


Fault = StuckSwitch | LateSwitch | CounterSlip | FalselyOccupied | FalselyFree

NOBODY = 1_000_000
"""The object of a falsely occupied section."""
