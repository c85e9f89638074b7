"""What `verify` doubts: tables whose claims are true, and tables that state another rms than theirs.

Of every table of a book many coarse passes are simulated once. Samples are drawn from these, whole groups at a time,
and judged as `verify` judges: as the file has its claims, and with the stated rms, predicted and validated, multiplied
by a factor (its interval with it, the bias as it was).
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from random import Random

from scripts.studies.cases import THREADS, of_masses
from scripts.studies.study import Findings, Interval, MarkdownTable, Method, Tell, around, option, table
from synth.checker.claims import PredictionRatio, own_faults, simulated_faults
from synth.checker.coarse_simulation import Passes, simulate
from synth.checker.drawn_cuts import GROUP
from synth.checker.statistics import figures_of
from synth.checker.summary import read_summary
from synth.checker.table_reading import Table, read_table
from synth.frame.told import plain, summary_head
from synth.frame.workers.engine import Teller
from synth.retarder.asked_tune import RadarEpochs
from synth.retarder.configuration.config_file import load_config
from synth.retarder.configured import head_of
from synth.retarder.tune import tune
from synth.retarder.tuned_table import read_back
from tuning_tables import write_json

FACTORS = (1.0, 0.5, 0.8, 1.25)
SEED = 11
USUAL_PREDICTION_RATIO = PredictionRatio(0.9, 1.1)
"""Where the configuration sets no limit."""


@dataclass(frozen=True)
class Options:
    """Which tables, how many passes."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    masses_t: tuple[float, ...] = option((), "only cuts of these masses, t")
    pool: int = option(6000, "coarse passes of each table", (200, 10**6))
    passes: tuple[int, ...] = option((300, 2000), "passes of a sample", (100, 10**6))
    trials: int = option(500, "samples", (1, 10**6))


@dataclass(frozen=True)
class Doubts:
    """Share of the samples of so many passes in which a claim is doubted, with the stated rms times `factor`."""

    passes: int
    factor: float
    share: float


@dataclass(frozen=True)
class Row:
    """One table; `ratio`: rms of all coarse passes / validated rms, with its 95 % interval."""

    id: str
    ratio: float
    ratio_ci95: Interval
    doubts: tuple[Doubts, ...]


@dataclass(frozen=True)
class Verification(Findings):
    """All tables."""

    config_sha256: str
    seed: int
    rows: tuple[Row, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`doubts`: a row a table."""
        heads = ("table", "coarse / stated rms", *(f"× {d.factor}, {d.passes}" for d in self.rows[0].doubts))
        rows = [
            (row.id, around(row.ratio, row.ratio_ci95, 3), *(f"{100.0 * each.share:.1f}" for each in row.doubts))
            for row in self.rows
        ]
        return {"doubts": table("Samples in which a claim is doubted, per cent", heads, rows)}


def run(options: Options, tell: Tell) -> Verification:
    """Tune the book, simulate coarsely in two processes (the checker is plain Python), judge."""
    config = of_masses(load_config(options.config), options.masses_t)
    with tempfile.TemporaryDirectory() as folder:
        directory = Path(folder)
        (directory / "tables").mkdir()
        book = tune(config, RadarEpochs(), read_back, Teller(tell))
        for case in book.whole:
            write_json(case.table, directory / "tables" / f"{case.table.id}.json")
        summary = {**summary_head("tune", head_of(config), book.created), "tables": {"cases": []}, "files": {}}
        (directory / "summary.json").write_text(json.dumps(plain(summary)), encoding="utf-8")
        names = sorted(path.name for path in (directory / "tables").glob("*.json"))
        with get_context("spawn").Pool(THREADS) as pool:
            rows = pool.map(partial(row_of, directory, options), names, 1)
    tell(f"{len(names)} tables verified, {options.trials} samples each")
    return Verification(config.sha256, SEED, tuple(rows))


def row_of(directory: Path, options: Options, name: str) -> Row:
    """The shares of the table in the file `name`."""
    summary = read_summary(directory / "summary.json")
    read = read_table((directory / "tables" / name).read_bytes())
    pool, prediction_ratio = (
        simulate(summary.plant(read), read, options.pool, SEED),
        summary.prediction_ratio() or USUAL_PREDICTION_RATIO,
    )
    whole, (stated, _) = figures_of(pool, read.target_m_s), validated(read)
    low, high = whole.rms_ci95_m_s
    doubts = (
        each for passes in options.passes for each in doubts_of(read, pool, prediction_ratio, passes, options.trials)
    )
    return Row(read.id, whole.rms_m_s / stated, (low / stated, high / stated), tuple(doubts))


def doubts_of(read: Table, pool: Passes, prediction_ratio: PredictionRatio, passes: int, trials: int) -> list[Doubts]:
    """The shares of one number of passes; every factor is judged by the same samples."""
    random, hits = Random(passes), dict.fromkeys(FACTORS, 0)
    for _ in range(trials):
        found = figures_of(sample_of(pool, passes, random), read.target_m_s)
        for factor in FACTORS:
            claimed = with_rms_times(read, factor)
            hits[factor] += bool(
                [*own_faults(claimed, prediction_ratio), *simulated_faults(claimed, found, prediction_ratio)]
            )
    return [Doubts(passes, factor, hit / trials) for factor, hit in hits.items()]


def with_rms_times(read: Table, factor: float) -> Table:
    """The table with another rms stated."""
    rms, (low, high) = validated(read)
    return replace(
        read, predicted_rms_m_s=factor * read.predicted_rms_m_s, validated_rms_m_s=factor * rms,
        validated_ci95_m_s=(factor * low, factor * high),
    )  # fmt: skip


def validated(read: Table) -> tuple[float, Interval]:
    """The validated rms of a table and its interval; every table of a tune has them."""
    assert read.validated_rms_m_s is not None
    assert read.validated_ci95_m_s is not None
    return read.validated_rms_m_s, read.validated_ci95_m_s


def sample_of(pool: Passes, passes: int, random: Random) -> Passes:
    """As many passes, in groups drawn with replacement."""
    starts = [GROUP * random.randrange(len(pool.exit_m_s) // GROUP) for _ in range(-(-passes // GROUP))]
    columns = ([x for start in starts for x in column[start : start + GROUP]] for column in vars(pool).values())
    return Passes(*(tuple(column[:passes]) for column in columns))


METHOD = Method(Options, Options(masses_t=(52.0,), pool=200, passes=(100,), trials=3), Verification, run)
