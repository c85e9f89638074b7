"""Every formula of reliability beside the null space, the differential equations, a grid, and simulated lives."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple, dataclass, replace

import numpy as np
from numpy.typing import NDArray

from scripts.studies.control_computer.comparison import Comparison, judged
from scripts.studies.control_computer.lives import Interval, chain_shares, duplex_ready
from scripts.studies.control_computer.stationary import null_space_shares, stationary_shares
from scripts.studies.markdown_table import MarkdownTable, table
from scripts.studies.study import Tell
from synth.computer.reliability.duplex import Duplex, single_availability
from synth.computer.reliability.four_states import FourStates, State
from synth.computer.reliability.maintenance_interval import (
    CalendarHours,
    CheckedComputer,
    Counted,
    UsefulHours,
    WorkingHours,
    small_rate_interval_h,
)

Floats = NDArray[np.float64]

CHAINS = {
    "check repairs, as printed": FourStates(0.01, 0.2, 0.4, 4.0, 0.5),
    "check leads to repair": FourStates(0.01, 0.2, 0.4, 4.0, 0.5, State.REPAIR),
    "fails often, repaired slowly": FourStates(0.3, 0.1, 0.2, 0.5, 0.05, State.REPAIR),
}
STATES = ("ready", "failed unnoticed", "maintenance", "repair")
SHORT_H, LONG_H = 1.0, 2000.0
CLOSE = 1e-9
"""What closed form, null space and integration may differ by."""

COMPUTER = CheckedComputer(failure_per_h=0.01, check_h=0.25, manual_price_per_h=0.2, unnoticed_price_per_h=2.0)
COUNTED: dict[str, Counted] = {
    "an hour of use (published)": UsefulHours(),
    "an hour between checks": WorkingHours(),
    "an hour of the calendar": CalendarHours(),
}
GRID_H = (0.5, 6.0, 1e-4)
DUPLEXES = ((0.01, 24.0, 1.0), (0.01, 100.0, 2.0), (0.05, 24.0, 1.0), (0.001, 168.0, 2.0), (0.02, 10.0, 0.0))
"""Failures an hour, period, check in h."""


@dataclass(frozen=True)
class ChainState:
    """Share of time in one state of one chain, told in four ways; `after_1_h`: the transient from ready, by the matrix
    exponential and by integration."""

    chain: str
    state: str
    null_space: float
    elimination: float
    integrated: float
    after_1_h: tuple[float, float]
    simulated: Comparison

    @property
    def gap(self) -> float:
        """The largest difference among what has no random error."""
        closed = self.simulated.formula
        stationary = max(abs(each - closed) for each in (self.null_space, self.elimination, self.integrated))
        return max(stationary, abs(self.after_1_h[0] - self.after_1_h[1]))


@dataclass(frozen=True)
class BestInterval:
    """The interval that loses least by one kind of hour: as a root, and on a grid of `step_h`."""

    counted: str
    root_h: float
    grid_h: float
    step_h: float
    small_rate_h: float


@dataclass(frozen=True)
class DuplexPoint:
    """Availability of a pair: formula beside simulated periods, the formula as printed, and one computer alone."""

    failure_per_h: float
    period_h: float
    check_h: float
    pair: Comparison
    printed: float
    single: float


@dataclass(frozen=True)
class Reliability:
    """All of them."""

    chains: tuple[ChainState, ...]
    intervals: tuple[BestInterval, ...]
    duplexes: tuple[DuplexPoint, ...]

    @property
    def comparisons(self) -> tuple[Comparison, ...]:
        """With simulated lives."""
        return tuple(each.simulated for each in self.chains) + tuple(each.pair for each in self.duplexes)

    def tables(self) -> dict[str, MarkdownTable]:
        """`chain`, `interval`, `duplex`."""
        return {
            "chain": table(
                "the four states: share of time in closed form and by three other ways",
                ("chain", "state", "closed form", "largest difference to null space, elimination and integration",
                 "simulated lives", "cycles"),
                ((c.chain, c.state, f"{c.simulated.formula:.6f}", f"{c.gap:.0e}", simulated(c.simulated),
                  str(c.simulated.count)) for c in self.chains),
            ),
            "interval": table(
                "the interval between checks that loses least",
                ("loss for", "root, h", "minimum on a grid, h", "step of the grid, h", "√(2τSc/(λS1)), h"),
                ((i.counted, f"{i.root_h:.4f}", f"{i.grid_h:.4f}", f"{i.step_h:g}", f"{i.small_rate_h:.4f}")
                 for i in self.intervals),
            ),
            "duplex": table(
                "availability of two computers side by side",
                ("λ, 1/h", "period, h", "check, h", "formula", "simulated periods", "periods", "as printed",
                 "one alone"),
                ((f"{d.failure_per_h:g}", f"{d.period_h:g}", f"{d.check_h:g}", f"{d.pair.formula:.5f}",
                  simulated(d.pair), str(d.pair.count), f"{d.printed:.3g}", f"{d.single:.4f}")
                 for d in self.duplexes),
            ),
        }  # fmt: skip

    def faults(self) -> tuple[str, ...]:
        """What differs that must not."""
        apart = [f"chain {c.chain}, {c.state}: two ways differ by {c.gap:.1e}" for c in self.chains if c.gap > CLOSE]
        apart += [
            f"best interval for {i.counted}: the root {i.root_h:.5f} h is not the minimum of the grid, {i.grid_h:.5f} h"
            for i in self.intervals
            if abs(i.root_h - i.grid_h) > i.step_h
        ]
        return tuple(apart)


def simulated(found: Comparison) -> str:
    """With its interval."""
    return f"{found.simulated:.5f} ± {found.half_width:.5f}" + (" **outside**" if found.outside else "")


def reliability(lives: int, seed: int, tell: Tell) -> Reliability:
    """All parts, with so many simulated cycles and periods."""
    chains = [row for name, chain in CHAINS.items() for row in chain_rows(name, chain, lives, seed)]
    tell("chains compared")
    duplexes = [duplex_point(*point, lives, seed + place) for place, point in enumerate(DUPLEXES)]
    tell("duplex compared")
    limits = judged([each.simulated for each in chains] + [each.pair for each in duplexes])
    return Reliability(
        tuple(replace(row, simulated=limit) for row, limit in zip(chains, limits[: len(chains)], strict=True)),
        best_intervals(),
        tuple(replace(row, pair=limit) for row, limit in zip(duplexes, limits[len(chains) :], strict=True)),
    )


def chain_rows(name: str, chain: FourStates, cycles: int, seed: int) -> list[ChainState]:
    """The four states of one chain."""
    generator = chain.generator_per_h()
    short, late = integrated(generator, (SHORT_H, LONG_H))
    (matrix,) = chain.transient(np.array([SHORT_H]))
    lived = chain_shares(chain, cycles, seed)
    ways = zip(
        STATES, astuple(chain.stationary()), null_space_shares(generator), stationary_shares(generator), late,
        matrix, short, lived, strict=True,
    )  # fmt: skip
    return [
        ChainState(name, state, float(null), float(taken), float(end), (float(by_matrix), float(by_steps)),
                   lives_beside(f"chain {name}, {state}", closed, share, cycles))
        for state, closed, null, taken, end, by_matrix, by_steps, share in ways
    ]  # fmt: skip


def integrated(generator_per_h: Floats, hours: Sequence[float]) -> Floats:
    """Probabilities (hours, states) from ready on, by stepping through dp/dt = pQ."""
    from scipy.integrate import solve_ivp

    begin = np.eye(len(generator_per_h))[State.READY]
    solved = solve_ivp(lambda _, p: p @ generator_per_h, (0.0, hours[-1]), begin, "DOP853", hours, rtol=1e-12,
                       atol=1e-13)  # fmt: skip
    return np.asarray(solved.y.T)


def lives_beside(what: str, formula: float, found: Interval, count: int) -> Comparison:
    """A share beside that of simulated lives."""
    value, half_width = found
    return Comparison(what, float(formula), 0.0, value, half_width, 0, count)


def best_intervals() -> tuple[BestInterval, ...]:
    """By every kind of hour."""
    low, high, step = GRID_H
    grid = np.arange(low, high, step)
    small = small_rate_interval_h(COMPUTER)
    return tuple(
        BestInterval(name, counted.best_interval_h(COMPUTER), float(grid[COMPUTER.loss_per_h(grid, counted).argmin()]),
                     step, small)
        for name, counted in COUNTED.items()
    )  # fmt: skip


def duplex_point(failure_per_h: float, period_h: float, check_h: float, lives: int, seed: int) -> DuplexPoint:
    """One of them."""
    formula = float(Duplex(failure_per_h, check_h).availability(period_h))
    found = duplex_ready(failure_per_h, period_h, check_h, lives, seed)
    what = f"duplex, λ {failure_per_h:g}/h, period {period_h:g} h, check {check_h:g} h"
    return DuplexPoint(
        failure_per_h, period_h, check_h, lives_beside(what, formula, found, lives),
        printed_availability(failure_per_h, period_h, check_h),
        float(single_availability(failure_per_h, check_h, period_h)),
    )  # fmt: skip


def printed_availability(failure_per_h: float, period_h: float, check_h: float) -> float:
    """Kг(x) as [hump-computer-1970s] prints it, with "1 − e^{−λτк}" in the last term."""
    worn = failure_per_h * period_h
    both = np.exp(-2.0 * failure_per_h * (period_h - check_h)) / (2.0 * worn)
    alone = (1.0 - np.exp(-failure_per_h * check_h)) * np.exp(-worn) / worn
    return float(1.5 / worn + both - alone)
