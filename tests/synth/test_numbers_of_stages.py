"""Positions with more or fewer braking stages than four: which of them cuts may be given, from list to exports."""

from __future__ import annotations

from pathlib import Path

import pytest

from plant_models.errors import PlantError
from plant_models.library.type_file import WEIGHT_CATEGORIES, TypeFile
from plant_models.library.weight_category import WeightCategories, categories_from
from synth.checker.verdict import verify
from synth.cli import main
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from tests.effort import every
from tests.plant_models.test_library import CATEGORIES
from tests.system.conftest import CLASS, changed
from tuning_tables import read_book


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
