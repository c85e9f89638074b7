"""The figures of quality in a table against a coarse simulation, and against one another.

An rms is made by rare passes: the few cuts with too little friction can hold most of the mean square. Half of the
coarse passes have low friction for that reason, and count by their weight. Still the two directions are tested
differently. That a table is *worse* than it says is looked for in ordinary passes too: squares count up to a cap, of
which several are tried. The mean of capped squares is at most the mean square, so a true claim is not doubted more
often, and being bounded it is normal. That a table is *better* than it says may only be luck, and then the spread of
the sample is too small as well: its relative standard error is applied to the mean square that is claimed.

A prediction that was itself simulated (tables with an estimator) is a mean over so many passes, and has the sampling
error of that: wherever it is compared, with the validated figures or with the coarse ones, both errors count.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final, Protocol

from synth.checker.statistics import (
    QUANTILE,
    ExitFigures,
    joint_count,
    score_interval,
    too_few,
    too_many,
    weighted_mean_and_std,
)

RMS_ALLOWANCE: Final = 0.04
"""Relative systematic error of the coarse simulation's rms (measured: docs/explanation/verification.md)."""
RMS_ALLOWANCE_M_S: Final = 0.001
BIAS_ALLOWANCE: Final = 0.1
"""Of the rms; the bias of the coarse simulation, and that of the solver's grid."""
BIAS_ALLOWANCE_M_S: Final = 0.003
SWITCHINGS_ALLOWANCE: Final = 0.1
PROBABILITY_ALLOWANCE: Final = 1.5
"""Factor; a limit of 0.3 m/s in a steep tail moves with the bias."""
PROBABILITY_ALLOWANCE_ABSOLUTE: Final = 0.002
CAPS: Final = (9.0, 100.0, math.inf)
"""Squares count up to so many times the largest mean square that the claim allows."""
NORMAL_95: Final = 1.959963984540054


@dataclass(frozen=True)
class PredictionRatio:
    """Limits of predicted rms / simulated rms, as the configuration of the tune sets them."""

    low: float
    high: float


class Claims(Protocol):
    """What a table of any kind says of its accuracy, by the names of `table_reading.Table`."""

    @property
    def predicted_rms_m_s(self) -> float:
        """Rms error at the exit, m/s."""
        ...

    @property
    def bias_m_s(self) -> float:
        """Mean error, m/s."""
        ...

    @property
    def p_overspeed(self) -> float:
        """Probability of an over-speed."""
        ...

    @property
    def switchings(self) -> float:
        """Mean changes of stage in a pass."""
        ...

    @property
    def p_stall(self) -> float | None:
        """Probability of a stall, None where it is not stated."""
        ...

    @property
    def predicted_passes(self) -> int | None:
        """Passes that the prediction was simulated with, None where it was not."""
        ...

    @property
    def passes(self) -> int | None:
        """Passes of the validation, None without."""
        ...

    @property
    def validated_rms_m_s(self) -> float | None:
        """Their rms error, m/s."""
        ...

    @property
    def validated_ci95_m_s(self) -> tuple[float, float] | None:
        """Its 95 % interval."""
        ...


def own_faults(table: Claims, prediction_ratio: PredictionRatio) -> Iterator[str]:
    """Claims that contradict themselves or one another, without any simulation."""
    rms, bias = table.predicted_rms_m_s, table.bias_m_s
    if rms < 0.0 or abs(bias) > rms * (1.0 + 1e-9):
        yield f"the predicted bias of {bias:.4g} m/s exceeds the predicted rms of {rms:.4g} m/s"
    for name, p in (("over-speed", table.p_overspeed), ("a stall", table.p_stall or 0.0)):
        if not 0.0 <= p <= 1.0:
            yield f"the predicted probability of {name} is {p:.4g}"
    if table.switchings < 0.0:
        yield f"the predicted number of switchings is {table.switchings:.4g}"
    if table.validated_rms_m_s is None or table.validated_ci95_m_s is None or table.passes is None:
        return
    low, high = table.validated_ci95_m_s
    if table.passes < 1 or not 0.0 <= low <= table.validated_rms_m_s <= high:
        stated = table.validated_rms_m_s
        yield f"the validated rms of {stated:.4g} m/s is not within its interval, {low:.4g} to {high:.4g}"
        return
    low, high = chance_interval(table.validated_rms_m_s, (low, high), table.passes, table.predicted_passes)
    least, most = low * prediction_ratio.low, high * prediction_ratio.high
    if not least <= rms <= most:
        yield (
            f"the predicted rms of {rms:.4f} m/s does not agree with the validated one: its interval and the "
            f"configuration's limits of the prediction ratio allow {least:.4f} to {most:.4f} m/s"
        )


