"""Records, constants and numbers as C99 writes them."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Iterator, Mapping
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from tuning_tables.language.records import Kind, SizedRecord

WIDTH = 116

Form: TypeAlias = Callable[[float], str]


def hex_float(value: float) -> str:
    """`value`, finite, as a C99 hexadecimal constant of type float: 2.5 is "0x1.4p+1f"."""
    mantissa, _, exponent = float(np.float32(value)).hex().partition("p")
    return f"{mantissa.rstrip('0').rstrip('.') if '.' in mantissa else mantissa}p{exponent}f"


def c_comment(text: str, depth: int = 0) -> list[str]:
    """The text as a comment."""
    pad = " " * 4 * depth
    lines = textwrap.wrap(text.replace("*/", "* /"), WIDTH - 3 - len(pad))
    rows = [f"{pad}/* {lines[0]}", *(f"{pad} * {line}" for line in lines[1:])]
    return [*rows[:-1], f"{rows[-1]} */"]


def c_type(record: SizedRecord, name: str) -> str:
    """The declaration of a record, every member 32 bits wide."""
    rows = []
    for member, declared in record.members.items():
        axes = "".join(f"[{length}]" for length in record.shape(member))
        rows += _with_note(f"    {_held(declared.kind)} {member}{axes};", declared.meaning)
    return "\n".join([f"typedef struct {name} {{", *rows, f"}} {name};", ""])


def _held(kind: Kind) -> str:
    return "int32_t" if kind is Kind.BOOL else kind.c


def _with_note(code: str, note: str) -> list[str]:
    """A line of code with what it means beside it, or above it where there is no room."""
    beside = f"{code} /* {note} */"
    return [beside] if len(beside) <= WIDTH else [*c_comment(note, 1), code]


def c_constants(constants: Mapping[str, float]) -> str:
    """Named constants, a negative one in parentheses."""
    return "\n".join(_c_constant(name, value) for name, value in constants.items())


def _c_constant(name: str, value: float) -> str:
    number = hex_float(value)
    return f"#define {name} {f'({number})' if value < 0.0 else number} /* {value:.9g} */"


def c_content(record: SizedRecord, values: Mapping[str, Any]) -> list[str]:
    """The initialiser of a record, a comma behind each member, with numbers in decimal for the eye."""
    rows = []
    for name, declared in record.members.items():
        array = np.asarray(values[name])
        form: Form = hex_float if declared.kind is Kind.REAL else whole_number
        if array.ndim == 0:
            shown = f": {float(array):.9g}" if declared.kind is Kind.REAL else ""
            rows.append(f"{form(array.item())}, /* {name}{shown} */")
        else:
            rows += [f"/* {name} */", *_braced(array, form)]
            rows[-1] += ","
    return rows


def whole_number(value: float) -> str:
    """A whole number."""
    return str(int(value))


def _braced(array: npt.NDArray[Any], form: Form) -> Iterator[str]:
    """An array in braces, the last axis in a line if it fits, with its numbers in decimal."""
    if array.ndim == 1:
        text = "{" + ", ".join(form(value) for value in array.tolist()) + "}"
        shown = " ".join(f"{value:.6g}" for value in array.tolist())
        noted = f"{text} /* {shown} */"
        if form is not whole_number and len(noted) <= WIDTH + 40 and len(array) <= 10:
            yield noted
        else:
            yield from textwrap.wrap(text, WIDTH - 12, subsequent_indent=" ")
        return
    yield "{"
    for place, each in enumerate(array):
        *lines, last = (f"    {line}" for line in _braced(each, form))
        yield from lines
        text, mark, note = last.partition(" /*")
        yield text + ("," if place < len(array) - 1 else "") + mark + note
    yield "}"
