"""Units of FMI 2.0: in a loop they are the simulator, and their documents and functions are those of the standard."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from synth.retarder.fmi.controller_unit import controller_unit
from synth.retarder.fmi.interfaces import FMI_2
from synth.retarder.fmi.position_unit import position_unit
from tests.controller_code.conftest import Tool
from tests.controller_code.fmi.importer import RefusedCall
from tests.controller_code.fmi.importer_2 import Imported2
from tests.controller_code.fmi.test_position_unit import PASSES, SEED, Case, any_time, estimating
from tests.controller_code.fmi.unit_loop import loop_of_units, require_equal, units_of
from tests.controller_code.sample_book import sample_book
from tuning_tables.export_prefix import RETARDER


@pytest.mark.parametrize("case", [estimating, any_time])
def test_the_loop_of_both_units_is_the_simulator(case: Callable[[], Case], tmp_path: Path, tool: Tool) -> None:
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
def test_the_sources_compile_without_a_warning(switches: list[str], tmp_path: Path, tool: Tool) -> None:
    sources = position_unit([any_time()[0]], RETARDER).sources(FMI_2)
    for name, text in sources.items():
        (tmp_path / name).write_text(text)
    strict = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-Wno-unused-parameter", "-fsyntax-only"]
    files = [name for name in sources if name.endswith(".c")]
    subprocess.run([tool("gcc"), *strict, *switches, *files], cwd=tmp_path, check=True)
