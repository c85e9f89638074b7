"""The table [sweep]: what it expands to, and one sentence for whatever is wrong with it."""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from synth.frame.settings.toml_text import toml_text
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.sweep.plan import plan_of
from synth.retarder.sweep.sweep_file import parse_sweep
from tests.sweep.conftest import MEASURED, PLANT, SWEEP, Ran

CONDITIONS = """\
[[sweep.condition]]
name = "dry"
[[sweep.condition]]
name = "wet"
friction.common_cv = 0.2
retarder.pneumatics.fill_time_constant_s = 0.45
"""

FAULTS = {
    "step that does not fit": ("step = 0.5", "step = 0.3", "sweep.exit_speeds_m_s is {"),
    "step of zero": ("step = 0.5", "step = 0", "step above 0"),
    "too many": ("step = 0.5", "step = 0.0001", "at most 1000 values"),
    "no number": ("from = 1.5", "from = true", "a number, a list of 1 to 1000 numbers, or {from"),
    "infinite": ("from = 1.5", "from = -inf", "a number, a list"),
    "unknown key": ("passes = 1000", "pases = 200", "did you mean passes?"),
    "unknown key of a class": ("mass_per_car_t", "mass_t", "did you mean mass_per_car_t?"),
    "missing key": ('car = "gondola-4"', "", "sweep.cut[0].car is missing"),
    "too few passes": ("passes = 1000", "passes = 1", "sweep.passes is 1; it must be from 1000 to 50000"),
    "text": ("passes = 1000", "passes = 'many'", "sweep.passes is 'many'; it must be a whole number"),
    "no list of tables": ("[[sweep.cut]]", "[sweep.cut]", "write [[sweep.cut]], not [sweep.cut]"),
    "unknown car": ("gondola-4", "gondola-5", "cut[0].car is 'gondola-5'"),
    "too heavy": ("to = 30", "to = 130", "weigh together"),
    "loss of zero": (
        "passes = 1000",
        "interpolation_loss_m_s = 0.0",
        "sweep.interpolation_loss_m_s is 0.0; it must be",
    ),
    "target above entry": ("to = 2.0", "to = 4.5", "a target must be"),
    "cars": ("mass_per_car_t", "cars = [1.5]\nmass_per_car_t", "whole numbers from 1 to 60"),
    "base": ("degree = 2", "degre = 2", "did you mean degree?"),
    "estimator": (
        "[sweep]",
        "[regulator]\nestimator = true\n[sweep]\ninterpolation_loss_m_s = 0.01",
        "no exact prediction to measure",
    ),
    "equal names": ("[sweep]", '[[sweep.condition]]\nname = "A"\n[[sweep.condition]]\nname = "a"\n[sweep]', "name"),
    "no TOML": ("[sweep]", "[sweep", "not valid TOML"),
}

CONDITION_FAULTS = {
    "no name": ('name = "wet"', "", "sweep.condition[1].name is missing"),
    "slash": ('name = "wet"', 'name = "../wet"', "letters, digits"),
    "twice": ('name = "wet"', 'name = "Dry"', "sweep.condition holds 'Dry' twice"),
    "other section": ("friction.common_cv", "grid.path_step_m", "unknown key; known: entry"),
    "unknown key": ("common_cv", "comon_cv", 'in sweep.condition[1], "wet": friction.comon_cv'),
    "out of range": ("0.2", "-0.2", 'in sweep.condition[1], "wet": friction.common_cv'),
}


@pytest.mark.parametrize("name", [*FAULTS, *(f"condition: {name}" for name in CONDITION_FAULTS)])
def test_one_sentence_for_a_fault(command: Callable[..., Ran], tmp_path: Path, name: str) -> None:
    of_condition = name.startswith("condition: ")
    old, new, said = (CONDITION_FAULTS if of_condition else FAULTS)[name.removeprefix("condition: ")]
    text = PLANT + SWEEP + (CONDITIONS if of_condition else "")
    assert old in text
    config, out = tmp_path / "bad.toml", tmp_path / "out"
    config.write_text(text.replace(old, new, 1), encoding="utf-8")
    code, told, words = command("sweep", "run", config, "-o", out)
    assert (code, told) == (2, "")
    assert words.startswith(f"retarder-synth: {config}: ")
    faults = words.splitlines()
    assert all(line.startswith(f"retarder-synth: {config}: ") for line in faults)
    assert len(faults) == 1 or len(set(faults)) == len(faults)  # one for each class that is at fault
    assert said in words
    assert not out.exists()


