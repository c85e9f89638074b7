"""One case as a tune does it: its table, the rules tuned for it, and all of them on the same passes.

Finished cases are kept in a file, so that a run that was stopped goes on where it was. What is kept holds for this very
software alone. Every case is a line, on the disk as soon as it is known; a line that a process was killed in is passed
over.
"""

from __future__ import annotations

import hashlib
import threading
from collections.abc import Callable, Sequence
from dataclasses import asdict, replace
from functools import cache, partial
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter

from scripts.studies.cases import CREATED
from scripts.studies.changed_plants import friction
from scripts.studies.every_cut.cut_figures import Beside, BesideWithout, CutFigures, Outcome, RandomCase, Untuned
from scripts.studies.result import plain
from synth.frame.workers.engine import software_sha256
from synth.problem.problem import Aim
from synth.retarder.class_setup import TUNING_PASSES, ClassSetup, class_setup, origin_of, validation_passes
from synth.retarder.comparison.baselines import TunedBaseline, tune_baselines
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.failed_case import FailedCase, attempted
from synth.retarder.sweep.sweep_directory import DONE, LedgerWriter, read_ledger
from synth.retarder.tuned_table import ValidatedLines, read_back, solutions, tuned_table, validated_table
from synth.simulation.closed_loop import TableController
from synth.simulation.common_passes import common_passes
from synth.simulation.exit_statistics import exit_statistics, rms_ratio, unavoidable_error
from synth.simulation.random_passes import random_passes

FILE = "every-cut.jsonl"


class KeptCases:
    """The cases in the file `path`, which need not be there; any thread may ask."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._lock = threading.Lock()
        self._known: dict[str, Any] = {each["key"]: each["outcome"] for each in read_ledger(path).of(DONE)}

    def outcome_of(self, text: str, make: Callable[[], Outcome]) -> Outcome:
        """The outcome of the configuration `text` if it is kept, else what `make` finds; that is kept."""
        key = key_of(text)
        if key in self._known:
            found: Outcome = TypeAdapter(Outcome).validate_python(self._known[key])
            return found
        found = make()
        with self._lock, LedgerWriter(self._path) as ledger:
            ledger.write(DONE, {"key": key, "outcome": plain(asdict(found))})
        return found


def key_of(text: str) -> str:
    """64 hex digits of a configuration and of everything that its outcome depends on besides."""
    return hashlib.sha256(f"{software_sha256()}\0{studies_sha256()}\0{text}".encode()).hexdigest()


@cache
def studies_sha256() -> str:
    """64 hex digits that change with any source of a study: the software itself does not know of them."""
    folder = Path(__file__).resolve().parents[1]
    digest = hashlib.sha256()
    for path in sorted(folder.rglob("*.py")):
        content = path.read_bytes()
        digest.update(f"\0{path.relative_to(folder).as_posix()}\0{len(content)}\0".encode() + content)
    return digest.hexdigest()


WEAK = 0.8
"""Share of the friction on a day that brakes badly."""


def measured(case: RandomCase, config: ResolvedConfig) -> Outcome:
    """The figures of `case`, of which `config` is the configuration; the case as untuned where a tune refuses it."""
    ((label, _),) = config.plants()
    (target,) = config.targets_m_s
    found = attempted(partial(figures_of, case, config), label, target, config)
    return Untuned(case, found.reason) if isinstance(found, FailedCase) else found


def figures_of(case: RandomCase, config: ResolvedConfig) -> CutFigures:
    """The figures of `case`; raises `PlantError` and `InvalidTable` as a tune's parts do."""
    ((label, plant),) = config.plants()
    (target,) = config.targets_m_s
    setup = class_setup(config, label, plant, validation_passes(config), origin_of(config.sha256, CREATED))
    (solution,) = solutions(setup.design, [Aim(target, config.criterion)])
    tuned = tuned_table(setup, solution)
    validated = validated_table(setup, tuned.table, read_back)
    ends = setup.passes.exit_range
    unavoidable = unavoidable_error(ends.slowest, ends.fastest, target)
    tuning = setup.passes.of_others(random_passes(config.validation.seed + 1, 0, TUNING_PASSES))
    best = best_of(tune_baselines(tuning, target), setup, validated)
    figures, plain = validated.statistics, config.regulator.model_copy(update={"estimator": False})
    return CutFigures(
        case=case,
        length_m=plant.pass_m,
        rms_m_s=figures.rms_m_s,
        rms_ci95_m_s=figures.rms_ci95_m_s,
        predicted_rms_m_s=validated.table.predicted.rms_m_s,
        designed_again=tuned.design.grid.again,
        switchings=figures.switchings,
        feasible=not unavoidable.forbids(config.acceptance.rms_m_s),
        best=best,
        without=beside_without(replace(config, regulator=plain), setup, validated),
    )


def beside_without(config: ResolvedConfig, setup: ClassSetup, validated: ValidatedLines) -> BesideWithout:
    """The table beside that of `config`, without estimator, on its plant and where friction is weak."""
    ((label, plant),) = config.plants()
    target, passes = validated.table.target_speed_m_s, setup.passes.passes
    other = class_setup(config, label, plant, passes, setup.origin)
    (solution,) = solutions(other.design, [Aim(target, config.criterion)])
    table, plain = TableController(validated.table), TableController(tuned_table(other, solution).table)
    weak = common_passes(friction(WEAK, 1.0)(plant), passes)
    return BesideWithout(
        *rms_ratio(validated.sample, setup.passes.run(plain), target),
        *rms_ratio(weak.run(table), weak.run(plain), target),
    )


def best_of(rules: Sequence[TunedBaseline], setup: ClassSetup, table: ValidatedLines) -> Beside:
    """The rule of least rms on the passes of `setup`, beside the table on the same passes."""
    return min((beside(rule, setup, table) for rule in rules), key=lambda each: each.rms_m_s)


def beside(rule: TunedBaseline, setup: ClassSetup, validated: ValidatedLines) -> Beside:
    """One rule beside the table."""
    target = validated.table.target_speed_m_s
    sample = setup.passes.run(rule.controller)
    found = exit_statistics(sample, target)
    ratio, ratio_ci95 = rms_ratio(validated.sample, sample, target)
    return Beside(rule.name, found.rms_m_s, found.switchings, ratio, ratio_ci95)
