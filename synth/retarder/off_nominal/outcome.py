"""What became of a table in a condition; plain values, no kernel behind them."""

from __future__ import annotations

from dataclasses import dataclass

from synth.simulation.replicates import Interval


@dataclass(frozen=True)
class Outcome:
    """`change`: what differs from the plant of the table; figures of `passes` passes of it, with 95 % intervals.

    `ratio`: rms / rms of the same passes on the plant of the table (paired), None where these have no error.
    `overspeed`: share that leaves more than 0.3 m/s too fast, `stalled`: that stops inside.
    """

    change: str
    passes: int
    rms_m_s: float
    rms_ci95_m_s: Interval
    ratio: float | None
    ratio_ci95: Interval | None
    overspeed: float
    overspeed_ci95: Interval
    stalled: float
    stalled_ci95: Interval


@dataclass(frozen=True)
class OffNominal:
    """`outcome` of the condition `key`, called `name`; None where no such plant can be, and `impossible` says why."""

    key: str
    name: str
    outcome: Outcome | None
    impossible: str = ""
