"""How much the self-test of controller code asks: all that may show a fault, or what a small controller holds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from tuning_tables.aim.aim_tables import AimTable
from tuning_tables.aim.golden_aims import GoldenAims, few_golden_aims, golden_aims
from tuning_tables.golden_vectors import GoldenVectors, few_golden_vectors, golden_vectors
from tuning_tables.passages.golden_passages import GoldenPassages, few_golden_passages, golden_passages
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.table import ControllerTable


@dataclass(frozen=True)
class SelfTestSize:
    """`vectors`: the readings of a table that are decided, and their answers.

    `aims`: likewise the questions that an aim table is asked; `passages`: the rows of a table for point sensors.

    `line_checks`: of the choices between two tables, how many the Structured Text compares by every coefficient; it
    has no checksum that could do so. Choices and tracks of estimators are the same in every size.
    """

    vectors: Callable[[ControllerTable], GoldenVectors]
    line_checks: int
    aims: Callable[[AimTable], GoldenAims]
    passages: Callable[[PassageTable], GoldenPassages]


FULL: Final = SelfTestSize(golden_vectors, 16, golden_aims, golden_passages)
SMALL: Final = SelfTestSize(few_golden_vectors, 2, few_golden_aims, few_golden_passages)
