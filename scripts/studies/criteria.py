"""What other criteria than the mean square make of the tables, and what a price on switchings buys.

For each case one table by each criterion, simulated on the same fresh passes: the default, over-speed four times as
dear, P(exit > target + 0.1 m/s) at most 0.01 and the same at 0.05 m/s, and the worst friction factor from 0.7 to 1.3;
then the default with several switching tolerances.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from scripts.studies.cases import Case, from_the_entrance, named_cases, rounded, side_by_side
from scripts.studies.study import Findings, MarkdownTable, Method, Tell, around, option, table
from synth.problem.criterion import AsymmetricSquare, Criterion
from synth.problem.problem import Aim
from synth.problem.requirement import FrictionRange, OverspeedLimit
from synth.problem.resolution import finer_for_check
from synth.retarder.checked_design import required_lines
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.tuned_table import predict
from synth.simulation.closed_loop import ClosedLoop, TableController, close_loop
from synth.simulation.exit_statistics import exit_statistics, overspeed_of, rms_ratio
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.simulation.replicates import Interval
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.backward_induction import Solution, solve_all
from synth.solver.chain.chain import Chain, check_chain, persistent_chain
from synth.solver.tuned_lines import fitted
from tuning_tables import ControllerTable


@dataclass(frozen=True)
class Measured:
    """One table on the common passes; `over`: share beyond each margin above the target, with its interval."""

    predicted_rms_m_s: float
    rms_m_s: float
    rms_ci95_m_s: Interval
    bias_m_s: float
    bias_ci95_m_s: Interval
    over: tuple[tuple[float, Interval], ...]
    stalled: float
    switchings: float
    switchings_ci95: Interval


@dataclass(frozen=True)
class CriterionRow:
    """One criterion of one case. `ratio`: rms / rms by the default, paired; `worst_factor`: of friction, with its rms.

    `finding`: what the requirement took, in a sentence.
    """

    case: str
    criterion: str
    figures: Measured
    ratio: float
    ratio_ci95: Interval
    worst_factor: float
    worst_rms_m_s: float
    worst_ci95_m_s: Interval
    finding: str | None


@dataclass(frozen=True)
class PriceRow:
    """The default criterion with one switching tolerance."""

    case: str
    tolerance_m2_s2: float
    figures: Measured


@dataclass(frozen=True)
class Criteria(Findings):
    """All criteria and prices of all cases. `margins_m_s`: those of `Measured.over`."""

    config_sha256: str
    seed: int
    passes: int
    margins_m_s: tuple[float, ...]
    criteria: tuple[CriterionRow, ...]
    prices: tuple[PriceRow, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`criteria`: a row a case and criterion; `prices`: a row a tolerance, a column a case."""
        beyond = (f"P(+{margin:g})" for margin in self.margins_m_s)
        heads = ("case", "criterion", "rms", "rms / default", "bias", *beyond, "switchings", "worst rms, at factor")
        cases = tuple(dict.fromkeys(row.case for row in self.prices))
        by_price: dict[float, list[str]] = {}
        for row in self.prices:
            cell = f"{mm(row.figures.rms_m_s, row.figures.rms_ci95_m_s)} / {row.figures.switchings:.2f}"
            by_price.setdefault(row.tolerance_m2_s2, []).append(cell)
        prices = [(f"{price:g}", *cells) for price, cells in by_price.items()]
        return {
            "criteria": table("rms, bias in mm/s, P in %", heads, map(cells_of, self.criteria)),
            "prices": table("rms in mm/s / switchings a pass", ("tolerance, m²/s²", *cases), prices),
        }

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated, and what each requirement took."""
        took = [f"{row.case}, {row.criterion}: {row.finding}" for row in self.criteria if row.finding is not None]
        stalls = [
            f"{r.case}, {r.criterion}: {100.0 * r.figures.stalled:.2f} % stall"
            for r in self.criteria
            if r.figures.stalled
        ]
        return (f"{self.passes} stratified passes a table, seed {self.seed}", *took, *stalls)


def cells_of(row: CriterionRow) -> tuple[str, ...]:
    """The cells of one criterion."""
    f = row.figures
    return (
        row.case, row.criterion, mm(f.rms_m_s, f.rms_ci95_m_s), around(row.ratio, row.ratio_ci95, 3),
        mm(f.bias_m_s, f.bias_ci95_m_s), *(around(share, ends, 2, 100.0) for share, ends in f.over),
        f"{f.switchings:.2f}", f"{mm(row.worst_rms_m_s, row.worst_ci95_m_s)}, {row.worst_factor:.1f}",
    )  # fmt: skip


def mm(value_m_s: float, ends_m_s: Sequence[float]) -> str:
    """A speed with its interval in mm/s."""
    return around(value_m_s, ends_m_s, 1, 1e3)


RANGE = FrictionRange(0.7, 1.3)
MARGINS_M_S = (0.05, 0.1, 0.3)

FRESH = 7919
"""Added to the configured seed: other passes than those of the book and of the baselines' tuning."""


