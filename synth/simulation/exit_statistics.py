"""Figures of quality of a sample of exits, each with its 95 % interval; and the error at the exit that no regulator
of a position avoids: a bound of every rms from below.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from plant_models.frozen_arrays import Floats
from synth.problem.problem import OVERSPEED_M_S
from synth.simulation.passes import ExitSample
from synth.simulation.replicates import Interval, mean_of, quantiles_of, rms_of, rms_quotient, share_of

NORMAL_95 = 1.959963984540054
"""97.5 % quantile of the normal law."""


@dataclass(frozen=True)
class ExitStatistics:
    """Exit-speed error e = V_exit − V_target; a stalled pass counts with V_exit = 0.

    Shares and means are of cuts as they come, whatever the strata the passes were drawn from.

    Attributes
    ----------
    passes
        Simulated passes.
    rms_m_s
        Root of the mean square of e, m/s.
    rms_ci95_m_s
        95 % interval of it.
    bias_m_s
        Mean of e, m/s.
    bias_ci95_m_s
        95 % interval of it.
    std_m_s
        Standard deviation of e, m/s.
    p95_m_s
        95 % quantile of `|e|`, m/s.
    p95_ci95_m_s
        95 % interval of it.
    p99_m_s
        99 % quantile of `|e|`, m/s.
    p99_ci95_m_s
        95 % interval of it.
    overspeed
        Share with e > 0.3 m/s.
    overspeed_ci95
        95 % interval of it.
    stalled
        Share that stops in the position.
    stalled_ci95
        95 % interval of it.
    switchings
        Mean commands of a pass.
    switchings_ci95
        95 % interval of it.
    time_s
        Mean time from where the regulator acts to the exit, or to a stop, s.
    time_ci95_s
        95 % interval of it.

    Examples
    --------
    With `problem` and `table` from the example of `tabulate`:

    >>> import synth
    >>> found = synth.simulate(table, problem, passes=1000).statistics
    >>> found.passes, round(found.rms_m_s, 3)
    (1000, 0.033)
    """

    passes: int
    rms_m_s: float
    rms_ci95_m_s: Interval
    bias_m_s: float
    bias_ci95_m_s: Interval
    std_m_s: float
    p95_m_s: float
    p95_ci95_m_s: Interval
    p99_m_s: float
    p99_ci95_m_s: Interval
    overspeed: float
    overspeed_ci95: Interval
    stalled: float
    stalled_ci95: Interval
    switchings: float
    switchings_ci95: Interval
    time_s: float
    time_ci95_s: Interval

    @property
    def rms_text(self) -> str:
        """The rms and its interval, in words."""
        low, high = self.rms_ci95_m_s
        return f"rms {self.rms_m_s:.4f} [{low:.4f}, {high:.4f}] m/s"

    def __repr__(self) -> str:
        figures = (
            ("bias", self.bias_m_s, self.bias_ci95_m_s),
            ("95 % within", self.p95_m_s, self.p95_ci95_m_s),
        )
        told = (f"{name} {value:.4f} [{low:.4f}, {high:.4f}] m/s" for name, value, (low, high) in figures)
        return f"ExitStatistics({self.passes} passes: {', '.join((self.rms_text, *told))})"


@dataclass(frozen=True)
class BrakePower:
    """What brake power the cuts of a sample leave, and how exactly they exit where it suffices; 95 % intervals.

    `brake_saturated`: share of cuts that leave more than 0.3 m/s too fast even under a regulator that raises at every
    decision: no table can hold them. `rms_within_m_s`: rms of the exit error of all others, None if there are none.
    """

    brake_saturated: float
    brake_saturated_ci95: Interval
    rms_within_m_s: float | None
    rms_within_ci95_m_s: Interval | None


def exit_statistics(sample: ExitSample, target_m_s: float) -> ExitStatistics:
    """Statistics of `sample` against the commanded exit speed; `ValueError` for fewer than two replicates."""
    error, weight = sample.exit_speed_m_s - target_m_s, sample.weight
    rms, rms_ci95 = rms_of(error, weight)
    bias = mean_of(error, weight)
    (p95, p95_ci95), (p99, p99_ci95) = quantiles_of(np.abs(error), weight, (0.95, 0.99))
    over, over_ci95 = overspeed_of(sample, target_m_s, OVERSPEED_M_S)
    stalled, stalled_ci95 = share_of(sample.stalled, weight)
    switchings = mean_of(sample.switchings.astype(np.float64), weight)
    time = mean_of(sample.transit_time_s, weight)
    return ExitStatistics(
        passes=len(sample),
        rms_m_s=rms,
        rms_ci95_m_s=rms_ci95,
        bias_m_s=bias.value,
        bias_ci95_m_s=bias.ci95,
        std_m_s=math.sqrt(max(rms**2 - bias.value**2, 0.0)),
        p95_m_s=p95,
        p95_ci95_m_s=p95_ci95,
        p99_m_s=p99,
        p99_ci95_m_s=p99_ci95,
        overspeed=over,
        overspeed_ci95=over_ci95,
        stalled=stalled,
        stalled_ci95=stalled_ci95,
        switchings=switchings.value,
        switchings_ci95=switchings.ci95,
        time_s=time.value,
        time_ci95_s=time.ci95,
    )


def overspeed_of(sample: ExitSample, target_m_s: float, margin_m_s: float) -> tuple[float, Interval]:
    """Share of cuts that leave faster than target + margin, and its 95 % interval."""
    return share_of(sample.exit_speed_m_s - target_m_s > margin_m_s, sample.weight)


def brake_power(sample: ExitSample, full_brake: ExitSample, target_m_s: float) -> BrakePower:
    """What of `sample` is for want of brake power; `full_brake`: the same passes, raised at every decision."""
    out = full_brake.exit_speed_m_s - target_m_s > OVERSPEED_M_S
    share, ci95 = share_of(out, sample.weight)
    if out.all():
        return BrakePower(share, ci95, None, None)
    within = replace(sample, weight=np.where(out, 0.0, sample.weight))
    return BrakePower(share, ci95, *rms_of(within.exit_speed_m_s - target_m_s, within.weight))


def rms_ratio(sample: ExitSample, other: ExitSample, target_m_s: float) -> tuple[float, Interval]:
    """rms of `sample` / rms of `other`, same passes, and its 95 % interval (paired)."""
    a, b = (x.exit_speed_m_s - target_m_s for x in (sample, other))
    return rms_quotient(a, b, sample.weight)


def clopper_pearson(hits: int, n: int, confidence: float = 0.95) -> Interval:
    """Exact interval of a probability after `hits` in `n` independent trials (Clopper and Pearson 1934)."""
    from scipy.special import betaincinv  # start-up: scipy only where it is needed

    tail = 0.5 * (1.0 - confidence)
    low = 0.0 if hits == 0 else float(betaincinv(hits, n - hits + 1, tail))
    high = 1.0 if hits == n else float(betaincinv(hits + 1, n - hits, 1.0 - tail))
    return low, high


@dataclass(frozen=True)
class UnavoidableError:
    """Rms, over all cuts, of what they leave too fast by when slowest and too slow by when fastest; 95 % interval.

    `too_fast`: more of its mean square is from cuts that leave too fast than from those that leave too slow. No rms of
    the same passes is less, whatever regulator has them.
    """

    rms_m_s: float
    rms_ci95_m_s: Interval
    too_fast: bool

    @property
    def obstacle(self) -> str:
        """What stands in the way where it is too large, in three words."""
        return "brake saturated" if self.too_fast else "leaves too slow"

    def forbids(self, limit_m_s: float) -> bool:
        """No regulator keeps the rms `limit_m_s`: the whole interval is above it."""
        return self.rms_ci95_m_s[0] > limit_m_s

    def undecided(self, limit_m_s: float) -> bool:
        """The passes cannot tell whether it forbids `limit_m_s`: the interval holds that limit."""
        return self.rms_ci95_m_s[0] <= limit_m_s < self.rms_ci95_m_s[1]


def unavoidable_error(slowest: ExitSample, fastest: ExitSample, target_m_s: float) -> UnavoidableError:
    """The error that remains of passes that can leave no slower than in `slowest` and no faster than in `fastest`."""
    excess, lack = excess_and_lack_m_s(slowest, fastest, target_m_s)
    too_fast = float(slowest.weight @ excess**2) >= float(slowest.weight @ lack**2)
    return UnavoidableError(*rms_of(excess + lack, slowest.weight), too_fast)


def excess_and_lack_m_s(slowest: ExitSample, fastest: ExitSample, target_m_s: float) -> tuple[Floats, Floats]:
    """What each pass (n,) leaves too fast by at the least, and too slow by; of a pass one at most is above 0."""
    excess = np.maximum(slowest.exit_speed_m_s - target_m_s, 0.0)
    return excess, np.maximum(target_m_s - fastest.exit_speed_m_s, 0.0)
