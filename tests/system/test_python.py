"""From Python: the numbers of the command line, the examples of the documentation, faults, start-up."""

from __future__ import annotations

import dataclasses
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import synth
from plant_models import Plant
from synth.frame.faults import InputError
from tests.system.test_coefficients import coefficients_sha256, kept
from tuning_tables import ControllerTable, read_json

ROOT = Path(__file__).parents[2]
LABEL, TARGET = "gondola-4-22t", 1.5
COARSE = synth.Resolution(path_step_m=1.0, speed_step_m_s=0.05, friction_nodes=2, resistance_nodes=1)


@pytest.fixture(scope="module")
def problem(measured_classes: Path) -> synth.Problem:
    """One of the cases that `measured_once` holds."""
    return synth.load_problem(LABEL, TARGET, measured_classes)


@pytest.fixture(scope="module")
def table(problem: synth.Problem, measured_classes: Path) -> ControllerTable:
    """Its table, step by step from Python."""
    config = synth.load_config(measured_classes)
    lines = synth.fit(synth.solve(problem, config.resolution), config.fit.degree)
    return synth.tabulate(lines, f"{LABEL}-to-{TARGET:g}-m-s", config)


@pytest.fixture
def tuned_table(measured_once: Path) -> ControllerTable:
    """The same table as the command `tune` has left it."""
    return read_json(measured_once / "tables" / f"{LABEL}-to-{TARGET:g}-m-s.json")


def test_a_table_is_that_of_the_command(table: ControllerTable, tuned_table: ControllerTable) -> None:
    """Bit for bit, prediction, name and origin included; the command has simulated it besides."""
    assert table.stages == tuned_table.stages
    assert dataclasses.replace(table, created=tuned_table.created, validated=tuned_table.validated) == tuned_table


def test_a_tune_is_that_of_the_command(tuned_table: ControllerTable, measured_classes: Path) -> None:
    found = synth.tune(LABEL, TARGET, measured_classes)
    assert dataclasses.replace(found, created=tuned_table.created, validated=tuned_table.validated) == tuned_table


def test_a_simulation_is_that_of_the_command(
    table: ControllerTable, tuned_table: ControllerTable, problem: synth.Problem, measured_classes: Path
) -> None:
    validation = synth.load_config(measured_classes).validation
    found = synth.simulate(table, problem, validation.passes, validation.seed)
    assert tuned_table.validated is not None
    assert found.statistics.passes == tuned_table.validated.passes
    assert found.statistics.rms_m_s == tuned_table.validated.rms_m_s
    assert found.statistics.rms_ci95_m_s == tuned_table.validated.rms_ci95_m_s


def test_a_prediction_is_that_of_the_table(
    table: ControllerTable, problem: synth.Problem, measured_classes: Path
) -> None:
    assert synth.predict(table, problem, synth.load_config(measured_classes).resolution) == table.predicted


def test_sample_and_trace_are_of_the_same_passes(table: ControllerTable, problem: synth.Problem) -> None:
    passes = synth.simulate(table, problem, passes=1000, seed=5)
    assert len(passes.sample) == 1000
    for index in (0, 17, 999):
        one = synth.trace(table, problem, seed=5, index=index)
        assert one.exit_speed_m_s == passes.sample.exit_speed_m_s[index]
    slow, fast = (synth.trace(table, problem, friction=factor).exit_speed_m_s for factor in (1.3, 0.7))
    assert slow < fast


def test_what_is_printed_is_short(table: ControllerTable, problem: synth.Problem) -> None:
    passes = synth.simulate(table, problem, passes=1000, seed=5)
    low, _ = passes.statistics.rms_ci95_m_s
    assert repr(passes).startswith(f"Simulated(1000 passes, seed 5: rms {passes.statistics.rms_m_s:.4f} [{low:.4f}, ")
    assert len(repr(passes)) < 120
    assert len(repr(synth.trace(table, problem))) < 400


def numbers(plant: Plant) -> list[Plant]:
    """Copies of a plant, each with one number changed."""
    return [
        dataclasses.replace(plant, friction=dataclasses.replace(plant.friction, common_cv=0.2123)),
        dataclasses.replace(plant, sensor=dataclasses.replace(plant.sensor, noise_m_s=0.0512)),
        dataclasses.replace(plant, cut=dataclasses.replace(plant.cut, mass_t=22.5)),
    ]


def test_a_problem_of_ones_own_has_a_hash_of_its_own(problem: synth.Problem) -> None:
    from synth.api.problems import problem_sha256

    others = [synth.Problem(plant, problem.aim) for plant in numbers(problem.plant)]
    others.append(synth.Problem(problem.plant, synth.Aim(TARGET, synth.Criterion(stall_cost_m2_s2=2.0))))
    hashes = [problem_sha256(each) for each in (problem, *others)]
    assert len(set(hashes)) == len(hashes)
    assert problem_sha256(dataclasses.replace(problem)) == hashes[0]
    assert re.fullmatch(r"[0-9a-f]{64}", hashes[0])


