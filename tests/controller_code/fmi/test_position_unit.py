"""The position as a unit of FMI 3.0, and both units in FMI 2.0: in a loop they are the simulator, pass by pass."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from plant_models import Approach, Plant, PlantError, TrackProfile, WeightForce
from synth.retarder.estimation.estimator_design import estimator_of
from synth.retarder.fmi.controller_unit import controller_unit
from synth.retarder.fmi.description import FMI_2
from synth.retarder.fmi.position_unit import position_unit
from tests.controller_code.conftest import Tool
from tests.controller_code.fmi.importer import Imported, Imported2, RefusedCall
from tests.controller_code.fmi.unit_loop import loop_of_units, require_equal, units_of
from tests.controller_code.sample_book import sample_book, with_approach, with_slopes
from tests.effort import sized
from tests.synth.case_factory import make_plant, make_table
from tuning_tables import Decisions
from tuning_tables.export_names import RETARDER
from tuning_tables.table import ControllerTable

PASSES, SEED = sized(60, 1000), 3

Case = tuple[Plant, ControllerTable]


def at_rest() -> Case:
    """A radar's table, as the most are."""
    plant = make_plant(36.0, 4)
    return plant, make_table("rest", plant, 3.0)


def estimating() -> Case:
    """Estimator, readings that are lost in bursts, an approach on a grade of its own, a brake left at stage 1."""
    plant = make_plant(36.0, 4)
    plant = replace(
        plant,
        sensor=replace(plant.sensor, missed_share=0.2, missed_burst_s=0.6),
        profile=TrackProfile((-9.0, 7.0, 20.0), (12.0, 8.0, 5.0)),
        approach=Approach(6.0, 2, 1),
    )
    table = with_approach(make_table("estimating", plant, 3.0), 6.0, 2)
    return plant, replace(table, estimator=estimator_of(plant))


def any_time() -> Case:
    """Commands during transients, by lines that depend on the pressure."""
    plant = make_plant(60.0, 5)
    return plant, with_slopes(make_table("any", plant, 2.0), -0.003, -0.003)


def by_weight() -> Case:
    """A force in proportion to the axle load that depends on the number of braked axles; a slow clock."""
    plant = make_plant(80.0, 4)
    position = replace(plant.position, force=WeightForce(0.0019, 50.0, (1.2, 1.1, 1.0)))
    plant = replace(plant, position=position, sensor=replace(plant.sensor, sample_period_s=0.23))
    return plant, replace(make_table("weight", plant, 4.0), decisions=Decisions.AT_ANY_TIME)


def long_cut() -> Case:
    """So many axles that cells take the mean over breaks."""
    plant = make_plant(36.0, 4)
    offsets = tuple(float(x) for car in range(30) for x in (14.0 * car + np.array([0.0, 1.85, 8.65, 10.5])))
    plant = replace(plant, cut=replace(plant.cut, axle_offsets_m=offsets, mass_t=1200.0))
    return plant, make_table("long", plant, 4.0)


CASES: dict[str, Callable[[], Case]] = {
    "at-rest": at_rest, "estimating": estimating, "any-time": any_time, "by-weight": by_weight, "long-cut": long_cut
}  # fmt: skip


@pytest.mark.parametrize("case", CASES.values(), ids=list(CASES))
def test_the_loop_of_both_units_is_the_simulator(case: Callable[[], Case], tmp_path: Path, tool: Tool) -> None:
    tool("cc")
    plant, table = case()
    count = PASSES if case is not long_cut else PASSES // 10
    found = loop_of_units(units_of(plant, table), plant, table, SEED, count, tmp_path)
    assert found.simulated.switchings.sum() >= count  # it did decide something
    assert (found.lost > 0) == (plant.sensor.missed_share > 0.0)
    require_equal(found)


