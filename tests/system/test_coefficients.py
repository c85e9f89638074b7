"""Hashes of the coefficients of many tables, kept in `coefficients.json`: none changes unless somebody means it
to.

Same bytes are promised on one kind of processor: with AVX-512 some last bits are others than without. Both are kept.
Who changes tables on purpose writes the file anew (`python -m tests.system.test_coefficients`), on a processor with
AVX-512 and on one without, and says why in the commit. BLAS is told which processor to compute for, as its kernels
differ in the last bit; on a processor without AVX2 this test cannot run.
"""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from llvmlite import binding

from plant_models.library import position_names
from synth.problem.problem import Aim
from synth.retarder.class_setup import class_setup, origin_of, validation_passes
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.sweep.plan import plan_of
from synth.retarder.sweep.sweep_file import parse_sweep
from synth.retarder.sweep.tune_unit import tune_unit
from synth.retarder.tuned_table import solutions, tuned_table
from synth.solver.descent import one_blas_thread
from tests.effort import sized
from tests.sweep.conftest import PLANT, SWEEP
from tuning_tables import ControllerTable, to_json

KEPT = Path(__file__).with_name("coefficients.json")
CREATED = "2026-11-22T00:00:00Z"
FEW = "[validation]\npasses = 1000\n"
GONDOLA = '[[cut]]\ncar = "gondola-4"\nmass_t = 36\n'
KNOWN_MEAN = "[friction]\nmean_cv = 0.0\n"
ENTRANCE = "[regulator]\napproach_m = 0.0\n"
AHEAD = "[regulator]\napproach_m = 4.0\n"
MEASURED = "estimator = false\n"
POSITIONS = {name: f'{FEW}{ENTRANCE}[position]\nname = "{name}"\n' for name in position_names()}
CONFIGURATIONS = {
    "estimator": f"{FEW}{ENTRANCE}estimator = true\n{KNOWN_MEAN}{GONDOLA}",
    "approach": f"{FEW}{AHEAD}",
    "approach, measured speed": f"{FEW}{AHEAD}{MEASURED}",
    "at any time, measured speed": f'{FEW}{AHEAD}{MEASURED}commands = "any_time"\n{GONDOLA}',
    "example of the README": (
        f'{FEW}{AHEAD}{MEASURED}[targets]\nexit_speeds_m_s = [3.0]\n[[cut]]\ncar = "gondola-4"\nmass_t = 52\n'
    ),
    "approach, estimator": f"{FEW}{AHEAD}estimator = true\n{KNOWN_MEAN}{GONDOLA}",
    "approach, estimator, reserve": f"{FEW}{AHEAD}estimator = true\n[friction]\nmean_cv = 0.15\n{GONDOLA}",
    "p_overspeed": (
        f"{FEW}{ENTRANCE}{MEASURED}[criterion]\np_overspeed = 0.02\n[targets]\nexit_speeds_m_s = [2.0]\n{GONDOLA}"
    ),
    "worst_friction": (
        f"{FEW}{ENTRANCE}{MEASURED}[criterion]\nworst_friction_low = 0.8\nworst_friction_high = 1.2\n"
        f"[targets]\nexit_speeds_m_s = [3.0]\n{GONDOLA}"
    ),
}


def ends_of(config: ResolvedConfig) -> Iterator[ControllerTable]:
    """The tables of the first and the last class of a configuration."""
    labels = [label for label, _ in config.plants()]
    return (table for label in dict.fromkeys((labels[0], labels[-1])) for table in tuned(config, label))


def tuned(config: ResolvedConfig, chosen: str) -> Iterator[ControllerTable]:
    """The tables of the class `chosen` of a configuration, not simulated."""
    passes, origin = validation_passes(config), origin_of(config.sha256, CREATED)
    for label, plant in config.plants():
        if label != chosen:
            continue
        setup = class_setup(config, label, plant, passes, origin)
        aims = [Aim(target, config.criterion) for target in config.targets_m_s]
        for solution in solutions(setup.design, aims):
            yield tuned_table(setup, solution).table


def swept() -> Iterator[ControllerTable]:
    """The tables of a small sweep."""
    for unit in plan_of(parse_sweep(ENTRANCE + PLANT + SWEEP, "sweep.toml"), CREATED).units:
        yield from (row.table for row in tune_unit(unit.order).rows)


def coefficients_sha256(table: ControllerTable) -> str:
    """Of the stages with their lines, as the file writes them; of a table without gauge less its slopes."""
    stages = json.loads(to_json(table))["stages"]
    if not table.has_gauge:
        stages = [{key: value for key, value in stage.items() if "slope" not in key} for stage in stages]
    return hashlib.sha256(json.dumps(stages, sort_keys=True).encode()).hexdigest()


@one_blas_thread()
def hashes(*names: str) -> dict[str, dict[str, str]]:
    """By configuration and table; of the configurations named, or of all."""
    positions = {name: parse_config(text, name) for name, text in POSITIONS.items()}
    tables = {
        **{name: tuned(config, config.cuts[0].label) for name, config in positions.items()},
        **{name: ends_of(parse_config(text, name)) for name, text in CONFIGURATIONS.items()},
        "sweep": swept(),
    }
    return {name: {table.id: coefficients_sha256(table) for table in tables[name]} for name in names or tables}


def kind_of_processor() -> str:
    """Of two kinds that differ in last bits."""
    return "with AVX-512" if binding.get_host_cpu_features().get("avx512f") else "without AVX-512"


def kept() -> dict[str, dict[str, str]]:
    """The hashes for the processor at hand, by configuration and table."""
    found: dict[str, dict[str, str]] = json.loads(KEPT.read_bytes())[kind_of_processor()]
    return found


if __name__ == "__main__":
    found = hashes(*sys.argv[1:])
    whole = {**json.loads(KEPT.read_bytes()), kind_of_processor(): found}
    print(json.dumps(found if sys.argv[1:] else whole, indent=1, sort_keys=True))


ROOT = Path(__file__).parents[2]


NAMES = sized(("approach, estimator", "p_overspeed", "rnz-2m-park", "sweep"), tuple(kept()))


@pytest.mark.requirement("PRED-10")
def test_no_coefficient_has_changed() -> None:
    found = subprocess.run(
        [sys.executable, "-m", "tests.system.test_coefficients", *NAMES],
        cwd=ROOT, env={**os.environ, "OPENBLAS_CORETYPE": "Haswell"}, check=True, capture_output=True, text=True,
    )  # fmt: skip
    assert json.loads(found.stdout) == {name: kept()[name] for name in NAMES}
