"""What a capacity has found."""

from __future__ import annotations

from dataclasses import dataclass

from synth.hump.capacity.asked_capacity import AskedCapacity
from synth.hump.capacity.curve import Curve


@dataclass(frozen=True)
class FoundCapacity:
    """The curves that were asked for."""

    asked: AskedCapacity
    curves: tuple[Curve, ...]
