"""Does the table that a tune makes beat every tuned rule, for every ordinary cut? Every case, and how many of them
a rule controls better than the table.

Cases are drawn at random over the whole library. For each a table is made as `tune` makes it, the classical rules are
tuned as `tune` tunes them; all are simulated on the same passes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import count
from math import comb
from statistics import median

from scripts.studies.cases import THREADS, side_by_side
from scripts.studies.every_cut.cut_figures import HONEST, Beside, CutFigures, Outcome, RandomCase, Untuned, random_case
from scripts.studies.every_cut.measured_case import FILE, KeptCases, measured
from scripts.studies.study import ABSENT, Findings, MarkdownTable, Method, Tell, around, option, span, table
from synth.kernels.cache import use_kernel_cache
from synth.retarder.configuration.config_file import parse_config
from synth.simulation.exit_statistics import clopper_pearson
from synth.simulation.replicates import UPPER_TAIL, Interval


def median_interval(values: Sequence[float]) -> Interval | None:
    """95 % interval of the median of the law that `values` are drawn from; None for fewer than 6, which tell none.

    From the k-th least to the k-th greatest, k the greatest number for which at most 2.5 % of all samples have fewer
    than k values below the median: these follow the binomial law with probability 1/2 (David and Nagaraja, *Order
    Statistics*, chapter 7).
    """
    count, below = len(values), 0
    k = 0
    while below + comb(count, k) <= UPPER_TAIL * 2**count:
        below += comb(count, k)
        k += 1
    ordered = sorted(values)
    return (ordered[k - 1], ordered[-k]) if k else None


LENGTHS_M = (60.0, 100.0)
"""Paths of a pass at which the classes of length end."""

WORST = 10
"""Cases in the table of the worst."""


@dataclass(frozen=True)
class EveryCut(Findings):
    """All cases in the order of their numbers, `seed` that they were drawn with, passes of each."""

    seed: int
    passes: int
    cases: tuple[CutFigures, ...]
    untuned: tuple[Untuned, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`classes`: a row a class of length; `worst`, `without`: a row a case."""
        classes = table("Tables beside tuned rules", CLASS_HEADS, self.class_rows())
        return {"classes": classes, "worst": self.worst(), "without": self.beside_without()}

    def class_rows(self) -> Iterator[tuple[str, ...]]:
        """The rows by length, then those of all cases and of those where the limit can be met, or not."""
        for low, high in zip((0.0, *LENGTHS_M), (*LENGTHS_M, float("inf")), strict=True):
            yield class_cells(length_name(low, high), [each for each in self.cases if low <= each.length_m < high])
        yield class_cells("limit can be met", [each for each in self.cases if each.feasible])
        yield class_cells("limit cannot be met", [each for each in self.cases if not each.feasible])
        yield class_cells("all", self.cases)

    def worst(self) -> MarkdownTable:
        """The cases of the highest rms beside the best rule."""
        ordered = sorted(self.cases, key=lambda each: -each.best.ratio)[:WORST]
        return table("The worst cases beside the best rule", WORST_HEADS, [case_cells(each) for each in ordered])

    def beside_without(self) -> MarkdownTable:
        """The cases of the highest rms beside the table without estimator, on either plant."""
        ordered = sorted(self.cases, key=lambda each: -max(each.without.ratio, each.without.weak_ratio))[:WORST]
        return table("The worst cases beside the table without estimator", WITHOUT_HEADS, map(without_cells, ordered))

    def sentences(self) -> tuple[str, ...]:
        """How much was done, and the cases without a table."""
        count = len(self.cases) + len(self.untuned)
        return (
            f"{count} cases, seed {self.seed}, {self.passes} passes each; {len(self.untuned)} have no table",
            *(f"{each.case.name}: no table: {each.reason}" for each in self.untuned),
        )

    def faults(self) -> tuple[str, ...]:
        """Cases that a rule controls better, and predictions that do not hold."""
        return tuple(sentence for each in self.cases for sentence in faults_of(each))


def findings_of(seed: int, passes: int, outcomes: Sequence[Outcome]) -> EveryCut:
    """The findings of `outcomes`."""
    figures = tuple(each for each in outcomes if isinstance(each, CutFigures))
    untuned = tuple(each for each in outcomes if isinstance(each, Untuned))
    return EveryCut(seed, passes, figures, untuned)


def faults_of(found: CutFigures) -> Iterator[str]:
    """What one case was to keep and does not."""
    rule = found.best
    if rule.beaten_by:
        yield f"{found.case.name}: rms {around(rule.ratio, rule.ratio_ci95, 3)} times that of the {rule.rule}"
    if found.without.worse:
        _, plain, weak = without_cells(found)
        yield f"{found.case.name}: rms {plain} times that without estimator, {weak} at 0.8 of the friction"
    if not found.honest:
        told = around(found.prediction_ratio, found.prediction_ratio_ci95, 3)
        yield f"{found.case.name}: predicted / simulated rms {told}, allowed {HONEST[0]:g} to {HONEST[1]:g}"


CLASS_HEADS = (
    "path of a pass", "cases", "worse than the best rule, % of the cases", "rms / best rule: median",
    "worse than without estimator, % of the cases", "rms / without estimator: median, largest",
    "at 0.8 of the friction: median, largest",
    "predicted / simulated: least, greatest", "designed again",
)  # fmt: skip


