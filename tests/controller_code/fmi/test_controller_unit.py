"""The controller as a unit of FMI 3.0 against the rule in Python, sample by sample."""

from __future__ import annotations

import ctypes
import io
import shutil
import subprocess
import zipfile
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from synth.frame.faults import InputError
from synth.retarder.fmi.controller_unit import controller_unit
from synth.retarder.forms.code_options import PLAIN
from synth.retarder.forms.table_forms import FORMS
from tests.controller_code.conftest import Tool
from tests.controller_code.fmi.importer import Imported, RefusedCall
from tests.controller_code.passage_tables import passage_book
from tests.controller_code.sample_book import approaching_book, estimating_book, sample_book, surface_book
from tuning_tables.estimator import begin, unseen_samples
from tuning_tables.export_names import RETARDER, ExportPrefix
from tuning_tables.rule import alarms_for, decide_for, speed_for
from tuning_tables.table_book import TableBook

BOOKS: dict[str, Callable[[], TableBook]] = {
    "plain": sample_book,
    "estimated": estimating_book,
    "approached": approaching_book,
    "gauged": surface_book,
}
SAMPLES = 60


@pytest.fixture
def imported(tmp_path: Path, tool: Tool) -> Callable[[TableBook], Imported]:
    """Loads the unit of a book."""
    tool("cc")
    return lambda book: Imported(controller_unit(book, RETARDER).archive(), tmp_path)


@pytest.mark.parametrize("book", BOOKS.values(), ids=list(BOOKS))
def test_the_unit_decides_as_the_rule(book: Callable[[], TableBook], imported: Callable[[TableBook], Imported]) -> None:
    tables, rng, changes = book(), np.random.default_rng(1), 0
    with imported(tables) as unit:
        assert unit.library.fmi3GetVersion() == b"3.0"
        for each in tables.tables:
            # Which table of a class answers is the book's to say: a lighter mass stands in the shadow.
            category, axles = each.cut.category, len(each.cut.axle_offsets_m)
            number, wanted = tables.number_of(category), float(np.float32(each.target_speed_m_s + 0.2))
            choice = tables.choose(category, axles, wanted)
            if choice.table is None:
                with pytest.raises(RefusedCall, match="there is no table"):
                    unit.begin(category=number, axles=axles, commanded_m_s=wanted)
                continue
            unit.begin(category=number, axles=axles, commanded_m_s=wanted)
            assert unit.get("choice") == int(choice.status)
            stage, state, s_m = 0, begin(), float(rng.uniform(-4.0, 0.0))
            for sample in range(SAMPLES):
                s_m += float(rng.uniform(0.1, 0.9))
                v_m_s = float(rng.choice([rng.uniform(0.5, 7.0), -1.0], p=[0.9, 0.1]))
                over_kpa, kpa = (float(x) for x in rng.uniform(0.0, 600.0, 2))
                at_rest = bool(rng.random() < 0.7)
                speed = speed_for(choice.table, state, s_m, v_m_s, over_kpa)
                before = stage
                if at_rest or choice.table.held.at_any_time:
                    stage = decide_for(choice.table, stage, s_m, speed, kpa)
                changes += stage != before
                unit.set(path_m=s_m, measured_m_s=v_m_s, mean_overpressure_kpa=over_kpa, pressure_kpa=kpa,
                         at_rest=at_rest)  # fmt: skip
                assert unit.step(0.1 * sample, 0.1) == pytest.approx(0.1 * (sample + 1))
                found = [unit.get(name) for name in ("stage", "speed_m_s", "alarms", "unseen")]
                assert found == [stage, speed, alarms_for(choice.table, state), unseen_samples(state)]
    assert changes > 50


def test_a_state_that_was_saved_goes_on_as_before(imported: Callable[[TableBook], Imported]) -> None:
    with imported(estimating_book()) as unit:
        unit.begin()
        readings = [(0.5 * k, 6.0 - 0.1 * k) for k in range(12)]

        def follow(first: int) -> list[float]:
            found = []
            for k, (s_m, v_m_s) in enumerate(readings[first:]):
                unit.set(path_m=s_m, measured_m_s=v_m_s, at_rest=True)
                unit.step(0.1 * (first + k), 0.1)
                found += [unit.get("speed_m_s"), unit.get("stage")]
            return found

        follow(6)
        state = ctypes.c_void_p()
        unit.call("fmi3GetFMUState", ctypes.byref(state))
        once = follow(2)
        assert follow(2) != once
        unit.call("fmi3SetFMUState", state)
        assert follow(2) == once
        unit.call("fmi3FreeFMUState", ctypes.byref(state))