@dataclass(frozen=True)
class Options:
    """What is studied."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    cases: tuple[str, ...] = option(("22:2", "52:3", "85:4"), "mass, t : target, m/s")
    passes: int = option(20_000, "passes of each table; a quarter of them at each factor of friction", (800, 10**7))
    tolerances_m2_s2: tuple[float, ...] = option((0.0, 1e-5, 3e-5, 1e-4, 3e-4), "prices on switchings", (0.0, 1.0))
    factors: int = option(7, "factors of friction, 0.7 to 1.3, among which the worst is looked for", (2, 61))


def criteria(default: Criterion) -> dict[str, Criterion]:
    """The criteria compared, the default first."""
    return {
        "default": default,
        "over-speed ×4": replace(default, terminal=AsymmetricSquare(4.0)),
        "P(+0.10) ≤ 0.01": replace(default, requirement=OverspeedLimit(0.10, 0.01)),
        "P(+0.05) ≤ 0.01": replace(default, requirement=OverspeedLimit(0.05, 0.01)),
        "worst friction 0.7-1.3": replace(default, requirement=RANGE),
    }


@dataclass(frozen=True)
class Bench:
    """One case: grids to design and to predict on, the closed loop, common passes."""

    case: Case
    config: ResolvedConfig
    design: Chain
    check: Chain
    loop: ClosedLoop
    passes: RandomPasses

    def table(self, solution: Solution) -> tuple[ControllerTable, str | None]:
        """The exported table of a solution, and what its requirement took."""
        found = required_lines(solution, self.check, fitted(solution, self.config.fit.degree))
        table = rounded(self.config, self.case.plant, found.lines, self.case.target_m_s)
        return table, None if found.finding is None else found.finding.sentence

    def sample(self, table: ControllerTable) -> ExitSample:
        """The common passes by `table`."""
        return self.loop.run(TableController(table), self.loop.draws(self.passes))

    def measured(self, table: ControllerTable, sample: ExitSample) -> Measured:
        """Figures with intervals."""
        target = self.case.target_m_s
        s = exit_statistics(sample, target)
        over = tuple(overspeed_of(sample, target, margin) for margin in MARGINS_M_S)
        predicted = predict(self.check, table).rms_m_s(target)
        return Measured(
            predicted, s.rms_m_s, s.rms_ci95_m_s, s.bias_m_s, s.bias_ci95_m_s, over, s.stalled, s.switchings,
            s.switchings_ci95,
        )  # fmt: skip

    def worst(self, table: ControllerTable, factors: int) -> tuple[float, float, tuple[float, float]]:
        """(factor, rms, its interval) of the largest rms over friction factors, on a quarter of the passes each."""
        some = self.passes.part(0, len(self.passes) // 4)
        found = []
        for factor in RANGE.factors(factors):
            sample = self.loop.run(TableController(table), self.loop.draws(some, float(factor)))
            s = exit_statistics(sample, self.case.target_m_s)
            found.append((float(factor), s.rms_m_s, s.rms_ci95_m_s))
        return max(found, key=lambda each: each[1])


def run(options: Options, tell: Tell) -> Criteria:
    """All criteria and prices of all cases."""
    config = from_the_entrance(options.config)
    seed = config.validation.seed + FRESH
    passes = stratified_passes(seed, 0, options.passes)

    def rows_of(case: Case) -> tuple[list[CriterionRow], list[PriceRow]]:
        bench = bench_of(case, config, passes)
        asked = criteria(config.criterion)
        priced = [replace(config.criterion, switching_tolerance_m2_s2=t) for t in options.tolerances_m2_s2]
        solutions = solve_all(bench.design, [Aim(case.target_m_s, each) for each in (*asked.values(), *priced)])
        by_criterion = dict(zip(asked, solutions[: len(asked)], strict=True))
        rows = criterion_rows(bench, by_criterion, options.factors)
        prices = price_rows(bench, options.tolerances_m2_s2, solutions[len(asked) :])
        tell(f"{case.name}: {len(rows)} criteria, {len(prices)} prices")
        return rows, prices

    found = side_by_side(rows_of, named_cases(config, options.cases))
    rows = tuple(row for each, _ in found for row in each)
    prices = tuple(row for _, each in found for row in each)
    return Criteria(config.sha256, seed, options.passes, MARGINS_M_S, rows, prices)


def bench_of(case: Case, config: ResolvedConfig, passes: RandomPasses) -> Bench:
    """Everything about one case that its tables share."""
    plant = case.plant
    loop = close_loop(plant, plant.position.top_stage + 1)  # as many stages as a table holds
    check = check_chain(plant, finer_for_check(config.resolution))
    return Bench(case, config, persistent_chain(plant, config.resolution), check, loop, passes)


def criterion_rows(bench: Bench, solutions: dict[str, Solution], factors: int) -> list[CriterionRow]:
    """A row a criterion, the default first."""
    rows: list[CriterionRow] = []
    default: ExitSample | None = None
    for name, solution in solutions.items():
        table, finding = bench.table(solution)
        sample = bench.sample(table)
        default = default or sample
        ratio, ratio_ci95 = rms_ratio(sample, default, bench.case.target_m_s)
        rows.append(
            CriterionRow(
                bench.case.name, name, bench.measured(table, sample), ratio, ratio_ci95,
                *bench.worst(table, factors), finding,
            )
        )  # fmt: skip
    return rows


def price_rows(bench: Bench, tolerances: tuple[float, ...], solutions: Sequence[Solution]) -> list[PriceRow]:
    """A row a tolerance."""
    rows = []
    for tolerance, solution in zip(tolerances, solutions, strict=True):
        table, _ = bench.table(solution)
        rows.append(PriceRow(bench.case.name, tolerance, bench.measured(table, bench.sample(table))))
    return rows


METHOD = Method(Options, Options(cases=("52:3",), passes=800, tolerances_m2_s2=(0.0,), factors=2), Criteria, run)
