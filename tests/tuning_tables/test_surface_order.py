"""At no path and no pressure does a stage ask to be lowered and raised: what is proved of surfaces, what is refused."""

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.effort import sized
from tuning_tables import ControllerTable, Decisions, InvalidTable, Stage, ValidRange
from tuning_tables.stage import Line, range_above, round_coefficients, surface_bound

Tilting = Callable[..., ControllerTable]
Slopes = tuple[float, float]
Floats = npt.NDArray[np.float32]

PRESSURES = (0.0, 100.0, 250.0, 1000.0)
STEP = 2.0**-149


@pytest.fixture(scope="module")
def tilting(table: ControllerTable) -> Tilting:
    """A function that builds a table of four stages, raised to stage 2 at most, whose stage 1 has these surfaces."""

    def make(
        lower: Line,
        upper: Line,
        slopes: Slopes,
        s_m: tuple[float, float] = (0.0, 10.0),
        pressures: tuple[float, ...] = PRESSURES,
    ) -> ControllerTable:
        flat = (0.0,) * len(lower)
        stages = (
            Stage(0, pressures[0], None, flat, None, 0.0),
            Stage(1, pressures[1], lower, upper, *slopes),
            Stage(2, pressures[2], flat, None, 0.0, None),
            Stage(3, pressures[3], flat, None, 0.0, None),
        )
        return replace(
            table,
            degree=len(lower) - 1,
            stages=stages,
            valid=ValidRange(s_m, (0.0, 9.0)),
            decisions=Decisions.AT_ANY_TIME,
        )

    return make


@pytest.mark.requirement("RULE-06")
@pytest.mark.parametrize(
    ("lower", "upper", "slopes", "accepted"),
    [
        # Stage 1 is asked from 100 kPa below its own pressure to 150 kPa above.
        ((2.0,), (3.0,), (0.0, 0.0), True),
        ((2.0,), (3.0,), (-(2.0**-7), 0.0), True),  # 25/32 m/s higher at the lowest pressure
        ((2.0,), (3.0,), (-(2.0**-6), 0.0), False),  # 1 + 9/16 m/s: they cross there only
        ((2.0,), (3.0,), (0.0, 2.0**-6), False),
        ((2.0,), (3.0,), (2.0**-8, 0.0), True),  # 75/128 m/s higher at the highest
        ((2.0,), (3.0,), (2.0**-7, 0.0), False),  # 1 + 11/64 m/s: they cross there only
        ((2.0,), (3.0,), (0.0, -(2.0**-7)), False),
        ((2.0,), (2.5625, 0.0)[:1], (-(2.0**-8), 2.0**-9), False),  # 25/64 + 25/128 are more than 9/16
        ((2.0,), (2.625,), (-(2.0**-8), 2.0**-9), True),
        # The sum of both distances decides: at s = 10 there are 1/4 m/s left at the pressure of the stage.
        ((2.0, 0.0), (3.0, -0.075), (-(2.0**-9), 0.0), True),
        ((2.0, 0.0), (3.0, -0.075), (-(2.0**-8), 0.0), False),
        # gap (s - 5)^2 + 1/4 over the path, and 25/128 or 25/64 less of it at the lowest pressure
        ((0.0, 0.0, 0.0), (25.25, -10.0, 1.0), (-(2.0**-9), 0.0), True),
        ((0.0, 0.0, 0.0), (25.25, -10.0, 1.0), (-(2.0**-8), 0.0), False),
        # They touch at an end.
        ((2.0,), (3.5625,), (-(2.0**-6), 0.0), False),
        ((2.0,), (3.171875,), (2.0**-7, 0.0), False),
        # However steep, equal slopes keep their distance, unless float32 does not.
        ((2.0,), (3.0,), (1000.0, 1000.0), True),
        ((2.0,), (3.0,), (2.0**20, 2.0**20), False),
        # They would cross at 1000 kPa, the pressure of stage 3, which no table raises to.
        ((2.0,), (3.0,), (2.0**-9, 0.0), True),
    ],
)
def test_surfaces_must_keep_their_order_at_all_pressures(
    tilting: Tilting, lower: Line, upper: Line, slopes: Slopes, accepted: bool
) -> None:
    rounded = round_coefficients(upper)
    if accepted:
        assert tilting(lower, rounded, slopes).stages[1].slopes == slopes
    else:
        with pytest.raises(
            InvalidTable, match=r"^stages\[1\]: upper - lower .* from -100 to 150 kPa above that of the"
        ):
            tilting(lower, rounded, slopes)


def test_a_stage_above_the_highest_raised_keeps_its_order_where_the_gauge_is_silent(table: ControllerTable) -> None:
    def made(lower: float, upper: float) -> ControllerTable:
        """Never raised at all; at the pressure of stage 0 the lines of stage 1 lie 2 m/s further apart."""
        stages = (
            Stage(0, 0.0, None, None),
            Stage(1, 100.0, (lower,), (upper,), 2.0**-6, -(2.0**-8)),
            Stage(2, 200.0, (0.0,), None, 0.0, None),
        )
        return replace(table, degree=0, stages=stages, decisions=Decisions.AT_ANY_TIME)

    assert range_above(made(2.0, 3.0).pressures, 0, 1) == (-100.0, 0.0)
    with pytest.raises(InvalidTable, match=r"^stages\[1\]: upper - lower .* from -100 to 0 kPa"):
        made(3.0, 2.0)


