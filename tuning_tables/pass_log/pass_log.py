"""Measured passes of one retarder position, row by row, as its controller logs them."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np
import numpy.typing as npt

from tuning_tables.errors import InvalidTable
from tuning_tables.pass_log.log_columns import Floats, Ints

ROWS = ("time_s", "path_m", "speed_m_s", "pressure_kpa", "stage")
PASSES = ("cut_id", "mass_t", "axles", "category", "target_m_s", "stopped_by_hand")


@dataclass(frozen=True, eq=False)
class PassLog:
    """Passes in the order in which cuts came; rows of a pass in the order of time.

    Rows, arrays (n,): `time_s` of one clock for all passes; `path_m` of the first axle behind the entrance of the
    first retarder, negative ahead of it; `speed_m_s` as measured, NaN where there was no reading; `pressure_kpa` of a
    gauge on the drive, NaN where there is none; `stage` that is commanded from this row on.
    Passes, m of them: `first_row` (m + 1,), where the rows of each begin and the last end; `cut_id`; `mass_t` of the
    cut; `axles`; `category` of its weight; `target_m_s`, the commanded exit speed, NaN where none is known;
    `stopped_by_hand`: a person took part in it.
    `path_is_independent`: the path was not summed up from the measured speed, so one can be held against the other.

    Arrays are read-only. `InvalidTable` where lengths do not fit or a pass has fewer than two rows.

    Examples
    --------
    >>> import numpy as np
    >>> from tuning_tables.pass_log import PassLog
    >>> log = PassLog(
    ...     time_s=0.1 * np.arange(6),
    ...     path_m=0.5 * np.arange(6),
    ...     speed_m_s=np.full(6, 5.0),
    ...     pressure_kpa=np.zeros(6),
    ...     stage=np.array([0, 0, 1, 1, 1, 0]),
    ...     first_row=np.array([0, 6]),
    ...     cut_id=("17",),
    ...     mass_t=np.array([52.0]),
    ...     axles=np.array([4]),
    ...     category=("С",),
    ...     target_m_s=np.array([3.0]),
    ...     stopped_by_hand=np.array([False]),
    ... )
    >>> log, log.has_gauge, log.stage[log.rows(0)]
    (PassLog(1 passes, 6 rows), True, array([0, 0, 1, 1, 1, 0]))
    """

    time_s: Floats
    path_m: Floats
    speed_m_s: Floats
    pressure_kpa: Floats
    stage: Ints
    first_row: Ints
    cut_id: tuple[str, ...]
    mass_t: Floats
    axles: Ints
    category: tuple[str, ...]
    target_m_s: Floats
    stopped_by_hand: npt.NDArray[np.bool_]
    path_is_independent: bool = True

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if isinstance(value, np.ndarray):
                value = value.view()
                value.setflags(write=False)
                object.__setattr__(self, field.name, value)
        if any(len(getattr(self, name)) != len(self.time_s) for name in ROWS):
            raise InvalidTable(f"pass log: {', '.join(ROWS)} must have one entry a row.")
        if any(len(getattr(self, name)) != len(self) for name in PASSES):
            raise InvalidTable(f"pass log: {', '.join(PASSES)} must have one entry a pass.")
        ends = self.first_row
        if len(ends) < 1 or ends[0] != 0 or ends[-1] != len(self.time_s) or not (np.diff(ends) >= 2).all():
            raise InvalidTable("pass log: first_row must rise from 0 to the number of rows, by 2 at least.")

    def __repr__(self) -> str:
        return f"PassLog({len(self)} passes, {len(self.time_s)} rows)"

    def __len__(self) -> int:
        return len(self.first_row) - 1

    @property
    def pass_of_row(self) -> Ints:
        """Number of the pass that each row belongs to, (n,)."""
        return np.repeat(np.arange(len(self)), np.diff(self.first_row))

    @property
    def has_gauge(self) -> bool:
        """Whether any row has a pressure."""
        return bool(np.isfinite(self.pressure_kpa).any())

    def rows(self, number: int) -> slice:
        """The rows of pass `number`."""
        return slice(int(self.first_row[number]), int(self.first_row[number + 1]))

    def taken(self, numbers: npt.ArrayLike) -> PassLog:
        """The passes of these numbers, in this order."""
        chosen = np.asarray(numbers, dtype=np.int64)
        counts = np.diff(self.first_row)[chosen]
        ends = np.concatenate(([0], np.cumsum(counts)))
        rows = np.repeat(self.first_row[:-1][chosen] - ends[:-1], counts) + np.arange(ends[-1])
        parts = {name: getattr(self, name)[rows] for name in ROWS}
        for name in PASSES:
            value = getattr(self, name)
            parts[name] = tuple(value[i] for i in chosen) if isinstance(value, tuple) else value[chosen]
        return replace(self, first_row=ends, **parts)
