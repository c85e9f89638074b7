"""A sweep over types of one's own: units carry them, and the configuration that is left reads back to the same."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from plant_models.library import BUILT_IN, CARS, RETARDERS
from synth.frame.workers.engine import InThisProcess
from synth.retarder.configuration.config_file import load_config
from synth.retarder.sweep.plan import plan_of
from synth.retarder.sweep.sweep_file import SweepFile, parse_sweep
from synth.retarder.sweep.tune_unit import tune_unit
from synth.retarder.sweep.unit_answer import answer
from tests.sweep.conftest import EPOCH, PLANT, run
from tuning_tables import read_book

SWEEP = """\
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
def config(tmp_path: Path) -> Path:
    """A sweep whose car and second retarder are files of one's own."""
    for kind, name, own in ((CARS, "gondola-4", "short-4"), (RETARDERS, "rnz-2m", "strong")):
        path = tmp_path / "mine" / kind.folder / f"{own}.toml"
        path.parent.mkdir(parents=True)
        text = BUILT_IN.file(kind, name).text
        path.write_text(text.replace("value = 0.0442", "value = 0.06"), encoding="utf-8")
    path = tmp_path / "sweep.toml"
    path.write_text(f"{PLANT}[targets]\nexit_speeds_m_s = [1.5]\n{SWEEP}", encoding="utf-8")
    return path


def load_sweep(path: Path) -> SweepFile:
    """The sweep in a file."""
    return parse_sweep(path.read_text(encoding="utf-8"), str(path))


def test_a_unit_needs_no_file_and_a_book_keeps_the_types_beside_it(
    config: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", EPOCH)
    file = load_sweep(config)
    units = plan_of(file, "2026-01-01T00:00:00Z").units
    (tmp_path / "mine").rename(tmp_path / "gone")
    assert len(tune_unit(units[0].order).rows) == 1
    (tmp_path / "gone").rename(tmp_path / "mine")

    out = tmp_path / "out"
    run(config, out, InThisProcess(answer))
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
def test_types_of_an_earlier_run_do_not_stay_beside_the_book(config: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    run(config, out, InThisProcess(answer))
    (tmp_path / "mine" / "cars" / "short-4.toml").rename(tmp_path / "mine" / "cars" / "new-4.toml")
    config.write_text(config.read_text(encoding="utf-8").replace("short-4", "new-4"), encoding="utf-8")
    run(config, out, InThisProcess(answer))
    assert [path.name for path in (out / "dry" / "types" / "cars").iterdir()] == ["new-4.toml"]


def test_a_unit_whose_type_has_changed_is_another_one(config: Path) -> None:
    keys = [unit.order.key for unit in plan_of(load_sweep(config), "2026-01-01T00:00:00Z").units]
    car = config.parent / "mine" / "cars" / "short-4.toml"
    text = car.read_text(encoding="utf-8")
    car.write_text(text.replace("value = 8.65, range = [8.65, 8.65]", "value = 8.6, range = [8, 9]"), encoding="utf-8")
    changed = plan_of(load_sweep(config), "2026-01-01T00:00:00Z").units
    assert not set(keys) & {unit.order.key for unit in changed}
    assert replace(changed[0].order, library=BUILT_IN) != changed[0].order
