"""Which passage a pair of pulses was, or none that can be believed.

A sensor tells its own number, when it was passed and how fast; it does not tell which axle. The tracker holds what it
believes of the cut: the last passage, the speed there, the time since. A pulse pair belongs to the next passage over
that sensor that the cut can have reached in that time: with the speed there and the speed now, each as far off as
allowed, it rolls farthest if it gains speed first and loses it last, and least far if it loses first and gains last.
Passages over two sensors may lie so near to each other that their pairs come in either order: if none follows, the cut
may have been at the last one before. Where there is no such passage, or the speed now cannot follow from the speed
there, the pair is not believed: nothing is commanded. So a pulse too many, too early or from a sensor out of order is
not believed, unless a cut could have made it. Where pulses are lost, a pair may be taken for an earlier passage over
the same sensor, never for a later one.

A first pulse can be false itself, and then every true one would contradict it. So a pair that is not believed is kept
as a *rival*; a pair that follows from the rival and not from what was believed makes the regulator change its mind.

The passages must be those of every axle that gives pulses: the pulses of axles that the tracker does not know follow
from each other, and make it change its mind.

What faults cost: of a dead sensor its own passages alone. A pair that is not believed costs nothing. With one axle, a
lost pair costs its own passage alone, and a pair too many at most the next one. With several axles a lost pair may set
back those that follow, until they contradict.

All arithmetic is float32, one rounding an operation. `limits` float32 (6,): least and greatest credible speed in m/s,
greatest acceleration and deceleration in m/s² (> 0), relative error allowed of a speed, error allowed of a path in m.
`state` float32 (6,): passage, speed and time since, of what is believed and of the rival; passage −1: none. Times stop
at `LONGEST_WAIT_S`. A state that cannot be (a memory lost its content) is begun anew.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

NONE: Final = -1
LONGEST_WAIT_S: Final = 1e6

Floats = npt.NDArray[np.float32]
Numbers = npt.NDArray[np.int64]


def begin_cut(state: Floats) -> None:
    """Forget the cut before: `state` (6,) as it is when a new one is expected."""
    state[:] = 0.0
    state[0] = NONE
    state[3] = NONE


def believed_passage(
    path_m: Floats, sensor_of: Numbers, limits: Floats, state: Floats, sensor: int, since_s: float, v_m_s: float
) -> int:
    """The passage that a pulse pair of `sensor` is taken for, or −1; `state` is brought up to date.

    `path_m`, `sensor_of` (T,) of all passages heard, in the order of the path, as `PassageTable.heard_path_m` and
    `heard_sensor`; `since_s`: time since the pulse pair before, of whatever sensor, or since `begin_cut`; `v_m_s`: base
    over time. Raises nothing for any number. `numba.njit` compiles this text as it is: hence one loop over both.
    """
    none, nought, longest = np.float32(NONE), np.float32(0.0), np.float32(LONGEST_WAIT_S)
    for at in range(0, 6, 3):  # comparisons so that NaN fails
        known = none <= state[at] < path_m.shape[0] and nought <= state[at + 1] <= limits[1]
        if not (known and nought <= state[at + 2] <= longest):
            state[:] = nought
            state[0], state[3] = none, none
    if not 0.0 <= since_s <= LONGEST_WAIT_S:
        return NONE
    for at in range(2, 6, 3):
        state[at] = min(state[at] + np.float32(since_s), longest)
    if not (float(limits[0]) <= v_m_s <= float(limits[1])):  # in double precision no number overflows here
        return NONE
    v, one, half, first = np.float32(v_m_s), np.float32(1.0), np.float32(0.5), NONE
    for passage in range(path_m.shape[0] - 1, -1, -1):
        first = passage if sensor_of[passage] == sensor else first
    if first == NONE:
        return NONE
    found = first if state[0] == none and state[3] == none else NONE
    reached = first
    for at in range(0, 6, 3):
        here, time = int(state[at]), state[at + 2]
        fast, slow = state[at + 1] * (one + limits[4]), state[at + 1] * (one - limits[4])
        fast_now, slow_now = v * (one + limits[4]), v * (one - limits[4])
        parted = slow_now > fast + limits[2] * time or fast_now < slow - limits[3] * time
        if found != NONE or state[at] == none or parted:
            continue
        both = limits[2] + limits[3]
        turn = min(max((fast_now - fast + limits[3] * time) / both, nought), time)
        rest = time - turn
        farthest = turn * (fast + half * limits[2] * turn) + rest * (fast_now + half * limits[3] * rest) + limits[5]
        turn = min(max((slow - slow_now + limits[2] * time) / both, nought), time)
        rest = time - turn
        if limits[3] * turn > slow:  # it may have stood in between
            turn, rest = slow / limits[3], slow_now / limits[2]
        nearest = turn * (slow - half * limits[3] * turn) + rest * (slow_now - half * limits[2] * rest) - limits[5]
        for passage in range(path_m.shape[0] - 1, -1, -1):
            way = path_m[passage] - path_m[here]
            better = passage > here or (passage < here and found == NONE)
            if better and sensor_of[passage] == sensor and nearest <= way and way <= farthest:
                found, reached = passage, max(passage, here)
    if found == NONE:
        state[3], state[4], state[5] = np.float32(first), v, nought
        return NONE
    state[0], state[1], state[2], state[3] = np.float32(reached), v, nought, none
    return found
