"""After how many passes a drift is found and named, how often an alarm is false, and what a yard repairs first.

Passes in order and with each change are simulated once. A repetition draws some in order, then changed ones, with
replacement; so it is a sequence of independent passes, and costs no simulation.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import beta, chi2

from scripts.studies.cases import side_by_side, tuned_table
from scripts.studies.study import Method, Tell, option
from scripts.studies.watch.findings import FalseAlarms, Found, Watched
from scripts.studies.watch.night import CHANGES, GAUGE, IN_ORDER, Change, Judge, joined, night, simulated
from synth.hump.watching.settings import WatchedPositionSettings, YardWatchSettings
from synth.logs.drift.causes import causes_of
from synth.logs.drift.charts import RUN_LENGTH, charts_of, kinds_of, limit_of, steps_of
from synth.logs.drift.diagnosis import diagnosed
from synth.logs.drift.evidence import Evidence, configured
from synth.logs.fitting_passes import fitting_passes
from synth.retarder.configuration.config_file import load_config

BESIDE = 200
"""Sequences that false alarms are counted on, side by side."""

LONGEST = 500
"""Passes after a change."""

YARD = "a yard of 100, 20 nights"
YARD_RUN_LENGTH = YardWatchSettings(
    position=tuple(WatchedPositionSettings(name=str(number)) for number in range(100))
).run_length
"""By the defaults of the file of a yard."""


@dataclass(frozen=True)
class Options:
    """How much is done."""

    classes: int = option(4, "cut classes of the built-in configuration", (1, 10))
    passes: int = option(2000, "passes in order", (40, 10**6))
    changed_passes: int = option(300, "passes with each change", (40, 10**6))
    repetitions: int = option(100, "of each change", (2, 10**5))
    calm_passes: int = option(2_000_000, "drawn for false alarms", (1000, 10**9))
    night_passes: int = option(200, "of each position in the night of the yard", (100, 10_000))
    trains: int = option(60, "that its faults are priced on", (20, 100_000))
    seed: int = option(23, "of the random numbers", (0, 2**31))


def run(options: Options, tell: Tell) -> Watched:
    """Tune, simulate, draw."""
    config = load_config(None)
    plants = config.plants()
    chosen = [plants[i] for i in np.unique(np.linspace(0, len(plants) - 1, options.classes).astype(int)).tolist()]
    targets = [config.targets_of(label) for label, _ in chosen]
    middle = [(plant, of[len(of) // 2]) for (_, plant), of in zip(chosen, targets, strict=True)]
    tuned = side_by_side(lambda each: tuned_table(config, *each), middle)
    tables = [(plant, table) for (plant, _), table in zip(middle, tuned, strict=True)]
    tell(f"{len(tables)} tables tuned")
    amounts = [options.passes] + [options.changed_passes] * len(CHANGES)
    logs = [
        simulated(tables, change, amount, options.seed + number, GAUGE)
        for number, (change, amount) in enumerate(zip((IN_ORDER, *CHANGES), amounts, strict=True))
    ]
    tell("passes simulated")
    found: list[Found] = []
    calm: list[FalseAlarms] = []
    for gauge in (True, False):
        seen = logs if gauge else [replace(log, pressure_kpa=np.full_like(log.pressure_kpa, np.nan)) for log in logs]
        passes = fitting_passes(seen[0], plants, "the study")
        values, slope_key = configured(passes, config.parameters)
        judge = Judge(tuple(plants), values, causes_of(passes, values, slope_key), slope_key)
        rng = np.random.default_rng([options.seed, int(gauge)])
        calm_pool = judge.evidence(seen[0])
        for of, run_length in (("one position", RUN_LENGTH), (YARD, YARD_RUN_LENGTH)):
            calm.append(false_alarms(calm_pool, of, run_length, gauge, options.calm_passes, rng))
        for change, log in zip(CHANGES, seen[1:], strict=True):
            if change.is_of_drive and not gauge:
                continue
            found.append(repeated(change, gauge, calm_pool, judge.evidence(log), options.repetitions, rng))
        tell(f"drawn, gauge: {gauge}")
    faults = list(zip(CHANGES, logs[1:], strict=True))
    positions, ranked = night(logs[0], faults, options.night_passes, options.trains, options.seed)
    return Watched(
        config.sha256, options.seed, options.passes, options.changed_passes, tuple(found), tuple(calm), positions,
        options.night_passes, ranked,
    )  # fmt: skip


def false_alarms(
    pool: Evidence, of: str, run_length: float, gauge: bool, passes: int, rng: np.random.Generator
) -> FalseAlarms:
    """Sequences of passes in order, side by side; an alarm begins one anew."""
    steps, charts = steps_of(pool), len(kinds_of(pool.causes))
    limit = limit_of(charts, run_length)
    sums, alarms, length = np.zeros((BESIDE, charts)), 0, passes // BESIDE
    for _ in range(length):
        sums = np.maximum(sums + steps[rng.integers(0, len(steps), BESIDE)], 0.0)
        over = (sums >= limit).any(axis=1)
        alarms += int(over.sum())
        sums[over] = 0.0
    done = length * BESIDE
    low = float(chi2.ppf(0.025, 2 * alarms)) / 2.0 if alarms else 0.0
    high = float(chi2.ppf(0.975, 2 * alarms + 2)) / 2.0
    return FalseAlarms(of, run_length, gauge, charts, limit, done, alarms, (low / done, high / done))


def repeated(
    change: Change, gauge: bool, calm: Evidence, changed: Evidence, repetitions: int, rng: np.random.Generator
) -> Found:
    """The change after 50 to 150 passes in order, again and again."""
    alarm, in_yard, named, right, wrong, early = [], [], [], 0, 0, 0
    for _ in range(repetitions):
        begin = int(rng.integers(50, 151))
        before = calm.taken(rng.integers(0, len(calm), begin))
        evidence = joined(before, changed.taken(rng.integers(0, len(changed), LONGEST)))
        diagnosis, yard = diagnosed(evidence, charts_of(evidence)), charts_of(evidence, YARD_RUN_LENGTH).alarm
        if diagnosis is not None and diagnosis.alarm < begin:
            early += 1
            continue
        alarm.append(float(LONGEST) if diagnosis is None else diagnosis.alarm - begin + 1.0)
        in_yard.append(float(LONGEST) if yard is None else yard[0] - begin + 1.0)
        named.append(float(LONGEST) if diagnosis is None else diagnosis.until - begin + 1.0)
        if diagnosis is not None and diagnosis.decided:
            hit = diagnosis.first.cause.name == change.cause
            right, wrong = right + hit, wrong + (not hit)
    n = max(1, repetitions - early)
    low = float(beta.ppf(0.025, right, n - right + 1)) if right else 0.0
    high = float(beta.ppf(0.975, right + 1, n - right)) if right < n else 1.0
    return Found(
        change.title, gauge, repetitions, early, quantiles(alarm), quantiles(in_yard), quantiles(named), right / n,
        (low, high), wrong / n,
    )  # fmt: skip


def quantiles(values: list[float]) -> tuple[float, float]:
    """Median and 90 %."""
    low, high = np.quantile(values or [0.0], [0.5, 0.9]).tolist()
    return float(low), float(high)


SMALLEST = Options(
    classes=2, passes=200, changed_passes=100, repetitions=2, calm_passes=2000, night_passes=100, trains=20
)

METHOD = Method(Options, SMALLEST, Watched, run)