def test_faults_of_use(
    command: Callable[..., Ran], monkeypatch: pytest.MonkeyPatch, config: Path, tmp_path: Path
) -> None:
    monkeypatch.setattr("synth.frame.workers.dask_cluster.ANSWER_WITHIN_S", 1)
    out = tmp_path / "out"
    for arguments, said in (
        (("run",), "Missing argument"),
        (("run", config, "-o", out, "--workers", "2", "--scheduler", "tcp://x:1"), "leave one out"),
        (("status", tmp_path), "there is no sweep in it"),
        (("failed", tmp_path / "none"), "there is no sweep in it"),
        (("restart", tmp_path), "No such command"),
        (("run", config, "-o", out, "--scheduler", "tcp://127.0.0.1:1"), "Dask"),
    ):
        code, told, words = command("sweep", *arguments)
        assert (code, told) == (2, "")
        assert said in words.splitlines()[-1]
        assert "Traceback" not in words


def test_classes_targets_and_conditions_are_crossed() -> None:
    text = PLANT + SWEEP.replace("mass_per_car_t", "cars = [1, 2]\nmass_per_car_t") + CONDITIONS
    file = parse_sweep(text, "x")
    plan = plan_of(file, "2020-01-01T00:00:00Z")
    masses = ["22t", "26t", "30t"]
    classes = [f"gondola-4-{mass}" for mass in masses] + [f"gondola-4x2-{mass}" for mass in ("44t", "52t", "60t")]
    assert [unit.order.name for unit in plan.units] == [f"{name}/{each}" for name in ("dry", "wet") for each in classes]
    assert len({unit.order.key for unit in plan.units}) == 12
    dry, wet = (condition.config for condition in file.conditions)
    assert dry.targets_m_s == wet.targets_m_s == (1.5, 2.0)
    assert (dry.retarder.friction.common_cv, wet.retarder.friction.common_cv) == (0.15, 0.2)
    assert wet.retarder.position.pneumatics.fill_time_constant_s == 0.45
    assert dry.validation.passes == 1000


def test_a_key_tells_of_everything_but_the_date_and_the_other_classes() -> None:
    def keys(text: str, created: str = "2020-01-01T00:00:00Z") -> list[str]:
        return [unit.order.key for unit in plan_of(parse_sweep(text, "x"), created).units]

    base = keys(PLANT + SWEEP)
    assert keys(PLANT + SWEEP, "2021-01-01T00:00:00Z") == base
    assert keys('title = "Other"\n' + PLANT + SWEEP) == base
    assert keys(PLANT + SWEEP.replace("to = 30", "to = 34"))[:3] == base
    for old, new in (("passes = 1000", "passes = 1200"), ("2.0", "2.5"), ("degree = 2", "degree = 3")):
        assert set(keys((PLANT + SWEEP).replace(old, new))).isdisjoint(base)
    measured = keys(PLANT + MEASURED + SWEEP)
    assert set(measured).isdisjoint(base)
    refined = keys(PLANT + MEASURED + SWEEP.replace("[sweep]", "[sweep]\ninterpolation_loss_m_s = 0.01"))
    assert set(refined).isdisjoint({*base, *measured})


def test_a_condition_is_an_ordinary_configuration() -> None:
    for condition in parse_sweep(PLANT + SWEEP + CONDITIONS, "x").conditions:
        text = toml_text(condition.tree)
        assert tomllib.loads(text) == condition.tree
        assert parse_config(text, "x").sha256 == condition.config.sha256


def test_what_init_prints_is_the_default_and_its_examples_are_allowed(command: Callable[..., Ran]) -> None:
    text = command("init", "sweep")[1]
    assert parse_sweep(text, "x") == parse_sweep("", "x")
    examples = re.sub(r"(?m)^# (?=\[\[|[a-z_]+ = )", "", text)
    swept = parse_sweep(MEASURED + examples, "x")
    assert [each.name for each in swept.conditions] == ["dry", "wet"]
    assert swept.settings.interpolation_loss_m_s == 0.001
    assert len(swept.base.cuts) == 3


LEAVES = st.one_of(st.booleans(), st.integers(-(2**53), 2**53), st.floats(allow_nan=False), st.text())
NAMES = st.text(min_size=1, max_size=8)
TREES = st.recursive(
    LEAVES,
    lambda below: st.one_of(st.lists(below, max_size=3), st.dictionaries(NAMES, below, max_size=3)),
    max_leaves=12,
)


@given(st.dictionaries(NAMES, TREES, max_size=4))
def test_toml_reads_back(tree: dict[str, object]) -> None:
    assert tomllib.loads(toml_text(tree)) == tree


@pytest.mark.parametrize("arguments", [["sweep", "run", "--help"], ["sweep", "failed", "."], ["sweep", "status", "."]])
def test_nothing_heavy_is_imported_to_tell(serial: Path, arguments: list[str]) -> None:
    source = (
        "import sys; from synth.cli import main; code = main(sys.argv[1:]); "
        "print(*{name.partition('.')[0] for name in sys.modules}, file=sys.stderr); raise SystemExit(code)"
    )
    ran = subprocess.run(
        [sys.executable, "-c", source, *arguments], cwd=serial, capture_output=True, text=True, timeout=60, check=False
    )
    assert ran.returncode == 0, ran.stderr
    assert set(ran.stderr.split()).isdisjoint({"control", "distributed", "h5py", "matplotlib", "numba", "scipy"})
