"""How much the tests do: what finds a fault in minutes, or all of it (`scripts/test --long`)."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import Any, Final, TypeVar

import pytest

_T = TypeVar("_T")

IS_LONG: Final = os.environ.get("RETARDER_SYNTH_TESTS") == "long"
"""Whether the long tests run, and the others at their full size."""


def sized(short: _T, long: _T) -> _T:
    """How many questions, passes or trains a test takes: `short`, or `long` where there is time."""
    return long if IS_LONG else short


def every(step: int, cases: Iterable[Any]) -> list[Any]:
    """For `parametrize`: the first of each `step` cases; the others are long tests."""
    return [
        pytest.param(*(case if isinstance(case, tuple) else (case,)), marks=pytest.mark.long if number % step else ())
        for number, case in enumerate(cases)
    ]


FEW, MANY = 40_000, 1_000_000
QUESTIONS: Final = sized(FEW, MANY)
"""Put to the rules of each kind of tables, in C as every compiler makes it, in Structured Text as every one runs it."""