def test_the_cut_is_a_parameter(tmp_path: Path, tool: Tool) -> None:
    tool("cc")
    plant, table = at_rest()
    other = replace(plant, cut=replace(plant.cut, mass_t=90.0, axle_offsets_m=(0.0, 1.75, 3.5, 10.44, 12.19, 13.94)))
    require_equal(loop_of_units(units_of(other, table), plant, table, SEED, PASSES // 3, tmp_path))


def test_faults_are_told_in_one_sentence(tmp_path: Path, tool: Tool) -> None:
    tool("cc")
    with Imported(position_unit([at_rest()[0]], RETARDER).archive(), tmp_path) as unit:
        room = len(unit.get("axle_offsets_m"))
        for parameters, sentence in (
            ({"axles": 0}, f"axles is 0; give 1 to {room}"),
            (
                {"axle_offsets_m": [0.0, 3.0, 2.0, 4.0] + [0.0] * (room - 4)},
                r"axle_offsets_m\[2\] is 2; the first must be",
            ),
            (
                {"axle_offsets_m": [0.0, 3.0, 2000.1, 4.0] + [0.0] * (room - 4)},
                "axle_offsets_m is 2000.1; give 0 to 2000",
            ),
            ({"mass_t": float("nan")}, "mass_t is nan; give 1 to 20000"),
            ({"entry_speed_m_s": 9.0}, "entry_speed_m_s is 9; give 0.3 to 7"),
            ({"first_sample_s": 0.2}, "first_sample_s is 0.2; give 0 to 0.1"),
            ({"friction_factor": -1.0}, "friction_factor is -1; give 0 to 10"),
            ({"missed_share": 0.7}, "missed_share is 0.7; give 0 to 0.5"),
            ({"initial_stage": 5}, "initial_stage is 5; give 0 to 4"),
        ):
            with pytest.raises(RefusedCall, match=sentence):
                unit.begin(**parameters)
        unit.begin()
        with pytest.raises(RefusedCall, match=r"the step is 0.15 s; it must be a whole number of times 0.1 s"):
            unit.step(0.0, 0.15)
        unit.set(stage=7)
        with pytest.raises(RefusedCall, match="stage is 7; give 0 to 4"):
            unit.step(0.0, 0.1)


def test_a_long_step_is_some_short_ones(tmp_path: Path, tool: Tool) -> None:
    tool("cc")
    with Imported(position_unit([at_rest()[0]], RETARDER).archive(), tmp_path) as unit:
        found = []
        for steps in ((0.5,), (0.1,) * 5):
            unit.begin(stage=2)
            for each in steps:
                unit.step(0.0, each)
            found.append([unit.get(name) for name in ("path_m", "speed_m_s", "pressure_kpa", "measured_m_s")])
        assert found[0] == found[1]


def test_a_drive_that_cannot_be_commanded_at_any_moment_is_refused() -> None:
    plant = at_rest()[0]
    late = replace(plant.position.pneumatics, closing_delay_s=0.01)
    with pytest.raises(PlantError, match="closing_delay_s"):
        position_unit([replace(plant, position=replace(plant.position, pneumatics=late))], RETARDER)


def test_the_sources_compile_without_a_warning(tmp_path: Path, tool: Tool) -> None:
    sources = position_unit([by_weight()[0]], RETARDER).sources()
    for name, text in sources.items():
        (tmp_path / name).write_text(text)
    switches = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-Wno-unused-parameter", "-fsyntax-only"]
    files = [name for name in sources if name.endswith(".c")]
    subprocess.run([tool("gcc"), *switches, *files], cwd=tmp_path, check=True)


@pytest.mark.parametrize("case", [estimating, any_time])
def test_the_loop_of_both_units_of_version_2_is_the_simulator(
    case: Callable[[], Case], tmp_path: Path, tool: Tool
) -> None:
    tool("cc")
    plant, table = case()
    found = loop_of_units(units_of(plant, table, FMI_2), plant, table, SEED, PASSES, tmp_path, Imported2)
    assert found.simulated.switchings.sum() >= PASSES
    require_equal(found)


FUNCTIONS = """
GetTypesPlatform GetVersion SetDebugLogging Instantiate FreeInstance SetupExperiment EnterInitializationMode
ExitInitializationMode Terminate Reset GetReal GetInteger GetBoolean GetString SetReal SetInteger SetBoolean SetString
GetFMUstate SetFMUstate FreeFMUstate SerializedFMUstateSize SerializeFMUstate DeSerializeFMUstate
GetDirectionalDerivative SetRealInputDerivatives GetRealOutputDerivatives DoStep CancelStep GetStatus GetRealStatus
GetIntegerStatus GetBooleanStatus GetStringStatus
"""
"""Of FMI 2.0.4, for co-simulation."""


def test_functions_and_faults_are_those_of_the_standard(tmp_path: Path, tool: Tool) -> None:
    tool("cc")
    with Imported2(controller_unit(sample_book(), RETARDER).archive(FMI_2), tmp_path) as unit:
        assert [name for name in FUNCTIONS.split() if not hasattr(unit.library, f"fmi2{name}")] == []
        assert unit.library.fmi2GetVersion() == b"2.0"
        assert not unit.instantiate(b"{another}").value
        assert "token" in unit.faults[-1]
        with pytest.raises(RefusedCall, match="category is 0; give 1 to 255"):
            unit.begin(category=0)
        unit.begin()
        with pytest.raises(RefusedCall, match="cannot be set so, or not now"):
            unit.set(axles=6)
        with pytest.raises(RefusedCall, match="the step is -1 s"):
            unit.step(0.0, -1.0)


@pytest.mark.parametrize("switches", [[], ["-DFMI2_FUNCTION_PREFIX=park_"]], ids=["shared", "static"])
def test_the_sources_of_version_2_compile_without_a_warning(switches: list[str], tmp_path: Path, tool: Tool) -> None:
    sources = position_unit([any_time()[0]], RETARDER).sources(FMI_2)
    for name, text in sources.items():
        (tmp_path / name).write_text(text)
    strict = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-Wno-unused-parameter", "-fsyntax-only"]
    files = [name for name in sources if name.endswith(".c")]
    subprocess.run([tool("gcc"), *strict, *switches, *files], cwd=tmp_path, check=True)
