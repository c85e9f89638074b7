"""The importer for units of FMI 2.0: other names, one value a variable, and truth values as integers."""

from __future__ import annotations

import ctypes
from collections.abc import Iterable, Sequence
from typing import Any, Final
from xml.etree.ElementTree import Element

from tests.controller_code.fmi.importer import Imported, Listed, Value

TYPES: Final[dict[str, Any]] = {"Real": ctypes.c_double, "Integer": ctypes.c_int, "Boolean": ctypes.c_int}
LOG: Final = ctypes.CFUNCTYPE(
    None, ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int, ctypes.c_char_p, ctypes.c_char_p, ctypes.c_char_p
)
"""The sentence is the one argument that the format of the unit asks for."""
CO_SIMULATION: Final = 1


class Callbacks(ctypes.Structure):
    """What the unit may call."""

    _fields_ = (
        ("logger", LOG),
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
        log = LOG(lambda _env, _name, _status, _category, _format, message: self.faults.append(message.decode()))
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
            array = (TYPES[kind] * count)(*numbers)
            self.call(f"fmi2Set{kind}", references(first, count), ctypes.c_size_t(count), array)

    def get(self, name: str) -> Any:
        """The value of a variable, a list where it is an array."""
        kind, first, count = self.variables[name]
        array = (TYPES[kind] * count)()
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
