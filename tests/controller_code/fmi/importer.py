"""Importers of units of FMI 3.0 and 2.0 as small as can be: they read modelDescription.xml and call the library."""

from __future__ import annotations

import ctypes
import io
import zipfile
from collections.abc import Iterable, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, Final
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

OK: Final = 0
TYPES: Final[dict[str, Any]] = {"Float64": ctypes.c_double, "Int32": ctypes.c_int32, "Boolean": ctypes.c_bool}
LOG: Final = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_int, ctypes.c_char_p, ctypes.c_char_p)
Value = float | int | bool
Listed = tuple[str, int, int]
"""Type, value reference and number of values of a variable."""


class RefusedCall(Exception):
    """A call did not answer fmi3OK; the message is what the unit logged last."""


class Imported:
    """A unit that is loaded from an archive; `faults` are the sentences that it has logged."""

    PREFIX, FOLDER, TOKEN = "fmi3", "x86_64-linux", "instantiationToken"

    def __init__(self, archive: bytes, folder: Path) -> None:
        with zipfile.ZipFile(io.BytesIO(archive)) as packed:
            packed.extractall(folder)
        root = ElementTree.parse(folder / "modelDescription.xml").getroot()
        self.variables = self.variables_of(root.find("ModelVariables") or ())
        simulation = root.find("CoSimulation")
        assert simulation is not None
        experiment = root.find("DefaultExperiment")
        self.step_s = float("nan" if experiment is None else experiment.attrib["stepSize"])
        library = folder / "binaries" / self.FOLDER / f"{simulation.attrib['modelIdentifier']}.so"
        self.library = ctypes.CDLL(str(library))
        getattr(self.library, f"{self.PREFIX}GetVersion").restype = ctypes.c_char_p
        self.faults: list[str] = []
        self.kept: list[Any] = []  # what instances may still call
        self._token = root.attrib[self.TOKEN].encode()
        self.instance = self.instantiate(self._token)

    def variables_of(self, listed: Iterable[ElementTree.Element]) -> dict[str, Listed]:
        """The variables by name."""
        return {each.attrib["name"]: (each.tag, int(each.attrib["valueReference"]), sizes(each)) for each in listed}

    def instantiate(self, token: bytes) -> ctypes.c_void_p:
        """An instance for `token`; a null pointer where the unit refuses."""
        log = LOG(lambda _env, _status, _category, message: self.faults.append(message.decode()))
        self.kept.append(log)
        self.library.fmi3InstantiateCoSimulation.restype = ctypes.c_void_p
        none, no = ctypes.c_void_p(None), ctypes.c_bool(False)
        found = self.library.fmi3InstantiateCoSimulation(
            b"one", token, b"", no, no, no, no, none, ctypes.c_size_t(0), none, log, none
        )
        return ctypes.c_void_p(found)

    def __enter__(self) -> Imported:
        return self

    def __exit__(self, kind: type[BaseException] | None, fault: BaseException | None, at: TracebackType | None) -> None:
        getattr(self.library, f"{self.PREFIX}FreeInstance")(self.instance)

    def call(self, name: str, *given: Any) -> None:
        """Call a function of the instance; `RefusedCall` unless it answers fmi3OK."""
        if getattr(self.library, name)(self.instance, *given) != OK:
            raise RefusedCall(self.faults[-1] if self.faults else name)

    def set(self, **values: Value | Sequence[Value]) -> None:
        """Set variables by name."""
        for name, value in values.items():
            kind, reference, count = self.variables[name]
            numbers = list(value) if isinstance(value, Sequence) else [value]
            array = (TYPES[kind] * count)(*numbers)
            one = (ctypes.c_uint32 * 1)(reference)
            self.call(f"fmi3Set{kind}", one, ctypes.c_size_t(1), array, ctypes.c_size_t(count))

    def get(self, name: str) -> Any:
        """The value of a variable, a list where it is an array."""
        kind, reference, count = self.variables[name]
        array = (TYPES[kind] * count)()
        one = (ctypes.c_uint32 * 1)(reference)
        self.call(f"fmi3Get{kind}", one, ctypes.c_size_t(1), array, ctypes.c_size_t(count))
        return array[0] if count == 1 else list(array)

    def begin(self, **parameters: Value | Sequence[Value]) -> None:
        """Reset, set parameters, and initialise."""
        self.call("fmi3Reset")
        self.set(**parameters)
        no, zero = ctypes.c_bool(False), ctypes.c_double(0.0)
        self.call("fmi3EnterInitializationMode", no, zero, zero, no, zero)
        self.call("fmi3ExitInitializationMode")

    def step(self, from_s: float, step_s: float) -> float:
        """One step of co-simulation; the time reached."""
        flags, reached = [ctypes.c_bool() for _ in range(3)], ctypes.c_double()
        self.call(
            "fmi3DoStep", ctypes.c_double(from_s), ctypes.c_double(step_s), ctypes.c_bool(True),
            *map(ctypes.byref, flags), ctypes.byref(reached),
        )  # fmt: skip
        assert not any(flag.value for flag in flags)
        return reached.value


