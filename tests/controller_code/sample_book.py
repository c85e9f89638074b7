"""A book with tables of many shapes, whose numbers are as hard as numbers can be. Nothing in a book can be changed."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from tuning_tables import (
    Approach,
    ControllerTable,
    CutId,
    Decisions,
    Estimator,
    Generator,
    Predicted,
    RegulatorClock,
    RetarderId,
    Stage,
    ValidRange,
)
from tuning_tables.stage import round_coefficients
from tuning_tables.table_book import TableBook

FOUR_AXLES, SIX_AXLES = (0.0, 1.85, 8.65, 10.5), (0.0, 1.75, 3.5, 10.44, 12.19, 13.94)


@cache
def sample_book() -> TableBook:
    """Three targets of two classes; a lighter class in their shadow; other stages, degrees, ranges; odd numbers."""
    odd = table_of("odd", "Т", 85.0, FOUR_AXLES, 3.0)
    minute, zero = round_coefficients([1e-42, 2e-44, 0.0, 0.0]), round_coefficients([0.0, 0.0, 0.0, 0.0])
    huge = round_coefficients([1e30, 1e27, -1e24, 1e21])
    return TableBook(
        (
            *(table_of(f"light-{v}", "Л", 23.0, FOUR_AXLES, v) for v in (2.0, 3.3, 4.0)),
            *(table_of(f"shadow-{v}", "Л", 22.0, FOUR_AXLES, v) for v in (1.5, 3.0)),
            table_of("same-target", "Л", 23.0, FOUR_AXLES, 3.3),
            *(table_of(f"medium-{v}", "С", 52.0, SIX_AXLES, v) for v in (4.0, 2.0)),
            table_of("other-degree", "С", 52.0, SIX_AXLES, 3.0, degree=2),
            table_of("many-stages", "СТ", 66.0, FOUR_AXLES, 2.0, stages=9, degree=9),
            table_of("constant", "СТ", 66.0, FOUR_AXLES, 3.0, stages=2, degree=0),
            replace(table_of("turning", "СТ", 66.0, FOUR_AXLES, 3.5, degree=1), stages=turning_lines()),
            replace(
                odd,
                stages=(
                    Stage(0, 0.0, None, minute),
                    Stage(1, 10.0, zero, huge),
                    Stage(2, 20.0, minute, round_coefficients([0.5, -1e-41, 1e-3, 0.0])),
                    Stage(3, 30.0, None, None),
                ),
                valid=ValidRange((-3.0, 1.0e-3), (0.0, 9.0)),
            ),
        )
    )


@cache
def estimating_book() -> TableBook:
    """The sample book with estimators: few and many breaks, one from before the path on, one with next to no noise.

    Of the class with three targets the first two share an estimator, and the third has another, so that lines between
    them have a meaning only below the second; one differs from theirs in the touch pressure; two tables have none.
    """
    usual, odd = estimator_of(16, 37.45), estimator_of(40, 120.0)
    given = {
        "light-2.0": usual, "light-3.3": usual, "shadow-1.5": replace(usual, touch_pressure_kpa=75.0),
        "light-4.0": replace(usual, friction_cv=0.1500001), "medium-4.0": odd, "medium-2.0": odd,
        "other-degree": odd, "many-stages": estimator_of(2, 3.0, -4.0, 1.0), "constant": replace(odd, path_std=0.0),
        "odd": Estimator(
            1e-4, 0.0, 1.0, 1.0, 1e3, 1, 1, 1e-3, 0.0, 0.0, (0.0, 1e-3, 2.5), (0.0, -1.0, 5.0), (0.0, 0.02, 0.02)
        ),
    }  # fmt: skip
    return TableBook(tuple(replace(table, estimator=given.get(table.id)) for table in sample_book().tables))


@cache
def approaching_book(estimators: bool = True) -> TableBook:
    """The estimating book, or the sample book, with approaches: every entrance stage, 0 and the highest among them.

    Of the class with three targets the first two have equal approaches, the third has another entrance stage, so that
    lines between them have a meaning only below the second. Four tables have none; the path of one of these, too,
    begins before the entrance.
    """
    given = {
        "light-2.0": (4.0, 1), "light-3.3": (4.0, 1), "light-4.0": (4.0, 2), "shadow-1.5": (0.3, 0),
        "shadow-3.0": (4.0, 4), "medium-4.0": (8.0, 3), "medium-2.0": (8.0, 3), "many-stages": (9.0, 6),
        "constant": (1e-3, 0), "turning": (4.0, 2),
    }  # fmt: skip
    book = estimating_book() if estimators else sample_book()
    return TableBook(tuple(with_approach(table, *given.get(table.id, (0.0, 0))) for table in book.tables))


@cache
def surface_book(of: TableBook | None = None) -> TableBook:
    """The approaching book, or another of the same shapes, with tables that decide at any time, with gauge and without.

    Of the class with three targets the first two have slopes of their own over equal pressures, the third has other
    pressures, so that lines between them have a meaning only below the second. One table decides at any time without a
    gauge, two decide at rest; one has slopes as small as numbers can be, beside large ones.
    """
    given: dict[str, tuple[float, float]] = {
        "light-2.0": (-0.001, -0.0012), "light-3.3": (-0.0015, -0.001), "light-4.0": (-0.001, -0.0012),
        "same-target": (-0.0007, -0.0007), "medium-4.0": (-0.0011, -0.0009), "medium-2.0": (0.0, -0.0003),
        "many-stages": (0.0001, 0.00013), "constant": (0.0031, -0.0017), "odd": (-0.003, 1e-44),
    }  # fmt: skip
    tables = []
    for table in (of or approaching_book()).tables:
        if table.id == "light-4.0":
            stages = (replace(each, pressure_kpa=15.0 + 140.0 * each.k) for each in table.stages)
            table = replace(table, stages=tuple(stages))
        if table.id in given:
            table = with_slopes(table, *given[table.id])
        elif table.id == "shadow-1.5":
            table = replace(table, decisions=Decisions.AT_ANY_TIME)
        tables.append(table)
    return TableBook(tuple(tables))


def with_slopes(table: ControllerTable, lower: float, upper: float) -> ControllerTable:
    """The table that decides at any time, with these slopes wherever it has a line."""
    low, high = round_coefficients([lower, upper])
    stages = (
        replace(
            each,
            lower_slope_m_s_per_kpa=None if each.lower is None else low,
            upper_slope_m_s_per_kpa=None if each.upper is None else high,
        )
        for each in table.stages
    )
    return replace(table, stages=tuple(stages), decisions=Decisions.AT_ANY_TIME)


def with_approach(table: ControllerTable, length_m: float, entrance_stage: int) -> ControllerTable:
    """The table with an approach of `length_m`, its path and the breaks of its estimator moved there; 0 m: none."""
    if length_m == 0.0:
        return table
    estimator = table.estimator
    if estimator is not None:
        estimator = replace(estimator, s_m=tuple(s - length_m for s in estimator.s_m))
    valid = replace(table.valid, s_m=(-length_m, table.valid.s_m[1]))
    return replace(table, valid=valid, estimator=estimator, approach=Approach(length_m, entrance_stage))


def park_book() -> TableBook:
    """Another position: three stages, straight lines, other classes; one class has an estimator."""
    made = []
    for category, mass_t, targets in (("СТ", 66.0, (1.5, 2.5)), ("Л", 22.0, (1.2, 2.0, 2.8))):
        for target in targets:
            table = table_of(f"park {category} to {target}", category, mass_t, FOUR_AXLES, target, 3, 1)
            estimator = estimator_of(7, 30.0) if category == "Л" else None
            retarder = RetarderId("РНЗ-2М", ((0.0, 6.0), (8.0, 14.0)), 25.0, 10.0)
            made.append(replace(table, retarder=retarder, estimator=estimator))
    return TableBook(tuple(made))


def estimator_of(breaks: int, end_m: float, begin_m: float = 0.0, noise_m_s: float = 0.05) -> Estimator:
    """A retarder that brakes hard in the second and third quarter of the path, on a slope.

    At break 5 of 16 on 37.45 m float32 gives the two lines that meet there another value.
    """
    s = [begin_m + (end_m - begin_m) * (index / (breaks - 1)) ** 1.1 for index in range(breaks)]
    brake = [0.0007 * (x - begin_m) + 0.004 * max(0.0, min(x, 0.75 * end_m) - 0.25 * end_m) for x in s]
    return Estimator(
        noise_m_s, 0.15, 0.006, 0.1, 2.0, 6, 20, 0.2, 0.5, 50.0, tuple(s), tuple(0.06 * x for x in s), tuple(brake)
    )


def braking_lines(target: float, stages: int, degree: int) -> tuple[Stage, ...]:
    """Lines like those of a tune: a falling speed towards the exit, higher for higher stages, the last one unused."""
    found = []
    for k in range(stages):
        top = [target + 1.5 + 0.4 * k, -0.05, 1e-3, -1.1e-5, 1e-7, 0.0, 0.0, 0.0, 0.0, 1e-16][: degree + 1]
        upper = round_coefficients(top) if k < stages - 2 else None
        lower = round_coefficients([top[0] - 0.9, *(0.9 * c for c in top[1:])]) if k > 0 else None
        if k == stages - 1:
            lower = round_coefficients([10.0] + [0.0] * degree)
        found.append(Stage(k, 150.0 * k, lower, upper))
    return tuple(found)


def turning_lines() -> tuple[Stage, ...]:
    """Lines by which stage 1 raises and stage 2 lowers, and again stage 2 raises and 3 lowers, near the entrance."""
    uppers, lowers = (4.0, 5.0, 6.5, None, None), (None, 3.5, 5.75, 7.0, 10.0)
    return tuple(
        Stage(k, 150.0 * k, None if low is None else (low, -0.125), None if high is None else (high, -0.0625))
        for k, (low, high) in enumerate(zip(lowers, uppers, strict=True))
    )


def table_of(
    name: str, category: str, mass_t: float, axles: tuple[float, ...], target: float, stages: int = 5, degree: int = 3
) -> ControllerTable:
    """A table of the one position that all of the book are for."""
    return ControllerTable(
        id=name,
        created="2026-11-21T08:00:00Z",
        generator=Generator("retarder-synth", "0.1.0", "0123456789abcdef" * 4),
        retarder=RetarderId("КНП-5 /* bunch */ ??/", ((0.0, 12.475), (14.475, 26.95)), 37.45, 15.0),
        cut=CutId(category, mass_t, axles),
        target_speed_m_s=target,
        clock=RegulatorClock(sample_period_s=0.1, computing_delay_s=0.02),
        degree=degree,
        stages=braking_lines(target, stages, degree),
        valid=ValidRange((0.0, 37.45), (0.3, 9.0)),
        predicted=Predicted(0.05, -0.001, 0.01, 4.1),
    )
