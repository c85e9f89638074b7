"""The closed loop of a regulator that is told the friction of every cut."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import fields

import numpy as np
from numpy.typing import NDArray

from synth.kernels.loop.passes import Draws
from synth.simulation.closed_loop import ClosedLoop, Controller, LineController, picked
from synth.simulation.passes import ExitSample
from synth.simulation.replicates import REPLICATE_PASSES
from synth.solver.told_lines import ToldLines

Told = Callable[[float], Controller]
"""The controller for cuts of a friction factor ξ_cut."""

GROUPS = 24
"""Cuts are told their friction in groups: neighbours in ξ_cut get the controller for their mean. With 104 groups the
rms of the default book is the same within 0.7 %."""


LINE_NODES = 301


def by_lines(lines: ToldLines) -> Told:
    """The regulator that compares the measured speed with the lines for the friction."""
    nodes_m = lines.lines[0].nodes_m(LINE_NODES)
    return lambda factor: LineController(lines.at(factor).at(nodes_m))


def run_told(loop_of: Callable[[int], ClosedLoop], draws: Draws, told: Told, groups: int = GROUPS) -> ExitSample:
    """All passes of `draws`, each under the controller for its friction; `loop_of`(stages): the plant's closed loop."""
    order = np.argsort(draws.cut_factor, kind="stable")
    found: dict[str, NDArray[np.generic]] = {}
    for group in np.array_split(order, min(groups, len(order))):
        controller = told(float(draws.cut_factor[group].mean()))
        part = loop_of(controller.stages).run(controller, picked(draws, group))
        for field in fields(ExitSample):
            values = getattr(part, field.name)
            found.setdefault(field.name, np.empty(len(order), values.dtype))[group] = values
    return ExitSample(**found)  # type: ignore[arg-type]  # by name, each of its own type


def best_by_others(samples: Sequence[ExitSample], target_m_s: float) -> ExitSample:
    """The passes under whichever controller is best: what holds for one half of them is decided by the other half.

    `samples` are of the same passes. No pass has a part in the choice that it is judged by, so the choice makes no
    figure better than it is. Of equals, and where there is no other half, the first is taken.
    """
    squares = np.array([each.weight * (each.exit_speed_m_s - target_m_s) ** 2 for each in samples])
    odd = np.arange(squares.shape[1]) // REPLICATE_PASSES % 2 == 1
    by_odd, by_even = (samples[int(squares[:, half].sum(axis=1).argmin())] for half in (odd, ~odd))
    if by_odd is by_even:
        return by_odd
    names = [field.name for field in fields(ExitSample)]
    return ExitSample(**{name: np.where(odd, getattr(by_even, name), getattr(by_odd, name)) for name in names})