def sizes(variable: ElementTree.Element) -> int:
    """How many values a variable has."""
    dimension = variable.find("Dimension")
    return 1 if dimension is None else int(dimension.attrib["start"])


TYPES_2: Final[dict[str, Any]] = {"Real": ctypes.c_double, "Integer": ctypes.c_int, "Boolean": ctypes.c_int}
LOG_2: Final = ctypes.CFUNCTYPE(
    None, ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int, ctypes.c_char_p, ctypes.c_char_p, ctypes.c_char_p
)
"""The sentence is the one argument that the format of the unit asks for."""
CO_SIMULATION: Final = 1


class Callbacks(ctypes.Structure):
    """What the unit may call."""

    _fields_ = (
        ("logger", LOG_2),
        *((name, ctypes.c_void_p) for name in ("allocate", "free", "finished", "environment")),
    )


class Imported2(Imported):
    """A unit of FMI 2.0. An array goes by the name that its elements have in front of their brackets."""

    PREFIX, FOLDER, TOKEN = "fmi2", "linux64", "guid"

    def variables_of(self, listed: Iterable[Element]) -> dict[str, Listed]:
        """Elements and arrays by name; elements of an array have references on end."""
        found: dict[str, Listed] = {}
        for each in listed:
            reference = int(each.attrib["valueReference"])
            name = each.attrib["name"].partition("[")[0]
            kind, first, count = found.get(name, (each[0].tag, reference, 0))
            assert (kind, first + count) == (each[0].tag, reference)
            found[name] = (kind, first, count + 1)
        return found

    def instantiate(self, token: bytes) -> ctypes.c_void_p:
        """An instance for `token`; a null pointer where the unit refuses."""
        log = LOG_2(lambda _env, _name, _status, _category, _format, message: self.faults.append(message.decode()))
        callbacks = Callbacks(logger=log)
        self.kept.append(callbacks)
        self.library.fmi2Instantiate.restype = ctypes.c_void_p
        found = self.library.fmi2Instantiate(b"one", CO_SIMULATION, token, b"", ctypes.byref(callbacks), 0, 0)
        return ctypes.c_void_p(found)

    def set(self, **values: Value | Sequence[Value]) -> None:
        """Set variables by name."""
        for name, value in values.items():
            kind, first, count = self.variables[name]
            numbers = list(value) if isinstance(value, Sequence) else [value]
            array = (TYPES_2[kind] * count)(*numbers)
            self.call(f"fmi2Set{kind}", references(first, count), ctypes.c_size_t(count), array)

    def get(self, name: str) -> Any:
        """The value of a variable, a list where it is an array."""
        kind, first, count = self.variables[name]
        array = (TYPES_2[kind] * count)()
        self.call(f"fmi2Get{kind}", references(first, count), ctypes.c_size_t(count), array)
        return array[0] if count == 1 else list(array)

    def begin(self, **parameters: Value | Sequence[Value]) -> None:
        """Reset, set parameters, and initialise."""
        self.call("fmi2Reset")
        self.set(**parameters)
        zero = ctypes.c_double(0.0)
        self.call("fmi2SetupExperiment", 0, zero, zero, 0, zero)
        self.call("fmi2EnterInitializationMode")
        self.call("fmi2ExitInitializationMode")

    def step(self, from_s: float, step_s: float) -> float:
        """One step of co-simulation; the time reached."""
        self.call("fmi2DoStep", ctypes.c_double(from_s), ctypes.c_double(step_s), 1)
        return float(self.get("time_s"))


def references(first: int, count: int) -> Any:
    """Value references on end."""
    return (ctypes.c_uint * count)(*range(first, first + count))
