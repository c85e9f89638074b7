"""Does the table that a tune makes beat every tuned rule, for every ordinary cut?

Cases are drawn at random over the whole library. For each a table is made as `tune` makes it, the classical rules are
tuned as `tune` tunes them; all are simulated on the same passes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import count

from scripts.studies.every_cut.cut_figures import CutFigures, Outcome
from scripts.studies.every_cut.findings import EveryCut, findings_of, rule_cell
from scripts.studies.every_cut.kept_cases import FILE, KeptCases
from scripts.studies.every_cut.measured_case import measured
from scripts.studies.every_cut.random_case import RandomCase, random_case
from scripts.studies.options import option
from scripts.studies.side_by_side import THREADS, side_by_side
from scripts.studies.study import Method, Tell
from synth.kernels.cache import use_kernel_cache
from synth.retarder.configuration.config_file import parse_config

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
