"""How often the printed 95 % intervals hold the truth.

A case is tuned, and its table, the solver's lines and a full brake are simulated over many times as many passes as a
figure is told from. A block is what a figure is told from; counted are the blocks whose interval of each figure holds
the figure of all blocks together. That truth has an error of its own, 1/sqrt(blocks) of an interval. Of the checker
(`verify`): the same for its rms in few coarse passes, against the figure of all coarse passes.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from plant_models import Plant
from scripts.studies.cases import THREADS
from scripts.studies.study import ABSENT, Findings, Interval, MarkdownTable, Method, Tell, option, silent, table
from synth.checker.coarse_simulation import Passes
from synth.checker.coarse_simulation import simulate as simulate_coarsely
from synth.checker.plant import plant_of
from synth.checker.statistics import figures_of
from synth.checker.table_reading import read_table
from synth.frame.faults import InputError
from synth.frame.workers.engine import Teller
from synth.problem.problem import Aim
from synth.retarder.asked_tune import RadarEpochs
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.estimation.estimated_lines import estimate_chain
from synth.retarder.tune import tune
from synth.retarder.tuned_table import read_back, solutions
from synth.simulation.closed_loop import LineController, TableController, simulate_many
from synth.simulation.controllers import full_brake
from synth.simulation.exit_statistics import brake_power, exit_statistics, rms_ratio
from synth.simulation.passes import ExitSample
from tuning_tables import to_json

CASES = (
    "knp-5-bunch:66:3", "knp-5-bunch:22:2", "knp-5-bunch:52:3", "knp-5-bunch:52:2", "knp-5-bunch:22:4",
    "rnz-2m-park:22:2", "rnz-2m-park:36:1.5",
)  # fmt: skip
"""Those of the default book that held least often with plain passes, one without a tail, and another position."""

SEED = 20_261_122
DEFAULT_PASSES, COARSE_PASSES = 20_000, (300, 100)
MOST_BLOCKS = 1000

STATISTICS = {"rms": "rms_m_s", "bias": "bias_m_s", "95 of 100": "p95_m_s", "99 of 100": "p99_m_s",
              "over-speed": "overspeed", "switchings": "switchings"}  # fmt: skip
BRAKE_POWER = {"brake saturated": "brake_saturated", "rms of others": "rms_within_m_s"}
RATIO, VERIFY = "rms / rms of the solver's lines", "rms of verify"

ASKED_AT_DEFAULT, ASKED = (0.92, 0.98), (0.90, 1.0)
"""Between these a share must lie, at the default number of passes and at every other one."""


@dataclass(frozen=True)
class Options:
    """What is simulated."""

    cases: tuple[str, ...] = option(CASES, "POSITION:MASS:TARGET, t and m/s")
    passes: tuple[int, ...] = option((1000, 2000, DEFAULT_PASSES), "passes of a block", (1000, 10**6))
    blocks: int = option(400, "blocks of the largest number of passes", (2, 10_000))
    coarse: int = option(400, "blocks of the checker's passes, 0 for none; 0.6 ms a pass", (0, 10_000))


@dataclass(frozen=True)
class Row:
    """A case and a number of passes: share of the blocks that hold the truth, by figure; None: the event never came."""

    case: str
    passes: int
    blocks: int
    coverage: dict[str, float | None]


@dataclass(frozen=True)
class Coverage(Findings):
    """All rows."""

    seed: int
    rows: tuple[Row, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`coverage`: per cent, a row a case and number of passes."""
        names = list(dict.fromkeys(name for row in self.rows for name in row.coverage))
        cells = [
            (row.case.replace(":", ", "), str(row.passes), str(row.blocks),
             *(ABSENT if (x := row.coverage.get(name)) is None else f"{100.0 * x:.1f}" for name in names))
            for row in self.rows
        ]  # fmt: skip
        heads = ("position, t, m/s", "passes", "blocks", *names)
        return {"coverage": table("Blocks whose 95 % interval holds the truth, per cent", heads, cells)}

    def faults(self) -> tuple[str, ...]:
        """A sentence for every share that is out of its range by more than two of its standard errors."""
        return tuple(sentence for row in self.rows for sentence in faults_of(row))


def faults_of(row: Row) -> Iterator[str]:
    """The sentences of one row."""
    low, high = ASKED_AT_DEFAULT if row.passes == DEFAULT_PASSES else ASKED
    error = 2.0 * math.sqrt(0.05 * 0.95 / row.blocks)
    for name, share in row.coverage.items():
        if share is not None and not low - error <= share <= high + error:
            yield f"{row.case}, {row.passes} passes: {name} is held in {share:.3f} of the blocks"


