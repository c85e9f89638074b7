"""What crosses the cable, declared once: registers of Modbus, nodes of OPC UA, the table of the page, the C header."""

from __future__ import annotations

import struct
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import accumulate
from typing import Final

from synth.retarder.fmi.controller_unit import AXLES, CATEGORY, COMMANDED, INPUTS
from synth.retarder.fmi.variables import Causality, Kind, Variable

COMMANDS_AT: Final = 100
"""Register of the first command; what the position tells begins at 0."""

COUNTS: Final = 65_536
"""Counters go on with 0 after this many."""

OPC_UA_NAMESPACE: Final = "urn:retarder-synth:bench"
OPC_UA_FOLDER: Final = "Retarder"


def told(name: str, kind: Kind, meaning: str) -> Variable:
    """A number that the position tells, besides what a controller asks its table with."""
    return Variable(name, kind, Causality.OUTPUT, meaning)


TOLD: Final = (
    told("sample", Kind.INT32, "counts the samples; 0 follows 65535"),
    told("pass_number", Kind.INT32, "counts the cuts, from 1"),
    told("present", Kind.BOOLEAN, "whether a cut is there; between cuts the position goes to its initial stage itself"),
    CATEGORY,
    AXLES,
    told("stage_in_force", Kind.INT32, "stage commanded last"),
    COMMANDED,
    *INPUTS,
)
"""What the position tells at each sample."""

STAGE: Final = Variable("stage", Kind.INT32, Causality.INPUT, "stage to command")
ANSWERS: Final = Variable("answers", Kind.INT32, Causality.INPUT, "the `sample` that it answers; written last")
COMMANDS: Final = (STAGE, ANSWERS)
"""What the controller writes."""


@dataclass(frozen=True)
class Words:
    """How a kind of number crosses the cable: registers, `struct` format, type in OPC UA, C, Python, and in words."""

    registers: int
    form: str
    node_type: str
    c_type: str
    of: Callable[[float], float]
    shown: str


WORDS: Final[Mapping[Kind, Words]] = {
    Kind.FLOAT64: Words(2, ">f", "Float", "float", float, "float32"),
    Kind.INT32: Words(1, ">H", "UInt16", "uint16_t", int, "uint16"),
    Kind.BOOLEAN: Words(1, ">H", "Boolean", "uint16_t", bool, "0 or 1"),
}
"""Big-endian: the first register of a number has its higher half. Tables are asked in binary32, so nothing is lost."""


@dataclass(frozen=True)
class Wire:
    """A variable and its first register."""

    variable: Variable
    address: int

    @property
    def name(self) -> str:
        """Of the variable."""
        return self.variable.name

    @property
    def words(self) -> Words:
        """How it crosses."""
        return WORDS[self.variable.kind]

    def registers_of(self, value: float) -> list[int]:
        """The registers of `value`."""
        return list(struct.unpack(f">{self.words.registers}H", struct.pack(self.words.form, self.words.of(value))))


def wires_of(variables: Sequence[Variable], first: int) -> tuple[Wire, ...]:
    """The variables one after the other from register `first` on."""
    places = accumulate((WORDS[each.kind].registers for each in variables), initial=first)
    return tuple(Wire(each, place) for each, place in zip(variables, places, strict=False))


TOLD_WIRES: Final = wires_of(TOLD, 0)
COMMAND_WIRES: Final = wires_of(COMMANDS, COMMANDS_AT)


def registers_of(values: Mapping[str, float]) -> list[int]:
    """All registers of what the position tells, from 0 on."""
    return [word for wire in TOLD_WIRES for word in wire.registers_of(values[wire.name])]


def c_header() -> str:
    """The registers for a client in C."""
    rows = [
        f"#define BENCH_{wire.name.upper()} {wire.address} /* {wire.words.c_type}: {wire.variable.meaning} */"
        for wire in (*TOLD_WIRES, *COMMAND_WIRES)
    ]
    return "\n".join(
        [
            "/* Registers of retarder-synth bench; a float has two, the higher half first. Generated: do not edit. */",
            "#ifndef BENCH_WIRES_H",
            "#define BENCH_WIRES_H",
            "",
            *rows,
            f"#define BENCH_TOLD {sum(wire.words.registers for wire in TOLD_WIRES)} /* registers from 0 on */",
            "",
            "#endif",
            "",
        ]
    )