@pytest.mark.parametrize(
    ("fault", "words"),
    [
        (lambda t, p: synth.load_problem("gondola-4-22", 1.5, None), "did you mean gondola-4-22t?"),
        (lambda t, p: synth.load_problem("gondola-4-22t", 9.0, None), "there is nothing to brake"),
        (lambda t, p: synth.load_config("nowhere.toml"), "nowhere.toml"),
        (lambda t, p: synth.simulate(t, p, passes=10), "passes is 10; intervals need 1000"),
        (lambda t, p: synth.compare_with_baselines(t, p, passes=10), "passes is 10; intervals need 1000"),
        (lambda t, p: synth.tune("gondola-4-22", 1.5, None), "did you mean gondola-4-22t?"),
        (lambda t, p: synth.load_trial("nowhere.toml"), "nowhere.toml"),
        (lambda t, p: synth.load_trial(seed=-3), "seed is -3; it must not be negative"),
        (lambda t, p: synth.hump_trains(synth.load_trial(), trains=0), "trains is 0; one is needed at least"),
        (lambda t, p: synth.load_aim("nowhere.toml"), "nowhere.toml"),
        (lambda t, p: synth.load_aim(passes=0), "passes is 0; it must be from 1000 to 200000"),
        (lambda t, p: synth.load_passes("nowhere.csv"), "nowhere.csv"),
        (lambda t, p: synth.fit(synth.solve(p, COARSE), 10), "degree is 10; it must be a whole number from 0 to 9"),
        (lambda t, p: synth.load_passes(), "no log is named; name a file or a folder."),
        (lambda t, p: synth.trace(t, p, friction=float("nan")), "friction is nan; it must be a factor from 0 to 5"),
        (lambda t, p: synth.trace(t, p, index=-1), "must not be negative"),
        (lambda t, p: synth.log_passes(t, p, passes=0), "0 passes; at least one is needed"),
        (lambda t, p: synth.Aim(0.0), "target_speed_m_s is 0"),
    ],
)
def test_a_fault_is_one_sentence(table: ControllerTable, problem: synth.Problem, fault: Any, words: str) -> None:
    with pytest.raises(ValueError, match=re.escape(words)) as raised:
        fault(table, problem)
    assert "\n" not in str(raised.value)


def test_a_table_with_estimator_is_simulated_and_not_predicted(table: ControllerTable, problem: synth.Problem) -> None:
    from tuning_tables import Estimator

    work = (-4.0, 5.0), (0.0, 1.0), (0.0, 0.01)
    estimator = Estimator(0.05, 0.15, 0.006, 0.1, 2.0, 7, 20, 0.2, 0.5, 50.0, *work)
    with pytest.raises(InputError, match="simulate it"):
        synth.predict(dataclasses.replace(table, estimator=estimator), problem)


def arrays_in(value: Any, path: str, seen: set[int]) -> Iterator[tuple[str, np.ndarray]]:
    """(where, array) of every array that can be reached from `value` by fields and items."""
    if isinstance(value, np.ndarray):
        yield path, value
    elif id(value) not in seen:
        seen.add(id(value))
        if dataclasses.is_dataclass(value):
            for name, part in vars(value).items():
                yield from arrays_in(part, f"{path}.{name}", seen)
        elif isinstance(value, tuple | list):
            for i, part in enumerate(value):
                yield from arrays_in(part, f"{path}[{i}]", seen)


def test_nothing_on_the_way_can_be_written_to(table: ControllerTable, problem: synth.Problem) -> None:
    """However deep: the values of a solve, a fit, a table, a simulation and a pass."""
    solution = synth.solve(problem, COARSE)
    found = {
        "solution": solution,
        "lines": synth.fit(solution, 2),
        "table": table,
        "simulated": synth.simulate(table, problem, passes=1000),
        "trace": synth.trace(table, problem),
    }
    arrays = [each for name, value in found.items() for each in arrays_in(value, name, set())]
    assert len(arrays) > 60
    assert [where for where, array in arrays if array.flags.writeable] == []
    planted = dataclasses.replace(solution.lines)
    vars(planted)["nodes_m"] = np.zeros(3)
    assert [where for where, array in arrays_in(planted, "lines", set()) if array.flags.writeable] == ["lines.nodes_m"]


def blocks(page: str) -> str:
    """All Python of a page of the documentation, in order."""
    text = (ROOT / page).read_text(encoding="utf-8")
    return "\n".join(re.findall(r"^```python\n(.*?)^```$", text, flags=re.S | re.M))


def run(program: str, directory: Path) -> str:
    """What `program` prints, run in `directory` by itself; a warning is an error."""
    ran = subprocess.run(
        [sys.executable, "-W", "error", "-c", program], cwd=directory, capture_output=True, text=True, timeout=300,
        env={**os.environ, "OPENBLAS_CORETYPE": "Haswell"}, check=False,
    )  # fmt: skip
    assert ran.returncode == 0, ran.stderr
    return ran.stdout


def test_the_example_of_the_readme_runs_and_makes_the_table_of_the_default_book(tmp_path: Path) -> None:
    example = blocks("README.md")
    assert example.startswith("import synth\n")
    assert len(example.splitlines()) <= 10
    store = "\nfrom tuning_tables import write_json; write_json(table, 'table.json')\n"
    printed = run(example + store, tmp_path)
    assert re.fullmatch(r"predicted 0\.0\d+ m/s, Simulated\(20000 passes, seed 1: rms .* m/s\)\n", printed)
    assert (tmp_path / "table.png").read_bytes().startswith(b"\x89PNG")
    expected = kept()["example of the README"]["gondola-4-52t-to-3-m-s"]
    assert coefficients_sha256(read_json(tmp_path / "table.json")) == expected


@pytest.mark.long
def test_the_examples_of_the_page_run(tmp_path: Path) -> None:
    printed = run(blocks("docs/how-to/python.md"), tmp_path)
    assert "within ±" in printed
    assert {path.name for path in tmp_path.iterdir()} == {"lines.png", "passes.csv", "passes.png", "table.json"}


def test_the_import_is_instant_and_values_need_no_kernel() -> None:
    program = "import synth; {}; import sys; print(*{{name.partition('.')[0] for name in sys.modules}})"
    for statement, absent in (("pass", {"numpy", "numba"}), ("synth.Problem, synth.Criterion", {"numba", "scipy"})):
        loaded = set(run(program.format(statement), ROOT).split())
        assert loaded.isdisjoint({*absent, "control", "h5py", "matplotlib"})
