"""What the time steps of the closed loop cost in accuracy: the exit speed with few sub-steps against that with many.

Compared are passes with the same commands at the same samples: a measured speed on the edge of a line may decide
otherwise after the least difference, and such a pass is another matter.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant
from synth.configuration.config_file import load_config
from synth.problem.aim import Aim
from synth.simulation.closed_loop import SUBSTEP_S, LineController, close_loop
from synth.simulation.passes import PassTrace
from synth.simulation.random_passes import random_passes
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import persistent_chain
from synth.studies.markdown_table import MarkdownTable, table
from synth.studies.options import option
from synth.studies.study import Findings, Method, Tell

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SEED = 1


@dataclass(frozen=True)
class Options:
    """How finely, how many passes."""

    substeps: tuple[int, ...] = option((2, 3, 5, 10, 20), "sub-steps of a sampling period", (1, 1000))
    reference: int = option(320, "sub-steps that stand for the truth", (2, 10_000))
    passes: int = option(1000, "passes", (1, 10**6))


@dataclass(frozen=True)
class Row:
    """One number of sub-steps: difference of the exit speed, and the share of passes with equal commands."""

    substeps: int
    rms_m_s: float
    largest_m_s: float
    same: float


@dataclass(frozen=True)
class IntegrationError(Findings):
    """All numbers of sub-steps; `used`: that of the simulation itself."""

    config_sha256: str
    case: str
    seed: int
    passes: int
    reference: int
    period_s: float
    used: int
    rows: tuple[Row, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`error`: a row a number of sub-steps."""
        heads = ("sub-steps of a sampling period", "rms, mm/s", "largest, mm/s", "passes with equal commands, per cent")
        rows = [
            (str(row.substeps), f"{1e3 * row.rms_m_s:.4f}", f"{1e3 * row.largest_m_s:.4f}", f"{100.0 * row.same:.1f}")
            for row in self.rows
        ]
        return {"error": table(f"Exit speed against {self.reference} sub-steps", heads, rows)}

    def sentences(self) -> tuple[str, ...]:
        """The case, and what the simulation uses."""
        return (
            f"{self.case}, {self.passes} passes, seed {self.seed}; the simulation itself takes {self.used} sub-steps "
            f"of a period of {self.period_s:g} s",
        )


@dataclass(frozen=True)
class LoopCase:
    """A plant under lines; `name` is its label and target."""

    name: str
    config_sha256: str
    plant: Plant
    controller: LineController


def middle_case() -> LoopCase:
    """The middle class of the default book under the solver's lines for its middle target."""
    config = load_config(None)
    label, plant = config.plants()[len(config.plants()) // 2]
    target = config.targets_m_s[len(config.targets_m_s) // 2]
    lines = solve(persistent_chain(plant, config.resolution), Aim(target, config.criterion)).lines
    return LoopCase(f"{label} to {target:g} m/s", config.sha256, plant, LineController(lines))


def run(options: Options, tell: Tell) -> IntegrationError:
    """Follow the same passes with every number of sub-steps."""
    case = middle_case()
    period = case.plant.sensor.sample_period_s
    truth = followed(case, options.reference, options.passes)
    tell(f"{options.passes} passes with {options.reference} sub-steps")
    rows = tuple(compared(n, followed(case, n, options.passes), truth) for n in options.substeps)
    return IntegrationError(
        config_sha256=case.config_sha256, case=case.name, seed=SEED, passes=options.passes,
        reference=options.reference, period_s=period, used=math.ceil(period / SUBSTEP_S), rows=rows,
    )  # fmt: skip


def followed(case: LoopCase, substeps: int, count: int) -> list[PassTrace]:
    """Every pass, event by event."""
    loop = close_loop(case.plant, case.controller.stages, substeps)
    passes = random_passes(SEED, 0, count)
    return [loop.follow(case.controller, loop.draws(passes.part(i, i + 1))) for i in range(count)]


def commands_of(trace: PassTrace) -> list[tuple[float, int]]:
    """(time, stage) of every change of the commanded stage."""
    changed = np.flatnonzero(np.diff(trace.stage)) + 1
    return [(round(float(trace.time_s[k]), 9), int(trace.stage[k])) for k in changed]


def compared(substeps: int, mine: list[PassTrace], truth: list[PassTrace]) -> Row:
    """The differences over the passes with equal commands."""
    pairs = list(zip(mine, truth, strict=True))
    same = np.array([commands_of(one) == commands_of(other) for one, other in pairs])
    apart: NDArray[np.float64] = np.array([abs(one.exit_speed_m_s - other.exit_speed_m_s) for one, other in pairs])
    apart = apart[same]
    rms = float(np.sqrt(np.mean(apart**2))) if same.any() else 0.0
    return Row(substeps, rms, float(apart.max(initial=0.0)), float(same.mean()))


def figures(found: IntegrationError) -> Mapping[str, Figure]:
    """Error over sub-steps."""
    from synth.present.plots.house_style import BLUE, ORANGE, dress, logarithmic_y, new_figure, place

    figure = new_figure(6.0, 4.0, "Integration error of the exit speed", found.case)
    place(figure, left=0.9, right=0.3, bottom=0.7, top=0.75)
    axes = figure.subplots()
    dress(axes, "", "sub-steps of a sampling period", "mm/s")
    steps = [row.substeps for row in found.rows]
    axes.plot(steps, [1e3 * row.rms_m_s for row in found.rows], "-o", color=BLUE, label="rms")
    axes.plot(steps, [1e3 * row.largest_m_s for row in found.rows], "--s", color=ORANGE, label="largest")
    axes.set_xscale("log", base=2)
    logarithmic_y(axes, [1e3 * x for row in found.rows for x in (row.rms_m_s, row.largest_m_s)])
    axes.set_xticks(steps, [str(step) for step in steps])
    axes.legend(fontsize=8)
    return {"": figure}


METHOD = Method(Options, Options(substeps=(2, 10), reference=40, passes=30), IntegrationError, run)
