"""What one call of our controller code costs, counted: the input from which loads and responses follow."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class CallCosts:
    """Counted operations of the dearest call of each function, and `source`: how they were counted.

    `observe`: a step of the estimator. `decide`: a decision at rest. `select`: the table of a cut. `aim`: the exit
    speed from an aim table, 0 where there are none. `intact`: the checksum of one table, None if there is none in that
    language; it is for the start only.
    """

    observe: int
    decide: int
    select: int
    aim: int
    intact: int | None
    source: str

    @property
    def sample(self) -> int:
        """Of one sample: an estimate and a decision."""
        return self.observe + self.decide

    @property
    def cut(self) -> int:
        """Of one cut besides: its exit speed, and its table."""
        return self.aim + self.select


def c_costs() -> CallCosts:
    """Instructions of the exported C on x86-64, gcc 12 -Os, by callgrind, tables with estimators.

    All but `aim` are kept findings of the study controller-cost (docs/studies/controller-cost.json). `aim` was counted
    the same way, gcc 12 -Os: the dearest of 3 000 hard questions to 19 tables with up to 7 × 7 × 8 nodes an axis.
    """
    return CallCosts(
        observe=791,
        decide=440,
        select=101_798,
        aim=451,
        intact=33_570,
        source="instructions on x86-64, gcc 12 -Os, callgrind: study controller-cost; aim counted apart",
    )


def st_costs() -> CallCosts:
    """Operations of the exported Structured Text, counted in its parse tree (docs/reference/structured-text.md).

    `select`: between two tables in a book of 6, then each of 9 tables more, and the copy of an estimator of 16 breaks,
    the difference of the two loads: put together, not counted in one. `aim`: the choice of the aim table, its load, and
    one question. There is no checksum.
    """
    return CallCosts(
        observe=550,
        decide=471,
        select=1604 + 9 * 9 + 524 - 338,
        aim=178 + 2178 + 399,
        intact=None,
        source="operations of Structured Text as executed: docs/reference/structured-text.md",
    )