def test_faults_are_told_in_one_sentence(imported: Callable[[TableBook], Imported]) -> None:
    with imported(sample_book()) as unit:
        assert not unit.instantiate(b"{another}").value
        assert "token" in unit.faults[-1]
        with pytest.raises(RefusedCall, match=r"no table for category 9, 4 axles and 2 m/s \(choice -1\)"):
            unit.begin(category=9, commanded_m_s=2.0)
        with pytest.raises(RefusedCall, match="initial_stage is 20; the table has the stages 0 to"):
            unit.begin(initial_stage=20)
        with pytest.raises(RefusedCall, match="category is 0; give 1 to 255"):
            unit.begin(category=0)
        with pytest.raises(RefusedCall, match="not initialised"):
            unit.step(0.0, 0.1)
        unit.begin()
        with pytest.raises(RefusedCall, match="cannot be set so, or not now"):
            unit.set(axles=6)
        with pytest.raises(RefusedCall, match="the step is -1 s"):
            unit.step(0.0, -1.0)


FUNCTIONS = [
    "GetVersion",
    "SetDebugLogging",
    "InstantiateModelExchange",
    "InstantiateCoSimulation",
    "InstantiateScheduledExecution",
    "FreeInstance",
    "EnterInitializationMode",
    "ExitInitializationMode",
    "EnterEventMode",
    "Terminate",
    "Reset",
    "GetBinary",
    "SetBinary",
    "GetClock",
    "SetClock",
    "GetNumberOfVariableDependencies",
    "GetVariableDependencies",
    "GetFMUState",
    "SetFMUState",
    "FreeFMUState",
    "SerializedFMUStateSize",
    "SerializeFMUState",
    "DeserializeFMUState",
    "GetDirectionalDerivative",
    "GetAdjointDerivative",
    "EnterConfigurationMode",
    "ExitConfigurationMode",
    "GetIntervalDecimal",
    "GetIntervalFraction",
    "GetShiftDecimal",
    "GetShiftFraction",
    "SetIntervalDecimal",
    "SetIntervalFraction",
    "SetShiftDecimal",
    "SetShiftFraction",
    "EvaluateDiscreteStates",
    "UpdateDiscreteStates",
    "EnterContinuousTimeMode",
    "CompletedIntegratorStep",
    "SetTime",
    "SetContinuousStates",
    "GetContinuousStateDerivatives",
    "GetEventIndicators",
    "GetContinuousStates",
    "GetNominalsOfContinuousStates",
    "GetNumberOfEventIndicators",
    "GetNumberOfContinuousStates",
    "EnterStepMode",
    "GetOutputDerivatives",
    "DoStep",
    "ActivateModelPartition",
]
"""Of FMI 3.0.1 without those of a type."""
TYPED = (
    "Float32",
    "Float64",
    "Int8",
    "UInt8",
    "Int16",
    "UInt16",
    "Int32",
    "UInt32",
    "Int64",
    "UInt64",
    "Boolean",
    "String",
)


def test_the_library_has_every_function_of_the_standard(imported: Callable[[TableBook], Imported]) -> None:
    typed = [f"{what}{name}" for what in ("Get", "Set") for name in TYPED]
    with imported(sample_book()) as unit:
        assert [name for name in (*FUNCTIONS, *typed) if not hasattr(unit.library, f"fmi3{name}")] == []
        assert not hasattr(unit.library, "unit_begin")  # two units in one process must not meet


def test_other_kinds_of_tables_are_refused() -> None:
    with pytest.raises(InputError, match="--format fmu is for tables with lines"):
        FORMS["fmu"](passage_book().tables, PLAIN)


def test_the_archive_holds_what_it_says_and_the_same_bytes(tool: Tool) -> None:
    tool("cc")
    one, other = (controller_unit(sample_book(), ExportPrefix("BUNCH")).archive() for _ in range(2))
    assert one == other
    with zipfile.ZipFile(io.BytesIO(one)) as archive:
        names = archive.namelist()
        build = ElementTree.fromstring(archive.read("sources/buildDescription.xml"))
    assert "binaries/x86_64-linux/bunch_controller.so" in names
    listed = {f"sources/{each.attrib['name']}" for each in build.iter("SourceFile")}
    assert listed == {name for name in names if name.endswith(".c")}


def test_the_sources_compile_without_a_warning(tmp_path: Path, tool: Tool) -> None:
    sources = controller_unit(estimating_book(), RETARDER).sources()
    for name, text in sources.items():
        (tmp_path / name).write_text(text)
    switches = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-Wno-unused-parameter", "-fsyntax-only"]
    files = [name for name in sources if name.endswith(".c")]
    subprocess.run([tool("gcc"), *switches, *files], cwd=tmp_path, check=True)


def test_without_a_compiler_there_are_sources_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "which", lambda _name: None)
    with zipfile.ZipFile(io.BytesIO(controller_unit(sample_book(), RETARDER).archive())) as archive:
        names = archive.namelist()
    assert "sources/controller.c" in names
    assert not [name for name in names if name.startswith("binaries")]
