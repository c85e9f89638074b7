"""How long the work that a configuration asks for will take: told before it begins, where it is long."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Final

from synth.computer.economics.uncertainty.ranges import Constant, Range
from synth.computer.settings import ComputerSettings

LONG_S: Final = 60.0
"""Work that takes longer than this is told."""

REQUEST_S: Final = 8e-6
MODEL_S: Final = 2e-4
"""Seconds for a simulated request, and for the money of one draw, measured on one core; only the order counts."""


def long_work(settings: ComputerSettings, ranges: Mapping[str, Range]) -> Iterator[str]:
    """A sentence on each number of `settings` that alone takes longer than `LONG_S`; `ranges` of the inputs."""
    asked, uncertain = settings.uncertainty, sum(not isinstance(each, Constant) for each in ranges.values())
    expected_s = {
        ("service.simulated_requests", settings.service.simulated_requests): REQUEST_S,
        ("uncertainty.draws", asked.draws): MODEL_S if uncertain else 0.0,
        ("uncertainty.sobol_points", asked.sobol_points): MODEL_S * (uncertain + 2) if uncertain else 0.0,
    }
    for (key, number), each_s in expected_s.items():
        takes_s = number * each_s
        if takes_s > LONG_S:
            yield (
                f"{key} is {number}; that takes about {takes_s / 60.0:.0f} min; a number up to "
                f"{int(LONG_S / each_s)} takes a minute at most"
            )
