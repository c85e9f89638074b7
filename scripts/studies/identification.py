"""How often the intervals of identified numbers hold the truth, and how far off the numbers are: plants of which
the truth is known, and logs of them.

Each repetition is another log of simulated passes, under tables that were tuned for the assumed numbers. Everything is
unknown at once.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from plant_models.pressure_regulator import PressureGauge
from scripts.studies.cases import side_by_side, tuned_table
from scripts.studies.study import Findings, MarkdownTable, Method, Tell, option, table
from synth.frame.faults import InputError
from synth.logs import unknowns as asked
from synth.logs.estimate import Estimate, estimate
from synth.logs.fitting_passes import FittingPasses, fitting_passes
from synth.logs.identify import Finding, findings_of
from synth.logs.unknowns import unknowns_of
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.simulation.controllers import TableController
from synth.simulation.exit_statistics import clopper_pearson
from synth.simulation.sampled_pass import LoggedClass, mixed_log

CLASSES = (("light", 22.0, 1, 3.0), ("middle", 52.0, 1, 3.0), ("heavy", 85.0, 1, 4.0), ("three", 156.0, 3, 4.0))
"""Label, mass in t, cars and exit speed of the cuts that come, as many of each."""

POSITION = "knp-5-bunch"

OUTSIDE = """
[retarder.force]
slope_kn_per_kpa = 0.0225
touch_pressure_kpa = 15.0
[retarder.pneumatics]
fill_time_constant_s = 0.6
exhaust_time_constant_s = 0.8
brake_delay_s = 0.25
release_delay_s = 0.3
dead_band_kpa = 35.0
[friction]
common_cv = 0.3
path_std = 0.2
correlation_length_m = 4.0
[sensor]
noise_m_s = 0.1
"""
"""Nearly every number beyond the sensible range of the library."""


@dataclass(frozen=True)
class Truth:
    """A plant: its name, what is otherwise than assumed, and its gauge, None for a drive without one."""

    name: str
    otherwise: str
    gauge: PressureGauge | None

    @cached_property
    def config(self) -> ResolvedConfig:
        """The configuration of the true plant."""
        return parse_config(self.otherwise + text_of_classes(), f"study identification, {self.name}")

    def values(self, asked_keys: tuple[str, ...]) -> dict[str, float]:
        """The true numbers."""
        known = {value.key: value.value for value in self.config.parameters}
        made: dict[str, float] = {asked.SLOPE_BY_AXLES: 0.0, asked.BIAS: 0.0, asked.RESISTANCE_SPREAD: 1.0}
        if self.gauge is not None:
            made[asked.GAUGE_NOISE] = math.hypot(self.gauge.noise_kpa, self.gauge.resolution_kpa / math.sqrt(12.0))
        for _, plant in self.config.plants():
            made[asked.RESISTANCE + plant.cut.category] = plant.resistance.mean_n_per_kn
        found = {key: known.get(key, made.get(key)) for key in asked_keys}
        return {key: value for key, value in found.items() if isinstance(value, float)}


GAUGE = PressureGauge(2.0, 1.0)

TRUTHS = (
    Truth("as assumed", "", GAUGE),
    Truth("as assumed, no gauge", "", None),
    Truth("outside the ranges", OUTSIDE, GAUGE),
)


def text_of_classes() -> str:
    """The part of a configuration that all share."""
    classes = "".join(
        f'[[cut]]\nlabel = "{label}"\ncar = "gondola-4"\ncars = {cars}\nmass_t = {mass_t}\ntargets_m_s = [{target}]\n'
        for label, mass_t, cars, target in CLASSES
    )
    return f'[position]\nname = "{POSITION}"\n{classes}'


@dataclass(frozen=True)
class Yard:
    """What is taken of the position before anything was measured, and the tables that were tuned for that."""

    config: ResolvedConfig
    controllers: dict[str, TableController]

    def passes(self, truth: Truth, count: int, seed: int) -> FittingPasses:
        """A log of `count` passes of the true plant under these tables, fitted to the assumed classes."""
        classes = [
            LoggedClass(plant, self.controllers[label], self.config.targets_of(label)[0])
            for label, plant in truth.config.plants()
        ]
        log = mixed_log(classes, [count // len(classes)] * len(classes), seed, truth.gauge)
        return fitting_passes(log, self.config.plants(), "study identification")


def assumed_yard() -> Yard:
    """Tuned for the numbers of the library."""
    config = parse_config(text_of_classes(), "study identification")
    plants = config.plants()
    tables = side_by_side(lambda one: tuned_table(config, one[1], config.targets_of(one[0])[0]), plants)
    return Yard(config, {label: TableController(table) for (label, _), table in zip(plants, tables, strict=True)})


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
