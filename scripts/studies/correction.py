"""What the on-line correction of the commanded speed gains on a plant that drifts, and costs on one that does not.

Sequences of passes are simulated one pass after another: a pass runs under what the exits before it have taught, its
exit is measured with an error of its own, and `usable_exit` judges it by its trace. Without correction the same passes
run under the table alone (common random numbers). Sequences are independent, so their spread gives the intervals.

The constants of the filter are those of the library, and come from rates: a drift of 0.1 m/s in 2 000 passes
(a = 5e-5 m/s a pass) at a spread of r = 0.06 m/s is followed best, lag a/K against noise K r²/2, by K³ = 4 a²/r², K =
0.014; one of a third of it by 0.007. The memory of 100 passes, K = 0.01, lies between.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from plant_models.frozen_arrays import Floats
from scripts.studies.cases import Case, named_cases, side_by_side, tuned_table
from scripts.studies.correction_sequence import Ageing, PassSequence, ageings, run_sequence
from scripts.studies.study import Findings, MarkdownTable, Method, Tell, around, option, table
from synth.retarder.configuration.config_file import load_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.simulation.closed_loop import TableController, close_loop
from synth.simulation.random_passes import random_passes
from synth.simulation.replicates import Interval, student_quantile
from tuning_tables.active_table import active
from tuning_tables.correction import Correction


@dataclass(frozen=True)
class Row:
    """One case on one plant.

    Ratios are rms with / without correction over all passes, and over the last quarter of every sequence; biases are of
    that quarter, `usable` the share of passes learnt from, `largest_m_s` the largest correction that was applied.
    """

    ageing: str
    stays: bool
    case: str
    plain_rms_m_s: float
    ratio: float
    ratio_ci95: Interval
    late_ratio: float
    late_ratio_ci95: Interval
    late_plain_bias_m_s: float
    late_bias_m_s: float
    usable: float
    largest_m_s: float


@dataclass(frozen=True)
class Corrected(Findings):
    """All cases on all plants."""

    config_sha256: str
    seed: int
    sequences: int
    passes: int
    limit_m_s: float
    memory_passes: float
    spread_m_s: float
    reading_m_s: float
    rows: tuple[Row, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`gain`: rms with / without; `bias`: what is left at the end."""
        gain = ("plant", "case", "rms without, m/s", "ratio [95 %]", "ratio in the last quarter [95 %]")
        bias = ("plant", "case", "bias without", "bias with", "largest correction", "learnt from")
        return {
            "gain": table(
                "rms with / without correction",
                gain,
                (
                    (r.ageing, r.case, f"{r.plain_rms_m_s:.4f}", around(r.ratio, r.ratio_ci95, 3),
                     around(r.late_ratio, r.late_ratio_ci95, 3))
                    for r in self.rows
                ),
            ),
            "bias": table(
                "Mean exit error in the last quarter, m/s",
                bias,
                (
                    (r.ageing, r.case, f"{r.late_plain_bias_m_s:+.4f}", f"{r.late_bias_m_s:+.4f}",
                     f"{r.largest_m_s:.3f}", f"{100.0 * r.usable:.0f} %")
                    for r in self.rows
                ),
            ),
        }  # fmt: skip

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated."""
        return (
            f"{self.sequences} independent sequences of {self.passes} passes for each row, seed {self.seed}; memory "
            f"{self.memory_passes:g} passes, spread {self.spread_m_s:g} m/s, exits read to {self.reading_m_s:g} m/s",
        )

    def faults(self) -> tuple[str, ...]:
        """Rows where the correction is worse than none on a plant that stays, or beyond its limit."""
        worse = [
            f"{row.case}: on a plant that stays the rms with correction is {row.ratio:.4f} of that without, and the "
            f"interval {row.ratio_ci95[0]:.4f} to {row.ratio_ci95[1]:.4f} lies above 1"
            for row in self.rows
            if row.stays and row.ratio_ci95[0] > 1.0
        ]
        # The limit is applied in float32.
        beyond = [
            f"{row.case}, {row.ageing}: a correction of {row.largest_m_s} m/s is beyond the limit"
            for row in self.rows
            if row.largest_m_s > self.limit_m_s + 1e-7
        ]
        return (*worse, *beyond)


FRESH = 15485863
"""Added to the configured seed: passes that no tuning has seen."""


@dataclass(frozen=True)
class Options:
    """What is simulated."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    cases: tuple[str, ...] = option(("22:2", "52:3", "85:3"), "MASS:TARGET of the cases")
    sequences: int = option(40, "independent sequences of each row", (2, 10_000))
    passes: int = option(2000, "passes of a sequence, over which the plant ages", (40, 10**6))
    friction_fall: float = option(0.2, "share of the friction that is lost in the end", (0.0, 0.6))
    creep_m_s: float = option(0.1, "what the sensor reads too much in the end, m/s", (-0.5, 0.5))
    limit_m_s: float = option(0.15, "of the correction, m/s", (0.01, 0.5))
    memory_passes: float = option(100.0, "of the correction", (10.0, 1e4))
    spread_m_s: float = option(0.06, "that the correction takes exits to have, m/s", (0.005, 0.5))
    reading_m_s: float = option(0.05, "standard deviation of a measured exit speed, m/s", (0.0, 0.5))


