"""What simulated passes leave behind; nothing here needs a kernel."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays

TRACE_FACTORS = (0.8, 1.0, 1.2)
"""Friction factors ξ_cut of the few passes that are shown of every table, event by event."""


@frozen_arrays
class ExitSample:
    """How n passes ended, arrays of shape (n,); a stalled pass has exit speed 0.

    `weight`: how many cuts each pass stands for (`RandomPasses`).
    """

    exit_speed_m_s: Floats
    stalled: Bools
    switchings: NDArray[np.int32]
    transit_time_s: Floats
    weight: Floats

    def __repr__(self) -> str:
        return f"ExitSample({len(self)} passes)"

    def __len__(self) -> int:
        return len(self.exit_speed_m_s)


@frozen_arrays
class PassTrace:
    """One pass, event by event; the last of n events is the end of the pass.

    Attributes
    ----------
    time_s
        Time, s, (n,).
    path_m
        Path of the first axle, m, (n,).
    speed_m_s
        True speed, m/s, (n,).
    overpressure_kpa
        max(0, P − P0), kPa, (n,); it holds from an event to the next.
    stage
        Stage commanded, (n,); it holds from an event to the next.
    measured_m_s
        What the sensor told, m/s, (n,); NaN where the regulator did not look at it.
    stalled
        Whether the cut came to a stand.

    Examples
    --------
    With `problem` and `table` from the example of `tabulate`:

    >>> import synth
    >>> one = synth.trace(table, problem)
    >>> one.path_m.shape == one.speed_m_s.shape == one.stage.shape
    True
    """

    time_s: Floats
    path_m: Floats
    speed_m_s: Floats
    overpressure_kpa: Floats
    stage: Ints
    measured_m_s: Floats
    stalled: bool

    def __repr__(self) -> str:
        end = "stands" if self.stalled else f"leaves with {self.exit_speed_m_s:.3f} m/s"
        return f"PassTrace({len(self.time_s)} events: {end} after {self.time_s[-1] - self.time_s[0]:.1f} s)"

    @property
    def exit_speed_m_s(self) -> float:
        """Speed at the exit; 0 after a stall."""
        return 0.0 if self.stalled else float(self.speed_m_s[-1])
