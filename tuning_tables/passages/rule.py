"""The rule for point sensors as Python asks it; the rule itself is `programs.at_pulse`."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tuning_tables.passages.held_passages import held_by
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.programs.at_pulse import at_pulse
from tuning_tables.programs.tracker import TRACKER, begin_cut
from tuning_tables.rule import readings


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
