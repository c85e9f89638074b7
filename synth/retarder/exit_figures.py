"""The figures of a closed loop as columns and rows: what every table of cases tells of simulated cuts."""

from __future__ import annotations

import math
from typing import Final

from synth.frame.exhibits import Column, Row
from synth.frame.interval import Interval
from synth.frame.printed_numbers import decimals, of_ten_thousand, per_cent
from synth.retarder.comparison.measured import prediction_ratio_of
from synth.simulation.exit_statistics import BrakePower, ExitStatistics
from synth.simulation.replicates import Interval as Ends
from tuning_tables import Predicted

CASE: Final = (
    Column("label", "case", words=True, once=True),
    Column("target_speed_m_s", "target", "m/s"),
)
"""Cut class and commanded exit speed."""

RMS: Final = Column("rms_m_s", "rms", "m/s", decimals(4))
WITHIN_95: Final = Column("p95_m_s", "95 of 100 within ±", "m/s", decimals(4), spare=3)
WITHIN_99: Final = Column("p99_m_s", "99 of 100 within ±", "m/s", decimals(4), spare=4)
SWITCHINGS: Final = Column("switchings", "switchings a pass", form=decimals(1), spare=8)
TIME: Final = Column("time_s", "time", "s", decimals(2), spare=9)
PREDICTED: Final = Column("predicted_rms_m_s", "predicted rms", "m/s", decimals(4), spare=8)
PREDICTION_RATIO: Final = Column("prediction_ratio", "predicted / simulated", form=decimals(2))
BRAKE_SATURATED: Final = Column("brake_saturated", "brake saturated, in 10\u00a0000", form=of_ten_thousand, spare=1)
RMS_WITHIN: Final = Column("rms_within_m_s", "rms of all others", "m/s", decimals(4), detail=True)

RISKS: Final = (
    Column("bias_m_s", "mean error", "m/s", decimals(4), detail=True),
    Column("std_m_s", "its deviation", "m/s", decimals(4), detail=True),
    Column("overspeed", "over-speed", form=per_cent, detail=True),
    Column("stalled", "stopped inside", form=per_cent, detail=True),
)
LOOP: Final = (RMS, WITHIN_95, WITHIN_99, *RISKS, SWITCHINGS, TIME)
"""All figures of `ExitStatistics`."""

TOLD: Final = (RMS, WITHIN_95, WITHIN_99, BRAKE_SATURATED, PREDICTED, PREDICTION_RATIO)
"""What every table of simulated tables tells first."""

EFFORT: Final = (SWITCHINGS, TIME)
DETAILS: Final = (*RISKS, RMS_WITHIN)
"""What it tells where there is room."""

LEGEND: Final = (
    "95 of 100 within ±: so many cuts leave within so many m/s of the target. Over-speed: more than 0.3 m/s above the "
    "target. Brake saturated: leaves that fast even where every decision raises the stage, so that no table can hold "
    "it. A cut that stops in the position counts with exit speed 0. Brackets, and ± their wider half: 95 % intervals, "
    "from passes in strata of the friction; the chance of these passes is all that they cover."
)

MODEL_ONLY: Final = (
    "All errors are those of a model with the parameters listed here, not of a retarder. Assumed parameters are "
    "guesses; calibrate them, then tune again."
)
CHANCE_ONLY: Final = (
    "Intervals (95 %) cover the chance of the simulated passes only, neither the parameters nor the model."
)
NOT_CERTIFIED: Final = (
    "The tool is not certified and claims no safety integrity. Before a table drives a retarder, check it with an "
    "independent program against the hashes below, and on the track."
)
"""What no figure of a tune says."""


def told(value: float | None, ends: Ends | None, n: int) -> Interval | None:
    """The figure with its interval; None where there is none."""
    if value is None or ends is None or not all(map(math.isfinite, (value, *ends))):
        return None
    return Interval(value, *ends, n)


def loop_row(found: ExitStatistics) -> Row:
    """The figures of `LOOP`."""
    n = found.passes
    return {
        "rms_m_s": told(found.rms_m_s, found.rms_ci95_m_s, n),
        "bias_m_s": told(found.bias_m_s, found.bias_ci95_m_s, n),
        "std_m_s": found.std_m_s,
        "p95_m_s": told(found.p95_m_s, found.p95_ci95_m_s, n),
        "p99_m_s": told(found.p99_m_s, found.p99_ci95_m_s, n),
        "overspeed": told(found.overspeed, found.overspeed_ci95, n),
        "stalled": told(found.stalled, found.stalled_ci95, n),
        "switchings": told(found.switchings, found.switchings_ci95, n),
        "time_s": told(found.time_s, found.time_ci95_s, n),
    }


def table_row(found: ExitStatistics, power: BrakePower, predicted: Predicted) -> Row:
    """The figures of a simulated table, beside what it predicted of itself: `TOLD`, `EFFORT` and `DETAILS`."""
    n = found.passes
    return {
        **loop_row(found),
        "brake_saturated": told(power.brake_saturated, power.brake_saturated_ci95, n),
        "rms_within_m_s": told(power.rms_within_m_s, power.rms_within_ci95_m_s, n),
        "predicted_rms_m_s": predicted.rms_m_s,
        "prediction_ratio": told(*prediction_ratio_of(predicted.rms_m_s, predicted.passes, found), n),
    }
