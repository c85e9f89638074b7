"""Tables to test with: one that a tuning run might give, and a maker of its variants."""

from collections.abc import Callable
from dataclasses import replace

import pytest

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
    Validated,
    ValidRange,
)
from tuning_tables.stage import Line, round_coefficients


@pytest.fixture(scope="session")
def table() -> ControllerTable:
    """Four stages, cubic lines with rounded coefficients, an umlaut in a name, validated."""
    return ControllerTable(
        id="leer-22t-4.0",
        created="2026-11-20T22:46:00Z",
        generator=Generator("retarder-synth", "0.1.0", "0123456789abcdef" * 4),
        retarder=RetarderId("Talbremse Süd", ((0.0, 12.475), (14.475, 26.95)), 37.45, 15.0),
        cut=CutId("medium", 22.0, (0.0, 1.85, 8.65, 10.5)),
        target_speed_m_s=4.0,
        clock=RegulatorClock(sample_period_s=0.1, computing_delay_s=0.02),
        degree=3,
        stages=(
            Stage(0, 0.0, None, round_coefficients([6.1, -0.05, 1e-3, -3.3e-5])),
            Stage(
                1, 150.0, round_coefficients([5.2, -0.04, 5e-4, -1e-5]), round_coefficients([6.3, -0.05, 1e-3, -3e-5])
            ),
            Stage(2, 300.0, round_coefficients([5.6, -0.05, 8e-4, -2e-5]), None),
            Stage(3, 450.0, round_coefficients([5.8, -0.05, 8e-4, -2e-5]), None),
        ),
        valid=ValidRange((0.0, 37.45), (0.3, 9.0)),
        predicted=Predicted(0.05, -0.001, 0.01, 4.1),
        validated=Validated(20000, 0.05, (0.049, 0.051)),
    )


@pytest.fixture(scope="session")
def linear_table(table: ControllerTable) -> ControllerTable:
    """Two stages and lines that are exact in float32: raise above 4 + s/4, lower below 2 + s/4; path 1..8 m."""
    return replace(
        table,
        id="linear",
        degree=1,
        stages=(Stage(0, 0.0, None, (4.0, 0.25)), Stage(1, 100.0, (2.0, 0.25), None)),
        valid=ValidRange((1.0, 8.0), (0.0, 9.0)),
        predicted=Predicted(0.1, 0.0, 0.0, 2.0, p_stall=0.25),
        validated=None,
    )


@pytest.fixture(scope="session")
def turning_table(linear_table: ControllerTable) -> ControllerTable:
    """Five stages. At 0 m stages 0 to 3 raise above 4, 5, 6, 7.5 m/s, stages 1 to 4 lower below 3, 4, 7, 8 m/s.

    So between 6 and 7 m/s stage 2 raises and stage 3 lowers, and between 7.5 and 8 m/s stage 3 raises and 4 lowers.
    """
    uppers, lowers = (4.0, 5.0, 6.0, 7.5, None), (None, 3.0, 4.0, 7.0, 8.0)
    stages = tuple(
        Stage(k, 100.0 * k, None if low is None else (low, 0.125), None if high is None else (high, 0.125))
        for k, (low, high) in enumerate(zip(lowers, uppers, strict=True))
    )
    return replace(linear_table, id="turning", stages=stages, valid=ValidRange((0.0, 40.0), (0.0, 20.0)))


@pytest.fixture(scope="session")
def approached_table(table: ControllerTable) -> ControllerTable:
    """The table with 4 m of approach and entrance stage 1: stage 1 has an upper line to be gated."""
    valid = replace(table.valid, s_m=(-4.0, 37.45))
    return replace(table, id="approached", valid=valid, approach=Approach(4.0, 1))


@pytest.fixture(scope="session")
def estimated_table(linear_table: ControllerTable) -> ControllerTable:
    """The linear table for the estimated speed; the retarder stands between 2 and 7 m."""
    breaks, drive, brake = (0.0, 2.0, 5.0, 7.0, 9.5), (0.0, 0.132, 0.33, 0.4, 0.55), (0.0, 0.0, 0.008, 0.02, 0.02)
    estimator = Estimator(0.05, 0.15, 0.006, 0.1, 2.0, 7, 20, 0.2, 0.5, 60.0, breaks, drive, brake)
    predicted = Predicted(0.1, 0.0, 0.0, 2.0, 0.25, passes=5000)
    return replace(linear_table, id="estimated", estimator=estimator, predicted=predicted)


@pytest.fixture(scope="session")
def approached_estimate(estimated_table: ControllerTable) -> ControllerTable:
    """The estimated table with 4 m of approach: its path and its breaks begin there."""
    assert estimated_table.estimator is not None
    breaks = (-4.0, *estimated_table.estimator.s_m[1:])
    return replace(
        estimated_table,
        id="approached-estimate",
        valid=replace(estimated_table.valid, s_m=(-4.0, 8.0)),
        estimator=replace(estimated_table.estimator, s_m=breaks),
        approach=Approach(4.0, 0),
    )


@pytest.fixture(scope="session")
def surface_table(approached_table: ControllerTable) -> ControllerTable:
    """The table with approach that decides at any time, with a gauge. Raised to stage 2 at most."""
    slopes = ((None, -0.004), (-0.006, -0.005), (-0.003, None), (0.0, None))
    rounded = [[None if each is None else round_coefficients([each])[0] for each in pair] for pair in slopes]
    stages = tuple(
        replace(stage, lower_slope_m_s_per_kpa=lower, upper_slope_m_s_per_kpa=upper)
        for stage, (lower, upper) in zip(approached_table.stages, rounded, strict=True)
    )
    return replace(approached_table, id="surface", stages=stages, decisions=Decisions.AT_ANY_TIME)


@pytest.fixture(scope="session")
def surface_estimate(approached_estimate: ControllerTable) -> ControllerTable:
    """The estimated table with approach, at any time, but without gauge."""
    return replace(approached_estimate, id="surface-estimate", decisions=Decisions.AT_ANY_TIME)


@pytest.fixture(scope="session")
def crossing(table: ControllerTable) -> Callable[[Line, Line, tuple[float, float]], ControllerTable]:
    """A function that builds a three-stage table whose middle stage has the given lower and upper line."""

    def make(lower: Line, upper: Line, s_m: tuple[float, float]) -> ControllerTable:
        return replace(
            table,
            degree=len(lower) - 1,
            stages=(Stage(0, 0.0, None, upper), Stage(1, 100.0, lower, upper), Stage(2, 200.0, lower, None)),
            valid=ValidRange(s_m, (0.0, 9.0)),
        )

    return make
