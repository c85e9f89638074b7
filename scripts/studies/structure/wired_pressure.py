"""The pressure over time, found by running the parts of the pressure regulator as they are wired.

Nothing here knows the law of the drive: when the relay lets go is found by halving, what the pads feel by quadrature.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from synth.simulation.structure.diagram import Diagram

Signals = dict[str, Any]

HALVINGS = 60
"""Of a stretch of time, down to the last bit."""

NODES, WEIGHTS = np.polynomial.legendre.leggauss(10)


class WiredPressure:
    """The part of a run that is in the pressure regulator: which connection waits for its valve, and until when."""

    def __init__(self, diagram: Diagram, signals: Signals) -> None:
        self._diagram, self._signals = diagram, signals
        self._opens_s = math.inf

    def mean_overpressure_kpa(self, start_s: float, end_s: float) -> float:
        """Mean of p from `start_s` to `end_s`; afterwards the signals P, U_k, … are those of `end_s`."""
        signals, total, now = self._signals, 0.0, start_s
        while now < end_s:
            lasts_s = min([instant - now for instant, _ in signals["U*[n]"] if instant > now] + [end_s - now])
            signals["t"] = now
            for name in ("zero-order hold", "converter", "comparison", "relay element of the pressure"):
                self._run(name)
            self._run("block of changing structure")
            if signals["sgn ε_U"] == 0:
                self._opens_s = math.inf
            elif self._opens_s == math.inf:
                self._run("valve delay")
                self._opens_s = now + signals["τ(P)"]
            if now < self._opens_s:  # nothing is connected yet: the drive is closed on itself
                lasts_s = min(lasts_s, self._opens_s - now)
                on_itself = self._diagram["block of changing structure"].run({**signals, "sgn ε_U": 0})
                signals["P_v, T"] = on_itself["P_in, T"]
            else:
                signals["P_v, T"] = signals["P_in, T"]
                lasts_s = first_time(lambda x: self._sign_after(x) == 0, lasts_s)
            total += self._integral(lasts_s)
            signals["P"] = self._pressure_after(lasts_s)
            now += lasts_s
        return total / (end_s - start_s)

    def _run(self, name: str) -> None:
        self._signals.update(self._diagram[name].run(self._signals))

    def _pressure_after(self, time_s: float) -> float:
        return float(self._diagram["pneumatic link"].run({**self._signals, "Δt": time_s})["P"])

    def _sign_after(self, time_s: float) -> int:
        then: Signals = {**self._signals, "P": self._pressure_after(time_s)}
        for name in ("converter", "comparison", "relay element of the pressure"):
            then.update(self._diagram[name].run(then))
        return int(then["sgn ε_U"])

    def _felt_after(self, time_s: float) -> float:
        then = {**self._signals, "P": self._pressure_after(time_s)}
        return float(self._diagram["dead zone of the pads"].run(then)["p"])

    def _integral(self, time_s: float) -> float:
        """∫p dt over the next `time_s`; where the pads touch or let go, the stretch is cut in two."""
        touching = self._felt_after(0.0) > 0.0
        cut_s = first_time(lambda x: (self._felt_after(x) > 0.0) != touching, time_s)
        total = 0.0
        for start, end in ((0.0, cut_s), (cut_s, time_s)):
            times = start + 0.5 * (end - start) * (NODES + 1.0)
            total += 0.5 * (end - start) * float(WEIGHTS @ [self._felt_after(time) for time in times])
        return total


def first_time(reached: Callable[[float], bool], longest_s: float) -> float:
    """The first time at which `reached`, which then stays, is true; `longest_s` if it is not true before."""
    if not reached(longest_s):
        return longest_s
    low, high = 0.0, longest_s
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if reached(middle) else (middle, high)
    return high
