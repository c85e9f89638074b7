"""IEEE 754 binary32 arithmetic, done by storing and loading: each operation in double, then rounded once.

A double holds more than 2·24 + 2 bits, so a sum or product of two binary32 numbers rounded to double and then to
binary32 is the sum or product rounded once (Figueroa 1995): what a controller's `float` computes without fused
multiply-add.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Sequence
from typing import Final

FLOAT: Final = struct.Struct("<f")
WORD: Final = struct.Struct("<I")
LARGEST: Final = float.fromhex("0x1.fffffep+127")
HALF_ULP: Final = 2.0**-24
SMALLEST: Final = 2.0**-149

Lines = Sequence[tuple[Sequence[float] | None, Sequence[float] | None]]


def rounded(x: float) -> float:
    """The binary32 number nearest to `x`, ties to even; infinite beyond the range."""
    try:
        (value,) = FLOAT.unpack(FLOAT.pack(x))
    except OverflowError:
        return math.copysign(math.inf, x)
    return float(value)


def is_float32(x: float) -> bool:
    """Whether binary32 holds the finite number `x` exactly."""
    return math.isfinite(x) and rounded(x) == x


def bits(x: float) -> int:
    """The 32 bits of `x` rounded to binary32; infinity beyond the range."""
    (word,) = WORD.unpack(FLOAT.pack(rounded(x)))
    return int(word)


def from_bits(word: int) -> float:
    """The binary32 number with these 32 bits."""
    (value,) = FLOAT.unpack(WORD.pack(word))
    return float(value)


def above(x: float) -> float:
    """The next binary32 number above the finite binary32 number `x`."""
    if x == 0.0:
        return SMALLEST
    return from_bits(bits(x) + (1 if x > 0.0 else -1))


def below(x: float) -> float:
    """The next binary32 number below the finite binary32 number `x`."""
    return -above(-x)


def horner(line: Sequence[float], s: float) -> float:
    """The polynomial with ascending `line` at `s`, both binary32: from the highest power down, each step rounded."""
    value = line[-1]
    for coefficient in line[-2::-1]:
        value = rounded(rounded(value * s) + coefficient)
    return value


def rise(slope: float, own_kpa: float, kpa: float) -> float:
    """What the pressure `kpa` adds to a line of the stage at `own_kpa`, all binary32; two operations, both rounded."""
    return rounded(slope * rounded(kpa - own_kpa))


def rises(
    slopes: Sequence[tuple[float | None, float | None]],
    pressures_kpa: Sequence[float],
    top_stage: int,
    stage: int,
    kpa: float,
) -> tuple[float, float]:
    """What the pressure `kpa` of the gauge adds to the lower and to the upper line of `stage`, m/s, for `decide`.

    It is clamped from the pressure of stage 0 to that of `top_stage`, the highest stage that the table raises to. Where
    the gauge tells no binary32 number, or there is no such stage, nothing is added.
    """
    if not (0 <= stage < len(pressures_kpa) and -LARGEST <= kpa <= LARGEST):
        return 0.0, 0.0
    clamped = min(max(rounded(kpa), rounded(pressures_kpa[0])), rounded(pressures_kpa[top_stage]))
    own_kpa = rounded(pressures_kpa[stage])
    lower, upper = (0.0 if slope is None else rise(slope, own_kpa, clamped) for slope in slopes[stage])
    return lower, upper


def decide(
    lines: Lines,
    path_m: tuple[float, float],
    entrance_stage: int,
    farthest: int,
    stage: int,
    s_m: float,
    v_m_s: float,
    rise_m_s: tuple[float, float] = (0.0, 0.0),
) -> int:
    """The stage to command: the rule of docs/reference/table-format.md for (lower, upper) `lines` of stages 0, 1, …

    `farthest`: how many stages one command may go. `rise_m_s`: what the pressure adds to the two lines of the stage, as
    `rises` gives it; 0 for a table without slopes.
    """
    s, v = rounded(s_m), rounded(v_m_s)
    if not (math.isfinite(s) and math.isfinite(v)) or v_m_s < 0.0 or not 0 <= stage < len(lines):
        return stage
    s = min(max(s, rounded(path_m[0])), rounded(path_m[1]))
    direction = direction_at(lines, entrance_stage, stage, s, v, rise_m_s)
    wanted = stage + direction
    while abs(wanted - stage) < farthest and direction:
        if direction_at(lines, entrance_stage, wanted, s, v, rise_m_s) != direction:
            break
        wanted += direction
    return wanted


def direction_at(
    lines: Lines, entrance_stage: int, stage: int, s: float, v: float, rise_m_s: tuple[float, float]
) -> int:
    """-1 lower, 0 hold, +1 raise at one stage; `s`, clamped, and `v` binary32."""
    lower, upper = lines[stage]
    if lower is not None and v < rounded(horner(lower, s) + rise_m_s[0]):
        return -1
    may_raise = s >= 0.0 or stage < entrance_stage
    return int(may_raise and upper is not None and v > rounded(horner(upper, s) + rise_m_s[1]))