def chance_interval(
    rms_m_s: float, ci95_m_s: tuple[float, float], passes: int, predicted_passes: int | None
) -> tuple[float, float]:
    """Where a predicted rms may lie by chance alone: in the 95 % interval of the validated one if it is exact.

    If it comes from `predicted_passes`: the interval of the difference of two samples in log(rms), at the level of the
    other tests, for then nothing but chance can part them.
    """
    if predicted_passes is None or ci95_m_s[0] <= 0.0:
        return ci95_m_s
    wider = QUANTILE / NORMAL_95 * math.sqrt(1.0 + passes / predicted_passes)
    return rms_m_s * (ci95_m_s[0] / rms_m_s) ** wider, rms_m_s * (ci95_m_s[1] / rms_m_s) ** wider


def simulated_faults(table: Claims, found: ExitFigures, prediction_ratio: PredictionRatio) -> Iterator[str]:
    """Claims that the coarse simulation does not confirm."""
    if table.validated_rms_m_s is not None:
        yield from rms_fault("validated", table.validated_rms_m_s, (1.0, 1.0), found, None)
    limits = (1.0 / prediction_ratio.high, 1.0 / prediction_ratio.low)
    yield from rms_fault("predicted", table.predicted_rms_m_s, limits, found, table.predicted_passes)
    root_n = math.sqrt(joint_count(found.passes, table.predicted_passes))
    error_std = max(found.error_std, table.predicted_rms_m_s)
    allowed = BIAS_ALLOWANCE * table.predicted_rms_m_s + BIAS_ALLOWANCE_M_S + QUANTILE * error_std / root_n
    if abs(found.bias_m_s - table.bias_m_s) > allowed:
        yield f"the predicted bias is {table.bias_m_s:+.4f} m/s, but the coarse simulation gives {found.bias_m_s:+.4f}"
    allowed = SWITCHINGS_ALLOWANCE * max(1.0, table.switchings) + QUANTILE * found.switchings_std / root_n
    if abs(found.switchings - table.switchings) > allowed:
        yield (
            f"{table.switchings:.2f} switchings a pass are predicted, but the coarse simulation gives "
            f"{found.switchings:.2f}"
        )
    yield from probability_fault("over-speed", table.p_overspeed, table.predicted_passes, found.over, found.plain)
    if table.p_stall is not None:
        yield from probability_fault("stalls", table.p_stall, table.predicted_passes, found.stalls, found.plain)


def rms_fault(
    name: str, rms_m_s: float, limits: tuple[float, float], found: ExitFigures, stated: int | None
) -> Iterator[str]:
    """Whether the mean square confirms an rms of at least and at most `limits` times `rms_m_s`.

    `stated`: passes that this one comes from, None where its own error is not to be counted.
    """
    least = max(0.0, rms_m_s * limits[0] * (1.0 - RMS_ALLOWANCE) - RMS_ALLOWANCE_M_S) ** 2
    most = (rms_m_s * limits[1] * (1.0 + RMS_ALLOWANCE) + RMS_ALLOWANCE_M_S) ** 2
    root_n = math.sqrt(joint_count(found.passes, stated))
    capped = [
        weighted_mean_and_std([min(square, cap * most) for square in found.squares], found.weights) for cap in CAPS
    ]
    worse = any(mean - most > QUANTILE * std / root_n for mean, std in capped)
    claimed_std = found.square_std * least / found.mean_square if found.mean_square else 0.0
    better = least - found.mean_square > QUANTILE * max(found.square_std, claimed_std) / root_n
    if worse or better:
        low, high = found.rms_ci95_m_s
        yield (
            f"the {name} rms is {rms_m_s:.4f} m/s, but the coarse simulation gives {found.rms_m_s:.4f} "
            f"[{low:.4f}, {high:.4f}] m/s in {found.passes} passes, {'more' if worse else 'less'} than chance and "
            "coarseness explain"
        )


def probability_fault(name: str, claimed: float, stated: int | None, hits: int, passes: int) -> Iterator[str]:
    """Whether `hits` of `passes` confirm the probability, `claimed` exactly or as a share of `stated` passes."""
    low, high = (claimed, claimed) if stated is None else score_interval(min(max(claimed, 0.0), 1.0), stated)
    most = high * PROBABILITY_ALLOWANCE + PROBABILITY_ALLOWANCE_ABSOLUTE
    least = low / PROBABILITY_ALLOWANCE - PROBABILITY_ALLOWANCE_ABSOLUTE
    if too_many(hits, passes, most) or (least > 0.0 and too_few(hits, passes, least)):
        yield f"the predicted probability of {name} is {claimed:.4g}, but {hits} of {passes} plain coarse passes had it"
