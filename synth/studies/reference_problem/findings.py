"""What the comparison on the reference problem has found."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from synth.studies.markdown_table import MarkdownTable, table
from synth.studies.reference_problem.fresh_process import Fresh
from synth.studies.reference_problem.operator_work import OperatorWork
from synth.studies.study import Findings
from synth.studies.timing.machine import Machine
from synth.studies.timing.turns import Times, speed_against, three_digits

TOLERANCE_M2_S2 = 1e-5
"""Of values up to 16 m²/s² in float32, against float64."""


@dataclass(frozen=True)
class Row:
    """One way of solving, or of solving all of the batch."""

    name: str
    times: Times


@dataclass(frozen=True)
class Agreement:
    """Largest distance of the values from numpy's by name, m²/s²; what the kernels' commands lose in a step at most."""

    value_m2_s2: dict[str, float]
    regret_m2_s2: float
    same_bytes: bool


@dataclass(frozen=True)
class Limit:
    """On so many threads: operations a second on vectors of sixteen, and how long a sweep would take by each at least.

    `loads` on a cache line, `straddling` loads across two.
    """

    threads: int
    multiply_adds_per_s: float
    loads_per_s: float
    straddling_per_s: float
    sweep_by_loads_s: float
    sweep_by_multiply_adds_s: float


@dataclass(frozen=True)
class Comparison(Findings):
    """All ways in turns; `single` and `batch` begin with the kernels, and `base` is what speeds are told against.

    `build`: the kernels with one stage to sweep, which is nearly all building the operator.
    """

    machine: Machine
    scipy: str
    quantecon: str | None
    transitions: int
    agreement: Agreement
    base: str
    single: tuple[Row, ...]
    build: tuple[Row, ...]
    batch: tuple[Row, ...]
    work: OperatorWork
    limits: tuple[Limit, ...]
    fresh: tuple[Fresh, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`single`, `batch`, `build`, `limit`, `fresh`."""
        fresh = [(f.name, f"{f.cold_s:.2f}", f"{f.warm_s:.2f}", f"{f.peak_mb:.0f}") for f in self.fresh]
        heads = ("fresh process", "first solve, nothing compiled, s", "compiled, s", "peak MB")
        return {
            "single": self.speeds("One problem", "one problem", self.single),
            "batch": self.speeds("Sixteen problems", "batch of 16", self.batch),
            "build": self.speeds("The operator and one stage", "one stage", self.build),
            "limit": self.limit_table(),
            "fresh": table("In a process of its own", heads, fresh),
        }

    def speeds(self, title: str, head: str, rows: tuple[Row, ...]) -> MarkdownTable:
        """Median times and the speed against the base, or against the first where the base is not among the rows."""
        base = next((row for row in rows if row.name == self.base), rows[0])
        cells = [
            (row.name, three_digits(1e3 * row.times.median_s), three_digits(1e3 * row.times.median_processor_s),
             "1" if row is base else speed_against(base.times, row.times).cell)
            for row in rows
        ]  # fmt: skip
        return table(title, (head, "median wall ms", "processor ms", f"speed against {base.name}"), cells)

    def limit_table(self) -> MarkdownTable:
        """A row a number of threads."""
        heads = ("threads", "multiply-adds a second", "loads a second", "loads across two lines",
                 "sweep by loads, ms", "sweep by multiply-adds, ms")  # fmt: skip
        rows = [
            (str(x.threads), f"{x.multiply_adds_per_s:.1e}", f"{x.loads_per_s:.1e}", f"{x.straddling_per_s:.1e}",
             three_digits(1e3 * x.sweep_by_loads_s), three_digits(1e3 * x.sweep_by_multiply_adds_s))
            for x in self.limits
        ]  # fmt: skip
        return table("The limit of the machine, vectors of 16 float32", heads, rows)

    def sentences(self) -> tuple[str, ...]:
        """The machine, what was solved, and that it is right."""
        found, kernels = self.agreement, self.single[0].name
        other = f"scipy {self.scipy}, QuantEcon {self.quantecon or 'not installed: left out'}"
        return (
            f"{self.machine.sentence}; {other}",
            f"{self.transitions:,} transitions a solve; a stage has {self.work.units:,} units, "
            f"{self.work.weights:,} vectors of weights, {self.work.products:,} products",
            f"{kernels}: value within {found.value_m2_s2[kernels]:.1e} m²/s² of numpy in float64, one-step regret at "
            f"most {found.regret_m2_s2:.1e}",
        )

    def faults(self) -> tuple[str, ...]:
        """Everybody must solve the same problem, and threads must not be seen in the bytes."""
        found = self.agreement
        sentences = [
            f"{name}: the value is {far:.1e} m²/s² off" for name, far in found.value_m2_s2.items()
            if far > TOLERANCE_M2_S2
        ]  # fmt: skip
        if found.regret_m2_s2 > TOLERANCE_M2_S2:
            sentences.append(f"the commands lose {found.regret_m2_s2:.1e} m²/s² in a step")
        return (*sentences, *(() if found.same_bytes else ("the bytes depend on the number of threads",)))
