"""The house: who may import whom, what starts at once, what must be documented, and the rooms that the page shows."""

from __future__ import annotations

import ast
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import networkx as nx
import pytest

from scripts.studies.documents import result_of
from scripts.studies.rooms import METHOD, Options, floors_of, purpose_of
from scripts.studies.study import silent

ROOT = Path(__file__).parents[2]
PACKAGES = ("plant_models", "scripts", "synth", "tuning_tables")
HEAVY = ("control", "h5py", "matplotlib", "numba", "scipy")
FILES = sorted(path for package in PACKAGES for path in (ROOT / package).rglob("*.py"))


def lint_imports(directory: Path) -> subprocess.CompletedProcess[str]:
    """Check all import contracts on the checkout in `directory`."""
    command = "from importlinter.cli import lint_imports; raise SystemExit(lint_imports(no_cache=True, no_logo=True))"
    return subprocess.run(
        [sys.executable, "-c", command], cwd=directory, capture_output=True, text=True, timeout=120, check=False
    )


def loaded_by(statement: str) -> set[str]:
    """Return the top-level packages that a fresh interpreter has loaded after `statement`."""
    command = f"{statement}; import sys; print(*{{name.partition('.')[0] for name in sys.modules}})"
    run = subprocess.run(
        [sys.executable, "-c", command], cwd=ROOT, capture_output=True, text=True, timeout=60, check=False
    )
    assert run.returncode == 0, run.stderr
    return set(run.stdout.split())


def relative_names() -> Iterator[str]:
    return (path.relative_to(ROOT).as_posix() for path in FILES)


@pytest.mark.requirement("VERIFY-01")
def test_import_contracts_are_kept() -> None:
    run = lint_imports(ROOT)
    assert run.returncode == 0, run.stdout + run.stderr


INTRUDERS = (
    ("plant_models/intruder.py", "import synth", "plant_models.intruder -> synth (l."),
    ("plant_models/intruder.py", "import tuning_tables", "plant_models.intruder -> tuning_tables (l."),
    ("tuning_tables/intruder.py", "import plant_models", "tuning_tables.intruder -> plant_models (l."),
    ("plant_models/intruder.py", "import matplotlib.pyplot", "plant_models.intruder -> matplotlib (l."),
    ("tuning_tables/rule.py", "import scipy.stats", "tuning_tables.rule -> scipy (l."),
    ("synth/kernels/intruder.py", "import scipy.special", "synth.kernels.intruder -> scipy (l."),
    ("synth/kernels/intruder.py", "from synth.solver import tabulate", "kernels.intruder -> synth.solver.tabulate"),
    ("synth/solver/tabulate.py", "from synth.retarder import tune", "synth.solver.tabulate -> synth.retarder.tune (l."),
    ("synth/intruder.py", "import math", "not listed as layers: - synth.intruder"),
    ("synth/retarder/tune.py", "from synth.retarder.sweep import plan", "tune -> synth.retarder.sweep.plan (l."),
    ("synth/retarder/configuration/cut_class.py", "from synth.retarder import tune", "cut_class -> synth.retarder."),
    ("synth/cli/study.py", "from scripts.studies import cases", "synth.cli.study -> scripts.studies.cases (l."),
    ("plant_models/intruder.py", "import scripts.studies.cases", "plant_models.intruder -> scripts.studies.cases"),
    ("tuning_tables/intruder.py", "def f():\n    import scripts", "tuning_tables.intruder -> scripts (l."),
    ("synth/checker/claims.py", "from tuning_tables import rule", "synth.checker.claims -> tuning_tables.rule (l."),
)
"""A module, an import that no contract allows it, and how that is told."""


@pytest.mark.requirement("VERIFY-01")
def test_an_import_against_the_contracts_is_found(tmp_path: Path) -> None:
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    for package in PACKAGES:
        shutil.copytree(ROOT / package, tmp_path / package, ignore=shutil.ignore_patterns("__pycache__", "*.toml"))
    for name, source, _ in INTRUDERS:
        with (tmp_path / name).open("a", encoding="utf-8") as file:
            file.write(f"\n{source}\n")
    run = lint_imports(tmp_path)
    assert run.returncode == 1, run.stdout + run.stderr
    assert "Contracts: 0 kept" in run.stdout, run.stdout + run.stderr
    told = " ".join(run.stdout.split())
    assert [name for name, _, words in INTRUDERS if words not in told] == []


