"""The scan cycle of a programmable controller: read all inputs, run the whole program, write all outputs, wait."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class ScanCycle:
    """A cycle that begins every `period_s`; the system takes `overhead_s` of it for inputs, outputs and itself.

    Input filters and output stages delay by `input_s` and `output_s`. Raises `PlantError`.
    """

    period_s: float
    overhead_s: float = 0.0
    input_s: float = 0.0
    output_s: float = 0.0

    def used_share(self, work_s: float) -> float:
        """The share of the cycle that a program of `work_s` and the system take; above 1 it does not fit."""
        return (self.overhead_s + work_s) / self.period_s

    def fits(self, work_s: float) -> bool:
        """Whether a program of `work_s` at most ends within the cycle."""
        return self.overhead_s + work_s <= self.period_s

    def longest_response_s(self, work_s: float) -> float:
        """From a change at an input to that at the output, at most; inf where the program does not fit.

        A change just after the inputs were read waits for the next cycle, which reads, runs and writes:
        filter + period + overhead + work + output stage. Outputs are written when the program ends.
        """
        if not self.fits(work_s):
            return math.inf
        return self.input_s + self.period_s + self.overhead_s + work_s + self.output_s
