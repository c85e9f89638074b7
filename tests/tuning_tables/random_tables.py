"""Valid tables of every shape and size, for hypothesis."""

from dataclasses import replace

from hypothesis import strategies as st

from tuning_tables import (
    Approach,
    ControllerTable,
    CutId,
    Decisions,
    Estimator,
    Generator,
    InvalidTable,
    Predicted,
    RegulatorClock,
    RetarderId,
    Stage,
    Validated,
    ValidRange,
)
from tuning_tables.category_number import KNOWN_NUMBERS
from tuning_tables.stage import HIGHEST_DEGREE, MOST_STAGES, require_order, require_stage, round_coefficients

# Whatever is printable in any script; but no space other than U+0020 is.
texts = st.text(st.characters(exclude_categories=("C", "Z")) | st.just(" "), min_size=1, max_size=12)
digests = st.text("0123456789abcdef", min_size=64, max_size=64)
instants = st.datetimes().map(lambda instant: instant.isoformat(timespec="microseconds") + "Z")
probabilities = st.floats(0.0, 1.0)


def numbers(smallest: float | None = None, largest: float | None = None) -> st.SearchStrategy[float]:
    """Finite doubles, the denormal ones too, without -0.0, which no format takes."""
    return st.floats(smallest, largest, allow_nan=False, allow_infinity=False).map(lambda value: value + 0.0)


def above_zero() -> st.SearchStrategy[float]:
    return numbers(5e-324)


def rising(
    entries: st.SearchStrategy[float], min_size: int = 0, max_size: int | None = None
) -> st.SearchStrategy[tuple[float, ...]]:
    return st.lists(entries, unique=True, min_size=min_size, max_size=max_size).map(sorted).map(tuple)


@st.composite
def retarders(draw: st.DrawFn) -> RetarderId:
    """One to three zones, and an exit at or behind the last."""
    ends = draw(rising(numbers(-1e3, 1e3), min_size=2, max_size=6).filter(lambda ends: len(ends) % 2 == 0))
    exit_m = draw(numbers(ends[-1], 2e3))
    return RetarderId(draw(texts), tuple(zip(ends[::2], ends[1::2], strict=True)), exit_m, draw(numbers(0.0)))


@st.composite
def stage_lists(draw: st.DrawFn, degree: int, s_m: tuple[float, float]) -> tuple[Stage, ...]:
    """2 to 32 stages; both lines where they keep their order."""
    pressures = draw(rising(numbers(0.0, 1e4), min_size=2, max_size=MOST_STAGES))
    coefficients = st.lists(
        st.floats(-9.0, 9.0, width=32).map(lambda c: c + 0.0), min_size=degree + 1, max_size=degree + 1
    )
    stages = []
    for k, pressure in enumerate(pressures):
        lower = tuple(draw(coefficients)) if k > 0 and draw(st.booleans()) else None
        upper = tuple(draw(coefficients)) if k < len(pressures) - 1 and draw(st.booleans()) else None
        if lower and upper:
            upper = round_coefficients([lower[0] + draw(st.floats(1e-4, 9.0)) + 0.0, *lower[1:]])
            try:
                require_order(lower, upper, s_m, "drawn")
            except InvalidTable:
                upper = None
        stages.append(Stage(k, pressure, lower, upper))
    return tuple(stages)


def sloped(stage: Stage, slope: float, s_m: tuple[float, float]) -> Stage:
    """Both lines with one slope, so that they keep their distance at every pressure; one where rounding takes it."""
    lower, upper = (None if line is None else slope for line in stage.lines)
    kept = replace(stage, lower_slope_m_s_per_kpa=lower, upper_slope_m_s_per_kpa=upper)
    try:
        require_stage(kept, s_m, (-1e4, 1e4), "drawn")
    except InvalidTable:
        return replace(kept, upper=None, upper_slope_m_s_per_kpa=None)
    return kept


