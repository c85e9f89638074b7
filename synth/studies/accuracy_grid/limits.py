"""The limits that the grid is held against: what was asked, what was found, whether it is met."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from statistics import median

from synth.studies.accuracy_grid.figures import Errors, Figures, GridCase

NOMINAL_CV = 0.15
HONESTY = (0.9, 1.1)
BASELINE_GAIN, TABLE_S, GRID_MIN = 3.0, 1.0, 15.0
REGRET = {"table": (1.2, 1.6), "estimated": (1.1, 1.3)}
"""Median and worst."""

LEAST_REGRET = 0.99
"""Nothing beats its reference, but for the chance of the passes."""

RMS_M_S = (0.07, 0.10)
"""Median and worst, at the nominal spread of friction."""

NAMES = {"table": "", "estimated": ", with estimator"}


@dataclass(frozen=True)
class Limit:
    """One line of the verdict."""

    asked: str
    found: str
    met: bool


def limits(cases: Sequence[GridCase], minutes: float) -> tuple[Limit, ...]:
    """The verdict on the `cases` that are served; `minutes` that the whole grid took."""
    known = [(case, case.figures) for case in cases if case.figures is not None]
    figures = [each for _, each in known]
    nominal = [each for case, each in known if case.cv == NOMINAL_CV]
    if not figures:
        return (Limit("a case that is served", "none", False),)
    return (
        *(regret(figures, key) for key in NAMES),
        *(rms(nominal, key) for key in NAMES if nominal),
        *(honesty(figures, key) for key in NAMES),
        *(limit for key in NAMES for limit in baselines(figures, key)),
        estimator(figures),
        *times(figures, minutes),
    )


def of(figures: Figures, key: str) -> Errors:
    """The table without or with estimator."""
    return figures.table if key == "table" else figures.estimated


def within(asked: str, values: Sequence[float], most: tuple[float, float], digits: int = 3) -> Limit:
    """Median and worst of `values` against those allowed."""
    middle, worst = median(values), max(values)
    found = f"median {middle:.{digits}f}, worst {worst:.{digits}f}"
    return Limit(asked, found, middle <= most[0] and worst <= most[1])


def regret(figures: Sequence[Figures], key: str) -> Limit:
    """rms / rms where the friction is told."""
    most = REGRET[key]
    values = [each.regret if key == "table" else each.regret_estimated for each in figures]
    asked = f"regret{NAMES[key]}: median ≤ {most[0]:g}, worst ≤ {most[1]:g}, least ≥ {LEAST_REGRET:g}"
    found = within(asked, values, most, 2)
    least = min(values)
    return Limit(asked, f"{found.found}, least {least:.3f}", found.met and least >= LEAST_REGRET)


def rms(figures: Sequence[Figures], key: str) -> Limit:
    """rms at the nominal spread."""
    asked = f"rms at CV {NOMINAL_CV:g}{NAMES[key]}: median ≤ {RMS_M_S[0]:g}, worst ≤ {RMS_M_S[1]:g} m/s"
    return within(asked, [of(each, key).rms_m_s for each in figures], RMS_M_S)


def honesty(figures: Sequence[Figures], key: str) -> Limit:
    """Predicted / simulated: the interval must reach the allowed range."""
    low, high = HONESTY
    values, off = [], 0
    for each in figures:
        ours = of(each, key)
        predicted = each.predicted_rms_m_s if key == "table" else each.estimated_predicted_rms_m_s
        values.append(predicted / ours.rms_m_s)
        off += not (predicted / ours.ci95_m_s[1] <= high and predicted / ours.ci95_m_s[0] >= low)
    found = f"{min(values):.3f} to {max(values):.3f}, interval outside in {off} of {len(values)}"
    return Limit(f"predicted / simulated{NAMES[key]}: {low:g} to {high:g} everywhere", found, off == 0)


def baselines(figures: Sequence[Figures], key: str) -> Iterator[Limit]:
    """Against the best tuned classical law: rms and switchings."""
    gain = median(each.gain(of(each, key)) for each in figures)
    asked = f"rms of the best baseline / table{NAMES[key]}: median ≥ {BASELINE_GAIN:g}"
    yield Limit(asked, f"median {gain:.2f}", gain >= BASELINE_GAIN)
    more = sum(each.more_switchings(of(each, key)) for each in figures)
    asked = f"switchings{NAMES[key]} not more than the best baseline's"
    yield Limit(asked, f"more in {more} of {len(figures)}", more == 0)


def estimator(figures: Sequence[Figures]) -> Limit:
    """No case worse beyond its interval."""
    worse = sum(each.ratio_ci95[0] > 1.0 for each in figures)
    return Limit("with the estimator no case worse beyond its interval", f"{worse} of {len(figures)} worse", worse == 0)


def times(figures: Sequence[Figures], minutes: float) -> Iterator[Limit]:
    """Seconds a table, minutes the whole grid."""
    seconds: tuple[tuple[str, Callable[[Figures], float]], ...] = (
        ("", lambda each: each.table_s), (NAMES["estimated"], lambda each: each.estimated_s),
    )  # fmt: skip
    for name, get in seconds:
        middle = median(get(each) for each in figures)
        yield Limit(
            f"one table{name}: ≤ {TABLE_S:g} s", f"median {middle:.2f} s, two cases at a time", middle <= TABLE_S
        )
    asked = f"the whole grid on two cores: ≤ {GRID_MIN:g} min"
    yield Limit(asked, f"{minutes:.1f} min", minutes <= GRID_MIN)
