"""Problems: what is taken, how fine it is computed, and how many stages there may be.

Which problems are taken, and how fine the grids are, by what they are for.
Positions with more or fewer braking stages than four: which of them cuts may be given, from list to exports.
"""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

from plant_models import Friction
from plant_models.errors import PlantError
from plant_models.library.library import WEIGHT_CATEGORIES, TypeFile
from plant_models.library.weight_category import WeightCategories, categories_from
from synth.checker.verdict import verify
from synth.cli import main
from synth.problem.criterion import Criterion
from synth.problem.problem import Aim, Problem
from synth.problem.requirement import FrictionRange
from synth.problem.resolution import (
    LARGE_SPREAD_M_S,
    Resolution,
    design_error_m_s,
    design_resolution,
    estimator_resolution,
    finer_for_check,
)
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.solver.chain import grid
from synth.solver.chain.grid import memory_estimate_bytes, require_memory
from tests.effort import every
from tests.plant_models.test_library import CATEGORIES
from tests.synth.case_factory import make_plant
from tests.system.conftest import CLASS, changed
from tuning_tables import read_book


def test_a_target_is_below_the_highest_entry_speed() -> None:
    plant = make_plant(22.0, 3)
    highest_m_s = plant.entry.high_m_s
    assert Problem(plant, Aim(math.nextafter(highest_m_s, 0.0))).target_speed_m_s < highest_m_s
    with pytest.raises(PlantError, match="there is nothing to brake"):
        Problem(plant, Aim(highest_m_s))


@pytest.mark.parametrize("cv", [0.1, 0.3])
def test_a_worst_case_is_one_that_the_grid_covers(cv: float) -> None:
    """Four standard deviations of the friction of a cut on both sides, as the plant draws it."""
    plant = replace(make_plant(22.0, 3), friction=Friction(cv, 0.0, 0.1, 2.0))
    low, high = (float(factor) for factor in plant.friction.cut_factor(np.array([-4.0, 4.0]), plant.friction_cv))

    def problem(least: float, most: float) -> Problem:
        return Problem(plant, Aim(3.0, Criterion(requirement=FrictionRange(least, most))))

    assert problem(low, high).criterion.requirement == FrictionRange(low, high)
    for least, most in ((math.nextafter(low, 0.0), high), (low, math.nextafter(high, 9.0))):
        with pytest.raises(PlantError, match="the friction of this cut is modelled from"):
            problem(least, most)


def test_a_table_is_predicted_with_half_of_both_steps() -> None:
    design = Resolution(path_step_m=0.4, speed_step_m_s=0.05, reference_speed_m_s=2.5)
    check = finer_for_check(design)
    assert (check.path_step_m, check.speed_step_m_s, check.reference_speed_m_s) == (0.2, 0.025, 2.5)


@pytest.mark.parametrize(("share", "values"), [(0.9, 1), (1.1, 2)])
def test_surfaces_are_designed_for_two_resistances_where_their_spread_moves_the_exit_speed(
    share: float, values: int
) -> None:
    plant = make_plant(22.0, 3)
    taken = 2.0 * plant.cut.reduced_gravity_m_s2 * 1e-3 * plant.resistance.std_n_per_kn * plant.exit_m

    def beyond(target_m_s: float) -> float:
        slower = math.sqrt(max(target_m_s**2 - taken, 0.0))
        return target_m_s - slower - share * LARGE_SPREAD_M_S

    target_m_s = brentq(beyond, math.sqrt(taken), 19.0)
    assert design_resolution(plant, target_m_s).resistance_nodes == values


@pytest.mark.parametrize("lowest_m_s", [1.0, 2.0, 3.0, 5.0])
@pytest.mark.parametrize("noise_m_s", [0.05, 0.2])
def test_no_cell_is_wider_than_the_error_of_the_estimate(lowest_m_s: float, noise_m_s: float) -> None:
    sensor = replace(make_plant(22.0, 3).sensor, noise_m_s=noise_m_s)
    usual = Resolution(speed_step_m_s=0.03, reference_speed_m_s=3.0)
    found = estimator_resolution(usual, sensor, lowest_m_s)
    slowest_m_s = min(lowest_m_s, usual.reference_speed_m_s)
    widest_m_s = found.speed_step_m_s * usual.reference_speed_m_s / slowest_m_s
    usual_m_s = usual.speed_step_m_s * usual.reference_speed_m_s / slowest_m_s
    assert widest_m_s == pytest.approx(min(usual_m_s, design_error_m_s(sensor)))


def test_solves_may_take_four_fifths_of_the_free_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    plant, grids = make_plant(22.0, 3), (Resolution(), finer_for_check(Resolution()))
    needed = 2 * memory_estimate_bytes(plant, grids)
    monkeypatch.setattr(grid, "available_memory_bytes", lambda: int(needed / 0.79))
    require_memory("gondola", plant, grids, 2)
    monkeypatch.setattr(grid, "available_memory_bytes", lambda: int(needed / 0.81))
    with pytest.raises(PlantError, match="solving gondola would take about"):
        require_memory("gondola", plant, grids, 2)