def run(options: Options, tell: Tell) -> Coverage:
    """All cases, one after the other: the simulation uses all threads."""
    rows: list[Row] = []
    for case in options.cases:
        rows += rows_of(case, options)
        tell(f"{case}: {options.blocks} blocks of {max(options.passes)} passes")
    return Coverage(SEED, tuple(rows))


def configuration(case: str) -> str:
    """The TOML text of a case. Raises `InputError`."""
    try:
        position, mass, target = case.split(":")
        mass_t, target_m_s = float(mass), float(target)
    except ValueError:
        raise InputError(f"study coverage: the case is {case!r}; give POSITION:MASS:TARGET as in {CASES[0]}") from None
    return (
        f'[regulator]\napproach_m = 0.0\n[position]\nname = "{position}"\n[targets]\nexit_speeds_m_s = [{target_m_s}]\n'
        f'[validation]\npasses = 1000\n[[cut]]\ncar = "gondola-4"\nmass_t = {mass_t}\n'
    )


def rows_of(case: str, options: Options) -> Iterator[Row]:
    """Tune one case and count."""
    config = parse_config(configuration(case), f"study coverage, case {case}")
    (found,) = tune(config, RadarEpochs(), read_back, Teller(silent)).whole
    read = read_table(to_json(found.table))
    plant, target = found.plant, found.target_speed_m_s
    design = estimate_chain(plant, config.resolution_of(plant), target)
    (solution,) = solutions(design, [Aim(target, config.criterion)])
    most = max(options.passes)
    laws = TableController(found.table), LineController(solution.lines)
    samples = simulated(plant, laws, most * options.blocks)
    for passes in options.passes:
        blocks = min(options.blocks * most // passes, MOST_BLOCKS)
        yield Row(case, passes, blocks, shares_held(samples, target, passes, blocks))
    resolved = json.loads(config.canonical_json())
    for passes in COARSE_PASSES if options.coarse else ():
        coarse_plant = plant_of(resolved, resolved["cut"][0])
        runs = [simulate_coarsely(coarse_plant, read, passes, seed) for seed in range(options.coarse)]
        yield Row(case, passes, options.coarse, {VERIFY: coarse_share(runs, read.target_m_s)})


def simulated(plant: Plant, controllers: Sequence[TableController | LineController], count: int) -> list[ExitSample]:
    """The passes of these controllers and of a full brake."""
    everyone = (*controllers, full_brake(plant.top_stage + 1, plant.start_m, plant.exit_m))
    return [simulate_many(plant, each, SEED, count, threads=THREADS) for each in everyone]


def intervals(samples: Sequence[ExitSample], target_m_s: float) -> dict[str, tuple[float, Interval]]:
    """Every figure of (table, lines, full brake) with its interval."""
    sample, lines, full = samples
    told = vars(exit_statistics(sample, target_m_s)) | vars(brake_power(sample, full, target_m_s))
    found = {name: (told[key], told[interval_of(key)]) for name, key in (STATISTICS | BRAKE_POWER).items()}
    return {**found, RATIO: rms_ratio(sample, lines, target_m_s)}


def interval_of(key: str) -> str:
    """'rms_m_s' → 'rms_ci95_m_s', 'overspeed' → 'overspeed_ci95'."""
    return key.replace("_m_s", "_ci95_m_s") if key.endswith("_m_s") else f"{key}_ci95"


def shares_held(samples: Sequence[ExitSample], target_m_s: float, passes: int, blocks: int) -> dict[str, float | None]:
    """Share of the blocks whose interval holds the figure of all of them."""
    truth = intervals([block(sample, 0, blocks * passes) for sample in samples], target_m_s)
    held = dict.fromkeys(truth, 0)
    for number in range(blocks):
        parts = [block(sample, number * passes, passes) for sample in samples]
        for name, (_, (low, high)) in intervals(parts, target_m_s).items():
            held[name] += low <= truth[name][0] <= high
    return {name: held[name] / blocks if truth[name][0] != 0.0 else None for name in held}


def block(sample: ExitSample, start: int, count: int) -> ExitSample:
    """`count` passes of `sample` from number `start` on."""
    return ExitSample(**{name: array[start : start + count].copy() for name, array in vars(sample).items()})


def coarse_share(runs: Sequence[Passes], target_m_s: float) -> float:
    """Share of `runs` whose interval of the rms holds the rms of all their passes together."""
    columns = zip(*(vars(each).values() for each in runs), strict=True)
    truth = figures_of(Passes(*(tuple(x for part in parts for x in part) for parts in columns)), target_m_s).rms_m_s
    ends = [figures_of(each, target_m_s).rms_ci95_m_s for each in runs]
    return sum(low <= truth <= high for low, high in ends) / len(runs)


METHOD = Method(Options, Options(cases=CASES[3:4], passes=(1000,), blocks=4, coarse=2), Coverage, run)
