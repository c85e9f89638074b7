"""What compilers make of one and the same text where they differ, as values that the evaluator is told."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Final, TypeAlias

import numpy as np

from tests.effort import sized

Real: TypeAlias = type[np.float32] | type[np.float64]


class Loops(Enum):
    """How often a FOR turns whose ends leave it one turn or none."""

    AS_IN_THE_STANDARD = "one turn where start and end are equal, none where the start is beyond the end"
    NONE_AT_EQUAL_ENDS = "no turn where start and end are equal"
    ONE_BEYOND_THE_END = "one turn where the start is beyond the end"


@dataclass(frozen=True)
class Compiler:
    """How a compiler runs a text. REAL variables and constants are float32 under each.

    `between`: what an operation on two REALs gives, until it is assigned. `literals`: what a real literal is inside an
    expression; an operation or comparison of a float64 and a float32 happens in float64. `fuses`: a product of REALs
    that is added or subtracted within the same expression is not rounded before. Product and sum are computed in
    float64 and rounded to float32 once: the product is exact then, the sum is not always, so a tie of the sum may
    fall otherwise than in a processor. That is good enough to find a text that lets a compiler fuse.
    """

    name: str
    between: Real = np.float32
    literals: Real = np.float32
    loops: Loops = Loops.AS_IN_THE_STANDARD
    fuses: bool = False


BINARY32: Final = Compiler("binary32")
DOUBLE: Final = Compiler("double rounded when assigned", between=np.float64, literals=np.float64)
LONG_LITERALS: Final = Compiler("literals are LREAL", literals=np.float64)
FUSING: Final = Compiler("fused multiplication and addition", fuses=True)
NO_TURN: Final = Compiler("no turn at equal ends", loops=Loops.NONE_AT_EQUAL_ENDS)
ONE_TURN_TOO_MANY: Final = Compiler("one turn beyond the end", loops=Loops.ONE_BEYOND_THE_END)
MATIEC: Final = Compiler("MATIEC of 2024", literals=np.float64, loops=Loops.NONE_AT_EQUAL_ENDS)
WORST: Final = Compiler(
    "LREAL literals, fused, one turn beyond the end",
    literals=np.float64,
    loops=Loops.ONE_BEYOND_THE_END,
    fuses=True,
)

ROUNDINGS: Final = (BINARY32, DOUBLE)
"""Those that differ in how operations among REALs are rounded, without a fault."""

COMPILERS: Final = (BINARY32, DOUBLE, LONG_LITERALS, FUSING, NO_TURN, ONE_TURN_TOO_MANY, MATIEC, WORST)
"""All under which every exported text must answer alike. CODESYS and STruC++ take literals as `LONG_LITERALS` does."""


ASKED_UNDER: Final = sized((BINARY32, WORST), COMPILERS)
"""Those under which hard questions are asked."""


def name_of(compiler: Compiler) -> str:
    """The name of a parametrised test."""
    return compiler.name