def test_command_line_starts_without_the_numeric_libraries() -> None:
    assert loaded_by("import synth.cli").isdisjoint({"control", "matplotlib", "numba", "scipy"})


def test_the_declaration_of_the_commands_loads_no_study() -> None:
    assert "scripts" not in loaded_by("import synth.cli.commands, synth.cli.study")


def test_a_table_is_used_with_numpy_alone() -> None:
    loaded = loaded_by("import tuning_tables, tuning_tables.rule, tuning_tables.json_file")
    assert loaded.isdisjoint({*HEAVY, "plant_models", "pydantic", "synth"})


def test_packages_are_found() -> None:
    assert {name.partition("/")[0] for name in relative_names()} == set(PACKAGES)


def test_no_file_collects_what_has_no_name() -> None:
    collectors = {"common", "helper", "helpers", "misc", "util", "utils"}
    assert [name for name in relative_names() if collectors & set(Path(name).with_suffix("").parts)] == []


def test_source_files_are_documented() -> None:
    found = {
        name: list(undocumented(ast.parse(path.read_text(encoding="utf-8"))))
        for name, path in zip(relative_names(), FILES, strict=True)
    }
    assert {name: missing for name, missing in found.items() if missing} == {}


def undocumented(module: ast.Module) -> Iterator[str]:
    """Yield the public functions and classes, and the public functions of classes, that have no docstring."""
    for node in module.body:
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef) and not node.name.startswith("_"):
            if ast.get_docstring(node) is None and not is_overload(node):
                yield f"line {node.lineno}: {node.name}"
            if isinstance(node, ast.ClassDef):
                methods = ast.Module(
                    body=[part for part in node.body if not is_declared_elsewhere(part)], type_ignores=[]
                )
                yield from undocumented(methods)


def is_overload(node: ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef) -> bool:
    return any(ast.unparse(decorator).endswith("overload") for decorator in node.decorator_list)


def is_declared_elsewhere(node: ast.stmt) -> bool:
    """Whether a part of a class has its contract elsewhere: an override, or a validator that pydantic calls."""
    decorators = [ast.unparse(decorator) for decorator in getattr(node, "decorator_list", [])]
    return any("override" in text or "validator" in text or "serializer" in text for text in decorators)


SCRIPTS = sorted(path for path in (ROOT / "scripts").iterdir() if path.is_file() and path.suffix == "")


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.name)
def test_scripts_can_be_started(script: Path) -> None:
    """A shell must be able to read every script up to where Python takes over; ruff's formatter breaks that."""
    text = script.read_text(encoding="utf-8")
    assert script.stat().st_mode & 0o111
    if text.startswith("#!/bin/sh"):
        assert text.splitlines()[1:4] == ["''':'", 'exec "$("${0%/*}/setup")/bin/python" "$0" "$@"', "'''"]
        compile(text, script.name, "exec")
    else:
        assert text.startswith("#!/usr/bin/env bash")
        assert subprocess.run(["bash", "-n", script], capture_output=True, timeout=60, check=False).returncode == 0


def test_the_kept_rooms_are_those_of_the_code() -> None:
    assert result_of(ROOT, "rooms").findings == METHOD.run(Options(), silent), (
        "run 'retarder-synth study rooms --document'"
    )


def test_a_room_stands_as_low_as_it_can_and_the_lowest_below_those_who_know_them() -> None:
    graph = nx.DiGraph([("top", "middle"), ("middle", "low"), ("top", "checker"), ("low", "ground")])
    assert floors_of(graph) == {"top": 3, "middle": 2, "checker": 2, "low": 1, "ground": 0}


def test_a_purpose_is_the_first_sentence_of_the_docstring() -> None:
    assert purpose_of("kernels") == "The inner loops, compiled."
