"""Comments and numbers as Structured Text writes them."""

from __future__ import annotations

import textwrap

import numpy as np

from tuning_tables.language.records import st_name

WIDTH = 110


def real(value: float | np.floating) -> str:
    """`value`, finite, as a REAL literal of ten digits, from which every compiler gets the same float32 number.

    A float32 number is known from nine digits; ten leave no doubt also where the literal is read in double precision
    first. The sign of -0.0 is not written: no comparison and no sum of the rules can tell.
    """
    number = np.float32(value)
    return "0.0" if number == 0 else f"{float(number):.9E}"


def of_tables(member: str) -> str:
    """The constant array of a member by the number of the table."""
    return st_name(member).partition("_")[0] + "Of"


def st_comment(text: str, pad: str = "") -> list[str]:
    """The text as a comment."""
    lines = textwrap.wrap(text.replace("*)", "* )").replace("(*", "( *"), WIDTH - 6 - len(pad))
    rows = [f"{pad}{'  ' if place else '(*'} {line}" for place, line in enumerate(lines)]
    return [*rows[:-1], f"{rows[-1]} *)"]
