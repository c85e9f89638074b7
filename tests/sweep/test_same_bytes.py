"""Whoever computes a sweep, its bytes are the same, also with types of one's own; sweep and tune never mix."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from plant_models.library import BUILT_IN, CARS, RETARDERS
from synth.frame.workers.engine import InThisProcess
from synth.frame.workers.local_workers import LocalWorkers
from synth.retarder.configuration.config_file import load_config
from synth.retarder.sweep.command import answer
from synth.retarder.sweep.plan import plan_of
from synth.retarder.sweep.sweep_file import SweepFile, parse_sweep
from synth.retarder.sweep.tune_unit import tune_unit
from tests.sweep.conftest import EPOCH, MEASURED, PLANT, SWEEP, Ran, contents, events, run
from tuning_tables import read_book

TUNED = """\
[validation]
passes = 1000
[targets]
exit_speeds_m_s = [1.5, 2.0]
[output]
plots = false
report = false
[[cut]]
car = "gondola-4"
mass_t = 22
[[cut]]
car = "gondola-4"
mass_t = 26
[[cut]]
car = "gondola-4"
mass_t = 30
"""


@pytest.mark.parametrize("workers", [pytest.param(1, marks=pytest.mark.long), 2])
def test_worker_processes_give_the_bytes_of_this_process(
    config: Path, serial: Path, tmp_path: Path, workers: int
) -> None:
    assert run(config, tmp_path / "out", LocalWorkers(workers, answer)) == 0
    assert contents(tmp_path / "out") == contents(serial)


@pytest.mark.long
@pytest.mark.parametrize("regulator", ["", MEASURED])
def test_tables_are_those_of_a_tune(command: Callable[..., Ran], serial: Path, tmp_path: Path, regulator: str) -> None:
    # The same steps, but a tune solves each target beside other ones.
    (tmp_path / "tune.toml").write_text(PLANT + regulator + TUNED, encoding="utf-8")
    code, _, said = command("tune", tmp_path / "tune.toml", "-o", tmp_path / "out", "--workers", "2")
    assert code in (0, 1), said
    if regulator:
        (tmp_path / "sweep.toml").write_text(PLANT + regulator + SWEEP, encoding="utf-8")
        assert run(tmp_path / "sweep.toml", tmp_path / "swept", LocalWorkers(2, answer)) == 0
    tuned = read_book(tmp_path / "out" / "book.h5")
    swept = read_book((tmp_path / "swept" if regulator else serial) / "book.h5")
    assert len(tuned) == 6
    assert all((table.estimator is None) == bool(regulator) for table in tuned)
    assert all(one == other for one, other in zip(swept, tuned, strict=True))


@pytest.mark.long
def test_a_grown_grid_keeps_what_is_there(config: Path, serial: Path, tmp_path: Path) -> None:
    larger, smaller = tmp_path / "larger.toml", tmp_path / "smaller.toml"
    larger.write_text(config.read_text(), encoding="utf-8")
    smaller.write_text(config.read_text().replace("to = 30", "to = 26"), encoding="utf-8")
    out = tmp_path / "out"
    assert run(smaller, out, InThisProcess(answer)) == run(larger, out, InThisProcess(answer)) == 0
    assert len(events(out, "started")) == 3
    kept, new = contents(out), contents(serial)
    # Tables are stamped with the configuration of the last run, whichever run computed them; results are not.
    assert {name: kept[name] for name in new if not name.startswith("sweep/units")} == {
        name: content for name, content in new.items() if not name.startswith("sweep/units")
    }


TUNE = (
    PLANT
    + """\
