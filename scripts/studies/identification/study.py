"""How often the intervals of identified numbers hold the truth, and how far off the numbers are.

Each repetition is another log of simulated passes, under tables that were tuned for the assumed numbers. Everything is
unknown at once.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from scripts.studies.identification.truths import TRUTHS, Truth, Yard, assumed_yard
from scripts.studies.markdown_table import MarkdownTable, table
from scripts.studies.options import option
from scripts.studies.side_by_side import side_by_side
from scripts.studies.study import Findings, Method, Tell
from synth.frame.input_error import InputError
from synth.logs.estimate import Estimate, estimate
from synth.logs.identifiability import Finding, findings_of
from synth.logs.unknowns import unknowns_of
from synth.simulation.exit_statistics import clopper_pearson

SEED = 20_261_122
NAMES = tuple(truth.name for truth in TRUTHS)

ASKED = 0.90
"""Share of 95 % intervals that must hold the truth, at least; less is a fault where chance does not explain it."""

MOST_BIAS = 0.2
"""Of the length of the interval."""


@dataclass(frozen=True)
class Options:
    """What is repeated."""

    truths: tuple[str, ...] = option(NAMES, "plants")
    passes: int = option(200, "passes of a log", (40, 100_000))
    repetitions: int = option(100, "logs of each plant", (2, 10_000))
    long_passes: int = option(2000, "passes of a long log", (40, 100_000))
    long_repetitions: int = option(100, "long logs of the first plant, 0 for none; 10 s each", (0, 10_000))


@dataclass(frozen=True)
class NumberRow:
    """One number in the repetitions of one plant and length: `held` intervals hold the `truth`; `identified` of them
    say that the passes tell the number; mean of estimate less truth, and of the length of the interval."""

    truth_name: str
    passes: int
    key: str
    unit: str
    truth: float
    repetitions: int
    held: int
    identified: int
    bias: float
    length: float

    @property
    def bias_share(self) -> float:
        """Of the interval's length."""
        return self.bias / self.length

    @property
    def held_ci95(self) -> tuple[float, float]:
        """Interval of the share that holds the truth."""
        return clopper_pearson(self.held, self.repetitions)


@dataclass(frozen=True)
class Identification(Findings):
    """All numbers."""

    seed: int
    rows: tuple[NumberRow, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`coverage`: a row a number, columns by plant and length of the log."""
        runs = list(dict.fromkeys((row.truth_name, row.passes) for row in self.rows))
        found = {(row.truth_name, row.passes, row.key): row for row in self.rows}
        keys = list(dict.fromkeys((row.key, row.unit) for row in self.rows))
        cells = [
            (f"{key}{f', {unit}' if unit else ''}", *(cell(found.get((*run, key))) for run in runs))
            for key, unit in keys
        ]
        heads = ("number", *(f"{name}, {passes} passes" for name, passes in runs))
        meaning = (
            "Intervals that hold the truth, per cent; ± half their length, per cent of the number; bias over length"
        )
        return {"coverage": table(meaning, heads, cells)}

    def faults(self) -> tuple[str, ...]:
        """A sentence for each number whose intervals hold too seldom, or that is biased."""
        return tuple(sentence for row in self.rows for sentence in faults_of(row))


def cell(row: NumberRow | None) -> str:
    """One number of one plant and length."""
    if row is None:
        return "not asked"
    told = "" if 2 * row.identified >= row.repetitions else "; not told"
    half = 0.5 * row.length
    reach = f"{100.0 * half / abs(row.truth):.2g} %" if row.truth else f"{half:.2g}"
    return f"{100.0 * row.held / row.repetitions:.0f}; ± {reach}; {row.bias_share:+.2f}{told}"


def faults_of(row: NumberRow) -> Iterator[str]:
    """The sentences of one number, where the passes tell it."""
    where = f"{row.truth_name}, {row.passes} passes: {row.key}"
    if 2 * row.identified < row.repetitions:
        return
    if row.held_ci95[1] < ASKED:
        yield f"{where}: {row.held} of {row.repetitions} intervals hold the truth"
    # Of the mean of so many estimates, two standard errors, with four of these in an interval's length.
    if abs(row.bias_share) > MOST_BIAS + 0.5 / np.sqrt(row.repetitions):
        yield f"{where}: the bias is {row.bias_share:+.2f} of the interval's length"


def run(options: Options, tell: Tell) -> Identification:
    """All plants and lengths."""
    chosen = [truth for truth in TRUTHS if truth.name in options.truths]
    if len(chosen) < len(options.truths):
        raise InputError(f"study identification: the plants are {', '.join(NAMES)}, not {options.truths}")
    yard = assumed_yard()
    tell("tables tuned for the assumed numbers")
    rows: list[NumberRow] = []
    orders = [(truth, options.passes, options.repetitions) for truth in chosen]
    if options.long_repetitions:
        orders.append((chosen[0], options.long_passes, options.long_repetitions))
    for truth, passes, repetitions in orders:
        rows += rows_of(yard, truth, passes, repetitions)
        tell(f"{truth.name}: {repetitions} logs of {passes} passes")
    return Identification(SEED, tuple(rows))


def rows_of(yard: Yard, truth: Truth, passes: int, repetitions: int) -> Iterator[NumberRow]:
    """The repetitions of one plant and length."""
    logs = range(SEED, SEED + repetitions)
    found = side_by_side(lambda seed: estimated(yard, truth, passes, seed), logs)
    keys = tuple(unknown.key for unknown in found[0].unknowns)
    values = truth.values(keys)
    told = [findings_of(each) for each in found]
    for number, key in enumerate(keys):
        yield number_row(truth.name, passes, values[key], [findings[number] for findings in told])


def estimated(yard: Yard, truth: Truth, passes: int, seed: int) -> Estimate:
    """From one log."""
    fitting = yard.passes(truth, passes, seed)
    return estimate(fitting, unknowns_of(fitting, yard.config.parameters))


def number_row(name: str, passes: int, truth: float, told: Sequence[Finding]) -> NumberRow:
    """What repeated estimates say of one number."""
    intervals = np.array([finding.interval for finding in told])
    return NumberRow(
        name, passes, told[0].key, told[0].unit, truth, len(told),
        held=int(((intervals[:, 0] <= truth) & (truth <= intervals[:, 1])).sum()),
        identified=sum(finding.identified for finding in told),
        bias=float(np.mean([finding.value for finding in told]) - truth),
        length=float((intervals[:, 1] - intervals[:, 0]).mean()),
    )  # fmt: skip


METHOD = Method(Options, Options(NAMES[:1], 40, 2, 40, 0), Identification, run)