def config_of(braking_stages: int, lines: str = "") -> ResolvedConfig:
    """The default book at a position with so many braking stages of equal steps."""
    pressures = [600.0 * k / braking_stages for k in range(braking_stages + 1)]
    return parse_config(f"retarder.stage_pressures_kpa = {pressures}\n{lines}", "c.toml")


@pytest.mark.parametrize(
    ("stages", "allowed", "at_entrance"),
    [
        (1, [1, 1, 1, 1, 1], [1, 1, 1, 1, 1]),
        (2, [1, 1, 2, 2, 2], [1, 1, 1, 2, 2]),
        (3, [1, 2, 3, 3, 3], [1, 1, 2, 3, 3]),
        (4, [2, 3, 4, 4, 4], [2, 2, 3, 4, 4]),
        (6, [3, 4, 6, 6, 6], [3, 3, 4, 6, 6]),
        (8, [4, 6, 8, 8, 8], [4, 4, 6, 8, 8]),
    ],
)
def test_a_category_is_allowed_the_same_part_of_the_stages(
    stages: int, allowed: list[int], at_entrance: list[int]
) -> None:
    config = config_of(stages)
    assert config.warnings == ()
    assert [cut.cut.allowed_stage for cut in config.cuts] == allowed
    assert [plant.entrance_stage for _, plant in config.plants()] == at_entrance
    highest_kpa = config.retarder.position.stage_pressures_kpa
    of_four = [300.0, 450.0, 600.0, 600.0, 600.0]
    assert all(highest_kpa[k] <= most for k, most in zip(allowed, of_four, strict=True) if stages > 1)


@pytest.mark.parametrize("stage", range(1, 7))
def test_the_sensible_range_ends_with_the_highest_stage(stage: int) -> None:
    config = config_of(
        6, f'[[cut]]\ncar = "gondola-4"\nmass_t = 80\nallowed_stage = {stage}\nentrance_stage = {stage}\n'
    )
    assert config.warnings == ()
    ((_, plant),) = config.plants()
    assert plant.top_stage == plant.entrance_stage == stage
    ranges = {value.key: value.range for value in config.parameters}
    assert (ranges["cut[0].allowed_stage"], ranges["cut[0].entrance_stage"]) == ((1.0, 6.0), (0.0, 6.0))


def categories_in(text: str) -> WeightCategories:
    """The categories written in `text`."""
    return categories_from(TypeFile(WEIGHT_CATEGORIES, "x", text, "categories.toml"))


def test_stages_of_a_file_that_does_not_say_of_how_many_stay_as_they_are() -> None:
    silent = categories_in(changed(CATEGORIES, ("braking_stages = 4\n", "")))
    assert [each.of_stages for each in silent.members] == [None] * 5
    for top, allowed in ((1, [1, 1, 1, 1, 1]), (3, [2, 3, 3, 3, 3]), (6, [2, 3, 4, 4, 4])):
        assert [each.at(top).allowed_stage for each in silent.members] == allowed


def test_who_counts_twice_counts_the_same() -> None:
    for each in categories_in(CATEGORIES).members:
        assert each.at(6).at(6) == each.at(6)
        assert each.at(4).provenance == each.provenance


@pytest.mark.parametrize(
    ("stages", "said"),
    [
        ("0", "braking_stages is 0; it must be a whole number from 1 to 31"),
        ("32", "braking_stages is 32; it must be"),
        ("2.0", "braking_stages is 2.0; it must be"),
        ("true", "braking_stages is True; it must be"),
        ("3", "S: allowed_stage is 4; it must be at most 3, the braking_stages of this file"),
    ],
)
def test_a_bad_number_of_stages_is_refused(stages: str, said: str) -> None:
    with pytest.raises(PlantError, match=said):
        categories_in(changed(CATEGORIES, ("braking_stages = 4", f"braking_stages = {stages}")))


@pytest.mark.parametrize("stages", every(3, [1, 2, 6]))
def test_all_stages_are_used_from_tune_to_exports(
    stages: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """One heavy class; `verify` works out every export anew, and simulates with all stages."""
    pressures = [600.0 * k / stages for k in range(stages + 1)]
    swaps = (
        ("[entry]", f"[retarder]\nstage_pressures_kpa = {pressures}\n[entry]"),
        ("mass_t = 22", "mass_t = 66"),
        ("[1.5]", "[2.5]"),
        ("csv = true", "csv = true\nplots = false\nreport = false"),
    )  # fmt: skip
    config, out = tmp_path / "c.toml", tmp_path / "out"
    config.write_text(changed(CLASS, *swaps), encoding="utf-8")
    assert main(["tune", str(config), "-o", str(out)]) in (0, 1)
    assert "sensible range" not in capsys.readouterr().err
    (table,) = read_book(out / "book.h5")
    assert table.highest_raised == stages
    assert len(table.stages) == stages + 1
    assert main(["export", str(out / "book.h5"), "--format", "st", "-o", str(out / "st")]) == 0
    verdict = verify(out, 200, 1)
    assert {"c", "st"} <= {Path(name).parts[0] for name in verdict.files}
    assert verdict.code == 0, verdict.findings
    (checked,) = verdict.tables
    assert checked.table.top_stage == stages
    assert checked.figures is not None
