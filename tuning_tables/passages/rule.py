"""What a controller holds of a table for point sensors, and its rule as Python asks it; the rule itself is
`programs.at_pulse`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from tuning_tables.held_table import read_only
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.programs.at_pulse import at_pulse
from tuning_tables.programs.held import HeldPassages
from tuning_tables.programs.tracker import TRACKER, begin_cut
from tuning_tables.rule import readings

LIMITS = ("least_m_s", "greatest_m_s", "acceleration_m_s2", "deceleration_m_s2", "speed_tolerance", "path_tolerance_m")
"""The members that are limits of the tracker, as `PassageTable.limits` and `PlausibleMotion.numbers` have them."""

LARGEST = np.finfo(np.float32).max


def held_passages(
    switching_m_s: npt.NDArray[np.floating],
    path_m: npt.NDArray[np.floating],
    sensor: npt.NDArray[np.integer],
    deciding: npt.NDArray[np.integer],
    limits: Sequence[float] | npt.NDArray[np.floating],
    *,
    base_m: float = 0.0,
    entrance_stage: int = 0,
    before_entrance: int = 0,
) -> HeldPassages:
    """The table of these parts; arrays become read-only. What no rule looks at is 0.

    switching_m_s (M, K + 1, K); path_m, sensor, deciding (T,) as `PassageTable` has them of all passages heard. An
    infinite switching speed becomes the largest number of its sign: no credible reading is beyond either.
    """
    numbers: dict[str, Any] = {name: np.float32(limit) for name, limit in zip(LIMITS, limits, strict=True)}
    return HeldPassages(
        category=0,
        axles=0,
        stages=switching_m_s.shape[1],
        heard=len(path_m),
        passages=len(switching_m_s),
        before_entrance=before_entrance,
        entrance_stage=entrance_stage,
        initial_stage=0,
        mass_t=np.float32(0.0),
        target_m_s=np.float32(0.0),
        base_m=np.float32(base_m),
        scan_period_s=np.float32(0.0),
        computing_delay_s=np.float32(0.0),
        **numbers,
        path_m=read_only(path_m, np.float32),
        sensor=read_only(sensor, np.int64),
        deciding=read_only(deciding, np.int64),
        switching_m_s=read_only(np.clip(switching_m_s, -LARGEST, LARGEST), np.float32),
    )


def held_by(table: PassageTable) -> HeldPassages:
    """The table as a controller holds it; its category is 0, as not every one has a number."""
    return held_passages(
        table.switching_m_s, table.heard_path_m, table.heard_sensor, table.heard_passage, table.limits,
        base_m=table.sensors.base_m, entrance_stage=table.entrance_stage, before_entrance=table.before_entrance,
    )._replace(
        axles=len(table.cut.axle_offsets_m),
        initial_stage=table.initial_stage,
        mass_t=np.float32(table.cut.mass_t),
        target_m_s=np.float32(table.target_speed_m_s),
        scan_period_s=np.float32(table.sensors.scan_period_s),
        computing_delay_s=np.float32(table.sensors.computing_delay_s),
    )  # fmt: skip


def begin_tracking() -> npt.NDArray[np.float32]:
    """The state of the tracker before the first pulse of a cut.

    Returns
    -------
    ndarray
        float32 (6,): what `stage_at_pulse` brings up to date.

    Examples
    --------
    >>> from tuning_tables import begin_tracking
    >>> begin_tracking()[0]  # no passage yet
    np.float32(-1.0)
    """
    tracker = np.zeros(len(TRACKER.members), dtype=np.float32)
    begin_cut(tracker)
    return tracker


def stage_at_pulse(
    table: PassageTable,
    tracker: npt.NDArray[np.float32],
    sensor: int,
    since_s: float,
    over_base_s: float,
    stage: int,
    transient_ended: bool,
) -> int:
    """Ask a table for point sensors at the second pulse of a pair.

    To be called for every pair, of whatever sensor and axle, also while a change of stage is under way.

    Parameters
    ----------
    table
        The table.
    tracker
        The state of the cut, float32 (6,), which is brought up to date; `begin_tracking` makes it.
    sensor
        Number of the sensor, from 0.
    since_s
        Time since the pair before, s.
    over_base_s
        Time from the first pulse of the pair to the second, s.
    stage
        The stage commanded last.
    transient_ended
        Whether the change to that stage had ended by the middle between the two pulses.

    Returns
    -------
    int
        The stage to command; `stage` itself: command nothing. That is the answer to a pair that is not believed or that
        decides nothing, and to whatever cannot be true, too.

    Notes
    -----
    The rule is that of the page "Table formats", section "The step at a pulse pair", in float32; C and Structured Text
    give the same bits. The speed is the base over the time, equation (1) of [zhukovitsky-2012].

    Examples
    --------
    With `table` from the example of `PassageTable`:

    >>> from tuning_tables import begin_tracking, stage_at_pulse
    >>> tracker = begin_tracking()
    >>> stage_at_pulse(
    ...     table, tracker, 0, since_s=0.0, over_base_s=0.05, stage=0, transient_ended=True
    ... )  # 5 m/s
    1
    >>> stage_at_pulse(
    ...     table,
    ...     tracker,
    ...     1,
    ...     since_s=1.6,
    ...     over_base_s=0.0625,
    ...     stage=1,
    ...     transient_ended=True,
    ... )  # 4 m/s
    1
    """
    since, over_base = readings(since_s, over_base_s)
    return int(at_pulse(held_by(table), tracker, sensor, since, over_base, stage, transient_ended))