@st.composite
def estimators(draw: st.DrawFn, latest_m: float = 50.0) -> Estimator:
    """An estimator with two to six breaks, the first at `latest_m` or before."""
    steps = draw(st.lists(st.floats(0.5, 50.0), min_size=1, max_size=5))
    breaks = [draw(numbers(-50.0, latest_m))]
    for step in steps:
        breaks.append(breaks[-1] + step + 0.0)
    length = len(breaks)
    return Estimator(
        draw(st.floats(1e-4, 10.0)),
        draw(numbers(0.0, 1.0)),
        draw(numbers(0.0, 1.0)),
        draw(numbers(0.0, 1.0)),
        draw(st.floats(1e-3, 1e4)),
        draw(st.integers(1, 1000)),
        draw(st.integers(1, 1000)),
        draw(st.floats(1e-3, 10.0)),
        draw(numbers(0.0, 10.0)),
        draw(numbers(0.0, 2e3)),
        tuple(breaks),
        tuple(draw(st.lists(numbers(-1e6, 1e6), min_size=length, max_size=length))),
        tuple(sorted(draw(st.lists(numbers(-1e6, 1e6), min_size=length, max_size=length)))),
    )


@st.composite
def cuts(draw: st.DrawFn) -> CutId:
    """A category with no number, with its own, or one of the yard; each name and number stands for the other alone."""
    sizes = draw(above_zero()), (0.0, *draw(rising(above_zero(), max_size=4)))
    number = draw(st.integers(16, 255))
    known = st.sampled_from(sorted(KNOWN_NUMBERS)).map(lambda name: (name, KNOWN_NUMBERS[name]))
    other = texts.filter(lambda name: name not in KNOWN_NUMBERS and not name.startswith("own "))
    name, stated = draw(other.map(lambda name: (name, None)) | known | st.just((f"own {number}", number)))
    return CutId(name, *sizes, stated)


@st.composite
def tables(
    draw: st.DrawFn, names: st.SearchStrategy[str] = texts, generators: st.SearchStrategy[Generator] | None = None
) -> ControllerTable:
    """A table whose id is one of `names`; its path range is a few hundred metres at most."""
    degree = draw(st.integers(0, HIGHEST_DEGREE))
    length_m = draw(st.none() | numbers(1e-3, 50.0))
    begin_m = draw(numbers(-50.0, 50.0)) if length_m is None else -length_m
    s_m = (begin_m, (begin_m if length_m is None else 0.0) + draw(st.floats(0.5, 50.0)) + 0.0)
    low_m_s = draw(numbers(0.0, 5.0))
    interval = sorted((draw(numbers(0.0)), draw(numbers(0.0))))
    estimator = draw(st.none() | estimators(50.0 if length_m is None else begin_m))
    stages = draw(stage_lists(degree, s_m))
    decisions = draw(st.sampled_from(Decisions))
    if decisions is Decisions.AT_ANY_TIME and draw(st.booleans()):
        stages = tuple(sloped(stage, draw(st.floats(-0.5, 0.5, width=32)) + 0.0, s_m) for stage in stages)
    return ControllerTable(
        id=draw(names),
        created=draw(instants),
        generator=draw(generators or st.builds(Generator, texts, texts, digests)),
        retarder=draw(retarders()),
        cut=draw(cuts()),
        target_speed_m_s=draw(above_zero()),
        clock=RegulatorClock(draw(numbers(1e-3, 2.0)), draw(numbers(0.0, 2.0))),
        degree=degree,
        stages=stages,
        valid=ValidRange(s_m, (low_m_s, low_m_s + draw(st.floats(0.5, 20.0)))),
        predicted=Predicted(
            draw(numbers(0.0)),
            draw(numbers()),
            draw(probabilities) + 0.0,
            draw(numbers(0.0)),
            draw(st.none() | probabilities.map(lambda p: p + 0.0)),
            None if estimator is None else draw(st.none() | st.integers(1, 2**53)),
        ),
        validated=draw(st.none() | st.builds(Validated, st.integers(1, 2**53), numbers(0.0), st.just(tuple(interval)))),
        estimator=estimator,
        approach=None if length_m is None else Approach(length_m, draw(st.integers(0, len(stages) - 1))),
        decisions=decisions,
    )