def run(options: Options, tell: Tell) -> Corrected:
    """Tune the cases, then run every sequence with and without correction."""
    config = load_config(options.config)
    seed = config.validation.seed + FRESH
    correction = Correction(options.limit_m_s, options.spread_m_s, options.memory_passes)

    def rows_of(case: Case) -> tuple[Row, ...]:
        rows = tuple(
            case_row(config, case, ageing, correction, options)
            for ageing in ageings(options.friction_fall, options.creep_m_s)
        )
        tell(f"{case.name}: {len(rows)} plants")
        return rows

    by_case = side_by_side(rows_of, named_cases(config, options.cases))
    rows = tuple(row for rows in zip(*by_case, strict=True) for row in rows)
    return Corrected(
        config.sha256, seed, options.sequences, options.passes, options.limit_m_s, options.memory_passes,
        options.spread_m_s, options.reading_m_s, rows,
    )  # fmt: skip


def case_row(config: ResolvedConfig, case: Case, ageing: Ageing, correction: Correction, options: Options) -> Row:
    """All sequences of one case on one plant."""
    table = active(tuned_table(config, case.plant, case.target_m_s))
    controller = TableController(table)
    loop = close_loop(case.plant, controller.stages)
    share = np.arange(options.passes) / options.passes
    seed = config.validation.seed + FRESH
    plain, found = [], list[PassSequence]()
    for number in range(options.sequences):
        passes = ageing.age(random_passes(seed, number * options.passes, options.passes), case.plant, share)
        draws = loop.draws(passes)
        readings = options.reading_m_s * np.random.default_rng((seed, number)).standard_normal(options.passes)
        plain.append(loop.run(controller, draws).exit_speed_m_s - case.target_m_s)
        found.append(run_sequence(loop, table, draws, readings + ageing.exit_bias_m_s * share, correction))
    return row_of(ageing, case, np.array(plain), found)


def row_of(ageing: Ageing, case: Case, plain: Floats, sequences: Iterable[PassSequence]) -> Row:
    """The figures of sequences without, (sequences, passes), and with correction."""
    found = tuple(sequences)
    errors = np.array([each.error_m_s for each in found])
    late = slice(plain.shape[1] * 3 // 4, None)
    ratio, late_ratio = (rms_ratio(errors[:, part], plain[:, part]) for part in (slice(None), late))
    return Row(
        ageing.name, ageing.name == "stays", case.name, math.sqrt(float(np.mean(plain**2))), *ratio, *late_ratio,
        float(plain[:, late].mean()), float(errors[:, late].mean()),
        float(np.mean([each.usable.mean() for each in found])),
        float(max(np.abs(each.correction_m_s).max() for each in found)),
    )  # fmt: skip


def rms_ratio(errors: Floats, others: Floats) -> tuple[float, Interval]:
    """rms of `errors` / rms of `others`, both (sequences, passes), paired; 95 % interval from the spread of sequences.

    The delta method on the logarithm of the ratio; the sequences are independent and alike.
    """
    a, b = (np.mean(each**2, axis=1) for each in (errors, others))
    influence = 0.5 * (a / a.mean() - b / b.mean())
    half = student_quantile(len(a) - 1) * float(influence.std(ddof=1)) / math.sqrt(len(a))
    ratio = math.sqrt(float(a.mean() / b.mean()))
    return ratio, (ratio * math.exp(-half), ratio * math.exp(half))


METHOD = Method(Options, Options(cases=("52:3",), sequences=2, passes=60), Corrected, run)