def class_cells(name: str, cases: Sequence[CutFigures]) -> tuple[str, ...]:
    """The cells of one class."""
    if not cases:
        return (name, "0", *(ABSENT for _ in CLASS_HEADS[2:]))
    prediction_ratio = [each.prediction_ratio for each in cases]
    return (
        name, str(len(cases)), share_cell([each.best.beaten_by for each in cases]),
        median_cell([each.best.ratio for each in cases]),
        share_cell([each.without.worse for each in cases]),
        largest_cell([each.without.ratio for each in cases]),
        largest_cell([each.without.weak_ratio for each in cases]),
        f"{min(prediction_ratio):.3f}, {max(prediction_ratio):.3f}", str(sum(each.designed_again for each in cases)),
    )  # fmt: skip


def length_name(low_m: float, high_m: float) -> str:
    """'below 60 m', '60 to 100 m', 'from 100 m'."""
    if low_m == 0.0:
        return f"below {high_m:g} m"
    return f"from {low_m:g} m" if high_m == float("inf") else f"{low_m:g} to {high_m:g} m"


def share_cell(hits: Sequence[bool]) -> str:
    """'1.2 [0.4, 2.8] (6)': per cent with its exact interval, and how many."""
    found = sum(hits)
    return f"{around(found / len(hits), clopper_pearson(found, len(hits)), 1, 100.0)} ({found})"


def largest_cell(values: Sequence[float]) -> str:
    """'0.710, 1.012'."""
    return f"{median(values):.3f}, {max(values):.3f}"


def median_cell(values: Sequence[float]) -> str:
    """'0.71 [0.69, 0.74]'; without the interval where there are too few values for one."""
    ends = median_interval(values)
    return f"{median(values):.3f} {ABSENT if ends is None else span(ends, 3)}"


WORST_HEADS = (
    "case", "path, m", "limit can be met", "rms, m/s", "predicted / simulated", "rms / best rule",
)  # fmt: skip


def case_cells(found: CutFigures) -> tuple[str, ...]:
    """The cells of one case."""
    return (
        found.case.name, f"{found.length_m:.0f}", "yes" if found.feasible else "no",
        around(found.rms_m_s, found.rms_ci95_m_s), f"{found.prediction_ratio:.3f}", rule_cell(found.best),
    )  # fmt: skip


WITHOUT_HEADS = ("case", "rms / without estimator", "at 0.8 of the friction")


def without_cells(found: CutFigures) -> tuple[str, str, str]:
    """The cells of one case beside its table without estimator."""
    beside = found.without
    plain, weak = (beside.ratio, beside.ratio_ci95), (beside.weak_ratio, beside.weak_ratio_ci95)
    return found.case.name, around(*plain, 3), around(*weak, 3)


def rule_cell(beside: Beside) -> str:
    """'0.812 [0.801, 0.823] (energy rule)'."""
    return f"{around(beside.ratio, beside.ratio_ci95, 3)} ({beside.rule})"


SEEDS_APART = 10
"""Between the seeds of the passes of two cases: a tune takes the next ones for the passes that it tunes on."""

COARSE = """
[grid]
path_step_m = 1.0
speed_step_m_s = 0.06
transient_step_s = 0.1
friction_scenarios = 2
"""


@dataclass(frozen=True)
class Options:
    """Which cases."""

    seed: int = option(20_261_202, "of the cases, and of the passes of the first", (0, 2**52))
    first: int = option(0, "number of the first case", (0, 10**9))
    cases: int = option(500, "how many", (1, 10**6))
    passes: int = option(6000, "stratified passes of each", (1000, 50_000))
    workers: int = option(THREADS, "cases at a time; no figure depends on it", (1, 256))
    coarse: bool = option(False, "on a coarse grid, whose figures mean nothing: to try the study")
    texts: bool = option(False, "tell the configuration of each case too, to tune it by hand")
    afresh: bool = option(False, "do every case, also those that a run which was stopped has finished; keep none")


def run(options: Options, tell: Tell) -> EveryCut:
    """All cases, each told when it is finished."""
    finished = count(1)
    remember = at_once if options.afresh else KeptCases(use_kernel_cache() / FILE).outcome_of

    def outcome_of(case: RandomCase) -> Outcome:
        text = configuration(case, options)
        found = remember(text, partial(measured, case, parse_config(text, f"study every-cut, case {case.number}")))
        told = f"{next(finished)} of {options.cases}: {case.name}: {summary(found)}"
        tell(f"{told}\n\n{text}" if options.texts else told)
        return found

    cases = [random_case(options.seed, number) for number in range(options.first, options.first + options.cases)]
    return findings_of(options.seed, options.passes, side_by_side(outcome_of, cases, options.workers))


def at_once(_: str, make: Callable[[], Outcome]) -> Outcome:
    """Remembers nothing."""
    return make()


def configuration(case: RandomCase, options: Options) -> str:
    """The configuration of a case, in TOML: a `tune` of it makes the same table, and tunes the same rules."""
    text = case.text(options.passes, options.seed + SEEDS_APART * case.number)
    return text + COARSE if options.coarse else text


def summary(found: Outcome) -> str:
    """One case in a line."""
    if not isinstance(found, CutFigures):
        return f"no table: {found.reason}"
    return (
        f"{found.length_m:.0f} m, rms {found.rms_m_s:.4f} m/s, predicted / simulated {found.prediction_ratio:.3f}, "
        f"/ best rule {rule_cell(found.best)}"
    )


SMALLEST = Options(first=0, cases=3, passes=1000, coarse=True, afresh=True)
METHOD = Method(Options, SMALLEST, EveryCut, run)