[targets]
exit_speeds_m_s = [1.5]
[validation]
passes = 1000
[output]
plots = false
[[cut]]
car = "gondola-4"
mass_t = 22
"""
)
CONDITIONS = PLANT + SWEEP + '[[sweep.condition]]\nname = "dry"\n[[sweep.condition]]\nname = "wet"\n'


@pytest.fixture
def tune_config(tmp_path: Path) -> Path:
    path = tmp_path / "tune.toml"
    path.write_text(TUNE, encoding="utf-8")
    return path


@pytest.fixture
def conditions(tmp_path: Path) -> Path:
    path = tmp_path / "conditions.toml"
    path.write_text(CONDITIONS, encoding="utf-8")
    return path


def test_no_tune_into_a_sweep(command: Callable[..., Ran], serial: Path, tune_config: Path, tmp_path: Path) -> None:
    out = Path(shutil.copytree(serial, tmp_path / "out"))
    before = contents(out)
    code, told, said = command("tune", tune_config, "-o", out)
    assert (code, told) == (2, "")
    assert f"{out}: it holds the results of 'sweep run'; give another directory by -o" in said
    assert contents(out) == before


def test_no_tune_into_a_condition_of_a_sweep(
    command: Callable[..., Ran], serial: Path, tune_config: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = Path(shutil.copytree(serial, tmp_path / "out"))
    (out / "dry").mkdir()
    shutil.copy(out / "config.toml", out / "dry")
    for path in (out / "dry", Path("."), out / "dry" / ".." / "dry"):
        monkeypatch.chdir(out / "dry")
        code, _, said = command("tune", tune_config, "-o", path)
        assert code == 2
        assert "it holds config.toml, which 'tune' did not write" in said
    assert [path.name for path in (out / "dry").iterdir()] == ["config.toml"]


@pytest.mark.parametrize("name", ["book.h5", "summary.json", "report.html", "c/retarder_table.c"])
def test_no_sweep_into_a_tune(
    command: Callable[..., Ran], config: Path, conditions: Path, tmp_path: Path, name: str
) -> None:
    for file, folder in ((config, tmp_path / "out"), (conditions, tmp_path / "outer" / "wet")):
        (folder / name).parent.mkdir(parents=True)
        (folder / name).write_bytes(b"of a tune")
        code, _, said = command("sweep", "run", file, "-o", tmp_path / folder.relative_to(tmp_path).parts[0])
        assert code == 2
        assert f"{name}, which 'sweep run' did not write; give a new or an empty directory by -o" in said
        assert contents(folder) == {name: b"of a tune"}


def test_a_tune_below_a_sweep_is_no_condition_of_it(
    command: Callable[..., Ran], serial: Path, tune_config: Path, tmp_path: Path
) -> None:
    out = Path(shutil.copytree(serial, tmp_path / "out"))
    assert command("tune", tune_config, "-o", out / "tune")[0] in (0, 1)
    assert (out / "tune" / "summary.json").exists()


OWN_SWEEP = """\
[sweep]
passes = 1000
[[sweep.cut]]
car = "mine/cars/short-4.toml"
mass_per_car_t = [22, 26]
[[sweep.condition]]
name = "dry"
[[sweep.condition]]
name = "other"
retarder.type = "mine/retarders/strong.toml"
"""


@pytest.fixture
def own_config(tmp_path: Path) -> Path:
    """A sweep whose car and second retarder are files of one's own."""
    for kind, name, own in ((CARS, "gondola-4", "short-4"), (RETARDERS, "rnz-2m", "strong")):
        path = tmp_path / "mine" / kind.folder / f"{own}.toml"
        path.parent.mkdir(parents=True)
        text = BUILT_IN.file(kind, name).text
        path.write_text(text.replace("value = 0.0442", "value = 0.06"), encoding="utf-8")
    path = tmp_path / "sweep.toml"
    path.write_text(f"{PLANT}[targets]\nexit_speeds_m_s = [1.5]\n{OWN_SWEEP}", encoding="utf-8")
    return path


def load_sweep(path: Path) -> SweepFile:
    """The sweep in a file."""
    return parse_sweep(path.read_text(encoding="utf-8"), str(path))


def test_a_unit_needs_no_file_and_a_book_keeps_the_types_beside_it(
    own_config: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", EPOCH)
    file = load_sweep(own_config)
    units = plan_of(file, "2026-01-01T00:00:00Z").units
    (tmp_path / "mine").rename(tmp_path / "gone")
    assert len(tune_unit(units[0].order).rows) == 1
    (tmp_path / "gone").rename(tmp_path / "mine")

    out = tmp_path / "out"
    run(own_config, out, InThisProcess(answer))
    (tmp_path / "mine").rename(tmp_path / "gone")
    for condition in file.conditions:
        beside = load_config(out / condition.name / "config.toml")
        assert beside.canonical_json() == condition.config.canonical_json()
        tables = read_book(out / condition.name / "book.h5")
        assert {t.id for t in tables} == {f"{condition.name}-short-4-{m}t-to-1.5-m-s" for m in (22, 26)}
        assert {t.generator.config_sha256 for t in tables} == {beside.sha256}
    dry, other = (json.loads(c.config.canonical_json())["retarder"]["force"] for c in file.conditions)
    assert (dry["slope_kn_per_kpa"], other["slope_kn_per_kpa"]) == (0.0442, 0.06)


@pytest.mark.long
def test_types_of_an_earlier_run_do_not_stay_beside_the_book(own_config: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    run(own_config, out, InThisProcess(answer))
    (tmp_path / "mine" / "cars" / "short-4.toml").rename(tmp_path / "mine" / "cars" / "new-4.toml")
    own_config.write_text(own_config.read_text(encoding="utf-8").replace("short-4", "new-4"), encoding="utf-8")
    run(own_config, out, InThisProcess(answer))
    assert [path.name for path in (out / "dry" / "types" / "cars").iterdir()] == ["new-4.toml"]


def test_a_unit_whose_type_has_changed_is_another_one(own_config: Path) -> None:
    keys = [unit.order.key for unit in plan_of(load_sweep(own_config), "2026-01-01T00:00:00Z").units]
    car = own_config.parent / "mine" / "cars" / "short-4.toml"
    text = car.read_text(encoding="utf-8")
    car.write_text(text.replace("value = 8.65, range = [8.65, 8.65]", "value = 8.6, range = [8, 9]"), encoding="utf-8")
    changed = plan_of(load_sweep(own_config), "2026-01-01T00:00:00Z").units
    assert not set(keys) & {unit.order.key for unit in changed}
    assert replace(changed[0].order, library=BUILT_IN) != changed[0].order
