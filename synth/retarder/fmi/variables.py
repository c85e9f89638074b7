"""The variables of a unit: declared once, for modelDescription.xml and for the C that holds their values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum
from typing import Final

from tuning_tables.export_names import generated

Value = float | int | bool


class Kind(Enum):
    """Type of a variable: element of modelDescription.xml, type in C, name in unit.h."""

    FLOAT64 = ("Float64", "fmi3Float64", "UNIT_FLOAT64")
    INT32 = ("Int32", "fmi3Int32", "UNIT_INT32")
    BOOLEAN = ("Boolean", "fmi3Boolean", "UNIT_BOOLEAN")

    @property
    def element(self) -> str:
        """Name in modelDescription.xml."""
        return self.value[0]

    @property
    def c_type(self) -> str:
        """Type in C."""
        return self.value[1]

    @property
    def c_name(self) -> str:
        """The kind in C."""
        return self.value[2]

    @property
    def variability(self) -> str:
        """How an input or output of this type may change; where the standard says nothing else."""
        return "continuous" if self is Kind.FLOAT64 else "discrete"


class Causality(Enum):
    """What a variable is for; value: name in modelDescription.xml."""

    INDEPENDENT = "independent"
    PARAMETER = "parameter"
    INPUT = "input"
    OUTPUT = "output"


@dataclass(frozen=True)
class Variable:
    """A variable of a unit. `start`: its values, one unless it is an array; `unit`: a key of `UNITS`, or None.

    Of a number that is given, `low` and `high` are the limits, of each value of an array too; None where there is none.
    """

    name: str
    kind: Kind
    causality: Causality
    meaning: str
    start: tuple[Value, ...] = (0,)
    unit: str | None = None
    low: float | None = None
    high: float | None = None

    @property
    def is_array(self) -> bool:
        """Whether it has a dimension."""
        return len(self.start) > 1


TIME: Final = Variable("time_s", Kind.FLOAT64, Causality.INDEPENDENT, "time of the simulation", unit="s")

UNITS: Final = {
    "s": {"s": "1"},
    "m": {"m": "1"},
    "m/s": {"m": "1", "s": "-1"},
    "kPa": {"kg": "1", "m": "-1", "s": "-2", "factor": "1000"},
    "t": {"kg": "1", "factor": "1000"},
    "N/kN": {"factor": "0.001"},
}
"""Units by name, as exponents of the base units and a factor."""


def shown(value: Value) -> str:
    """A value as modelDescription.xml and C both read it."""
    return str(value).lower() if isinstance(value, bool) else repr(value)


def scalars(variables: Sequence[Variable]) -> tuple[Variable, ...]:
    """The variables, but for each array its elements, called as C calls them."""
    return tuple(
        replace(each, name=f"{each.name}[{place}]", start=(start,)) if each.is_array else each
        for each in variables
        for place, start in enumerate(each.start)
    )


def variables_h(variables: Sequence[Variable], listed: int, period_s: float, token: str) -> str:
    """The text of variables.h: the values of a unit by name, how many are listed, its step and its token."""
    rows = []
    for each in variables:
        length = f"[{len(each.start)}]" if each.is_array else ""
        unit = f", {each.unit}" if each.unit else ""
        rows.append(f"    {each.kind.c_type} {each.name}{length}; /* {each.causality.value}: {each.meaning}{unit} */")
    return "\n".join(
        [
            f"/* The variables of the unit. {generated()} */",
            "#ifndef UNIT_VARIABLES_H",
            "#define UNIT_VARIABLES_H",
            "",
            '#include "fmi3.h"',
            "",
            f"#define UNIT_VARIABLES {listed}",
            f"#define UNIT_PERIOD_S {shown(float(period_s))} /* length of a step; 0: a step may have any */",
            f'#define UNIT_TOKEN "{token}"',
            "",
            "typedef struct {",
            *rows,
            "} unit_values;",
            "",
            "#endif",
            "",
        ]
    )


def variables_c(variables: Sequence[Variable], listed: Sequence[Variable]) -> str:
    """The text of variables.c: where each of those that are listed stands, and the values to begin with."""
    places, starts = [], []
    for each in listed:
        causality = f"UNIT_{each.causality.value.upper()}"
        place = f"offsetof(unit_values, {each.name})"
        low = "-HUGE_VAL" if each.low is None else shown(float(each.low))
        high = "HUGE_VAL" if each.high is None else shown(float(each.high))
        fields = (f'"{each.name}"', each.kind.c_name, causality, place, str(len(each.start)), low, high)
        places.append(f"    {{{', '.join(fields)}}},")
    for each in variables:
        values = ", ".join(map(shown, each.start))
        starts.append(f"    .{each.name} = {f'{{{values}}}' if each.is_array else values},")
    return "\n".join(
        [
            f"/* The variables of the unit. {generated()} */",
            '#include "unit.h"',
            "",
            "#include <math.h>",
            "",
            "const unit_variable unit_variables[UNIT_VARIABLES] = {",
            *places,
            "};",
            "",
            "const unit_values unit_start = {",
            *starts,
            "};",
            "",
        ]
    )