def surface(line: Floats, slope: np.float32, s: Floats, above: Floats) -> Floats:
    """A surface as the rule computes it, float32."""
    value = np.full(s.shape, line[-1], dtype=np.float32)
    for coefficient in line[-2::-1]:
        value = value * s + coefficient
    return np.asarray(value + slope * above, dtype=np.float32)


def dense_readings(table: ControllerTable, seed: int, count: int = 4000) -> tuple[Floats, Floats]:
    """Paths, and pressures less that of stage 1: anywhere, and at the ends of each."""
    chance = np.random.default_rng(seed)
    s_min, s_max = table.valid_range[:2]
    lowest, highest = table.pressures[0], table.pressures[table.highest_raised]
    s = np.clip(chance.uniform(s_min, s_max, count).astype(np.float32), s_min, s_max)
    kpa = np.clip(chance.uniform(lowest, highest, count).astype(np.float32), lowest, highest)
    s[::5], s[1::5] = s_min, s_max
    kpa[::4], kpa[1::4] = lowest, highest
    return s, kpa - table.pressures[1]


coefficients = st.floats(-8, 8, width=32).map(lambda c: c + 0.0)  # no -0.0
slopes = st.floats(-(2.0**-5), 2.0**-5, width=32).map(lambda c: c + 0.0)


@pytest.mark.requirement("RULE-06")
@given(
    lower=st.lists(coefficients, min_size=1, max_size=5),
    gap=st.floats(2.0**-26, 2.0**-12),
    slope=st.floats(-4, 4, width=32).map(lambda c: c + 0.0),
    turn=st.floats(-(2.0**-24), 2.0**-24),
    seed=st.integers(0, 2**32 - 1),
)
@settings(derandomize=True, max_examples=sized(37, 150), deadline=None)
def test_accepted_surfaces_never_cross_in_float32(
    tilting: Tilting, lower: list[float], gap: float, slope: float, turn: float, seed: int
) -> None:
    upper = round_coefficients([lower[0] + gap, *lower[1:]])
    both = (slope, round_coefficients([slope + turn])[0])
    try:
        table = tilting(tuple(lower), upper, both, (-1.5, 2.0), (0.3, 100.1, 250.7, 1000.0))
    except InvalidTable:
        assume(False)
    s, above = dense_readings(table, seed)
    low, high = (surface(table.coefficients[1, i], table.slopes[1, i], s, above) for i in (0, 1))
    assert np.all(low < high)


any_float32 = st.floats(width=32, allow_nan=False, allow_infinity=False, min_value=-1e6, max_value=1e6)
pressures = st.floats(0, 2e3, width=32)


@given(
    line=st.lists(any_float32, min_size=1, max_size=6),
    slope=any_float32,
    s=st.floats(-50, 50, width=32),
    ends=st.tuples(pressures, pressures, pressures),
)
@settings(derandomize=True, max_examples=sized(100, 400), deadline=None)
def test_the_bound_holds_against_exact_arithmetic(
    line: list[float], slope: float, s: float, ends: tuple[float, float, float]
) -> None:
    own, one, other = ends
    found = surface(
        np.array(line, np.float32),
        np.float32(slope),
        np.array([s], np.float32),
        np.array([one], np.float32) - np.float32(own),
    )
    exact = sum(Fraction(c) * Fraction(s) ** i for i, c in enumerate(line))
    exact += Fraction(slope) * (Fraction(one) - Fraction(own))
    low, high = sorted((one - own, other - own))
    bound = surface_bound(tuple(line), slope, (min(s, -1.0), max(s, 1.0)), (min(low, 0.0), max(high, 0.0)))
    assert abs(Fraction(float(found[0])) - exact) <= Fraction(bound)


@pytest.mark.parametrize(("degree", "nearness"), [(0, 0.5), (1, 0.3), (3, 0.1)])
def test_the_bound_is_nearly_reached(degree: int, nearness: float) -> None:
    """Otherwise tables would be refused that are sound."""
    chance = np.random.default_rng(3)
    own, s_range, above_range = np.float32(100.1), (0.0, 2.0), (-100.1, 200.0)
    nearest = 0.0
    for _ in range(300):
        line = chance.uniform(0.5, 1.0, degree + 1).astype(np.float32)
        slope = np.float32(chance.uniform(0.001, 0.02))
        s = chance.uniform(1.9, 2.0, 300).astype(np.float32)
        kpa = chance.uniform(250.0, 300.0, 300).astype(np.float32)
        exact = np.polynomial.polynomial.polyval(s.astype(float), line.astype(float))
        exact += float(slope) * (kpa.astype(float) - float(own))
        error = np.abs(surface(line, slope, s, kpa - own) - exact).max()
        nearest = max(nearest, error / surface_bound(tuple(line.tolist()), float(slope), s_range, above_range))
    assert nearness < nearest <= 1.0


def test_what_underflow_loses_is_in_the_bound() -> None:
    slope, above = np.float32(STEP), np.array([0.5], np.float32)
    lost = STEP / 2 - float(surface(np.array([0.0], np.float32), slope, np.array([0.0], np.float32), above)[0])
    assert lost == STEP / 2
    assert lost <= surface_bound((0.0,), STEP, (0.0, 1.0), (0.0, 0.5)) <= 2 * STEP
