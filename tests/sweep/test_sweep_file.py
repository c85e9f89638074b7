"""The table [sweep]: what it expands to, what is wrong with it, and the tables that bisection keeps."""

from __future__ import annotations

import json
import math
import re
import subprocess
import sys
import tomllib
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from synth.frame.settings.template import toml_text
from synth.frame.workers.engine import InThisProcess
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.sweep.command import answer
from synth.retarder.sweep.plan import Bench, Gap, Refinement, plan_of, refined
from synth.retarder.sweep.sweep_file import parse_sweep
from synth.retarder.sweep.tune_unit import between_rms_m_s, setup_of, tune_unit, tuned_tables
from synth.simulation.closed_loop import TableController, close_loop
from synth.simulation.random_passes import random_passes
from tests.sweep.conftest import MEASURED, PLANT, SWEEP, Ran, run
from tuning_tables import TableBook, read_book

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


OWN = 0.03


def parabola(curvature: float) -> Bench[float]:
    """Tables are their targets; lines between are off by curvature (T − T0)(T1 − T)/2, added to an rms in squares."""

    def between(slower: float, faster: float, target: float) -> float:
        return math.hypot(OWN, 0.5 * curvature * (target - slower) * (faster - target))

    return Bench(tune=lambda targets: list(targets), own_rms_m_s=lambda table: OWN, between_rms_m_s=between)


def closed_form_loss(step: float, curvature: float) -> float:
    return math.hypot(OWN, curvature * step**2 / 8.0) - OWN


@pytest.mark.parametrize("loss", [0.0005, 0.002, 0.01])
def test_the_step_is_that_of_the_closed_form(loss: float) -> None:
    curvature = 0.3
    kept, gaps = refined((1.0, 5.0), parabola(curvature), Refinement(loss, 0.01))
    step = 4.0
    while closed_form_loss(step, curvature) > loss:
        step /= 2.0
    assert np.diff(kept) == pytest.approx(step)
    left = [gap for gap in gaps if not gap.refined]
    assert len(left) == len(kept) - 1
    assert max(gap.loss_m_s for gap in left) == pytest.approx(closed_form_loss(step, curvature))
    # No book with even steps on these bisections has fewer tables and keeps the loss.
    assert closed_form_loss(2.0 * step, curvature) > loss


def test_the_smallest_step_ends_it_and_the_loss_left_is_told() -> None:
    kept, gaps = refined((1.0, 2.0), parabola(10.0), Refinement(1e-4, 0.25))
    assert kept == [1.0, 1.25, 1.5, 1.75, 2.0]
    left = [gap for gap in gaps if not gap.refined]
    assert [(gap.low_m_s, gap.high_m_s) for gap in left] == [(1.0, 1.25), (1.25, 1.5), (1.5, 1.75), (1.75, 2.0)]
    assert all(gap.loss_m_s > 1e-4 for gap in left)


def test_only_where_it_is_needed() -> None:
    def between(slower: float, faster: float, target: float) -> float:
        return OWN + (0.01 if slower < 2.0 and faster - slower > 0.3 else 0.0)

    asked: list[float] = []

    def tune(targets: Sequence[float]) -> list[float]:
        asked.extend(targets)
        return list(targets)

    kept, _ = refined((3.0, 1.0, 2.0), Bench(tune, lambda table: OWN, between), Refinement(0.001, 0.1))
    assert kept == [1.0, 1.25, 1.5, 1.75, 2.0, 3.0]
    assert len(asked) == len(set(asked))


def test_lines_between_are_those_that_a_controller_takes() -> None:
    text = (
        PLANT + MEASURED + SWEEP.replace("to = 30", "to = 22").replace("to = 2.0, step = 0.5", "to = 2.5, step = 1.0")
    )
    text = text.replace(
        "path_step_m = 1.0\nspeed_step_m_s = 0.05\nfriction_scenarios = 3\nresistance_scenarios = 1\n", ""
    )  # the default grid instead: a coarse one predicts too much
    config, setup = setup_of(plan_of(parse_sweep(text, "x"), "2020-01-01T00:00:00Z").units[0].order)
    (slower, faster), _ = tuned_tables(config, setup, (1.5, 2.5))
    # At the targets themselves the lines between are the tables' own: rounding is all that may differ.
    for table in (slower, faster):
        target = table.target_speed_m_s
        assert between_rms_m_s(setup.check, slower, faster, target) == pytest.approx(table.predicted.rms_m_s, rel=1e-5)
    # Half-way, the choice of the book is simulated: another way to the lines and another way to the error.
    choice = TableBook((slower, faster)).choose(slower.cut.category, 4, 2.0)
    assert choice.table is not None
    n = 20_000
    loop = close_loop(setup.plant, choice.table.coefficients.shape[0])
    sample = loop.run(TableController(choice.table), loop.draws(random_passes(7, 0, n)))
    square = (sample.exit_speed_m_s - 2.0) ** 2
    half = 1.96 * square.std() / math.sqrt(n)
    exact = between_rms_m_s(setup.check, slower, faster, 2.0)
    assert exact == pytest.approx(math.sqrt(square.mean()), rel=0.1 + half / square.mean())


@pytest.mark.long
def test_a_refined_book_keeps_its_loss(tmp_path: Path) -> None:
    config = tmp_path / "refined.toml"
    coarse = SWEEP.replace("{ from = 1.5, to = 2.0, step = 0.5 }", "[1.0, 3.0]").replace("to = 30", "to = 22")
    loss = 0.002
    wanted = f"interpolation_loss_m_s = {loss}\nsmallest_step_m_s = 0.05\npasses"
    config.write_text(PLANT + MEASURED + coarse.replace("passes", wanted), encoding="utf-8")
    assert run(config, tmp_path / "out", InThisProcess(answer)) == 0
    targets = [table.target_speed_m_s for table in read_book(tmp_path / "out" / "book.h5")]
    assert len(targets) > 2
    assert targets == sorted(targets)
    gaps = tune_unit(plan_of(parse_sweep(config.read_text(), "x"), "2020-01-01T00:00:00Z").units[0].order).gaps
    left = sorted((gap for gap in gaps if not gap.refined), key=lambda gap: gap.low_m_s)
    assert [gap.low_m_s for gap in left] + [left[-1].high_m_s] == targets
    assert max(gap.loss_m_s for gap in left) <= loss
    for gap in gaps:
        assert gap.refined == (gap.loss_m_s > loss)
    tables = json.loads((tmp_path / "out" / "summary.json").read_text(encoding="utf-8"))["tables"]
    (told,) = tables["conditions"]
    assert [gap["loss_m_s"] for gap in tables["interpolation"]] == [gap.loss_m_s for gap in gaps]
    assert told["highest_interpolation_loss_m_s"] == max(gap.loss_m_s for gap in left)
    assert isinstance(gaps[0], Gap)
