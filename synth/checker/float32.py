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


def decide(
    lines: Sequence[tuple[Sequence[float] | None, Sequence[float] | None]],
    path_m: tuple[float, float],
    entrance_stage: int,
    stage: int,
    s_m: float,
    v_m_s: float,
) -> int:
    """-1 lower, 0 hold, +1 raise: the rule of docs/table-format.md for (lower, upper) `lines` of stages 0, 1, …"""
    s, v = rounded(s_m), rounded(v_m_s)
    if not (math.isfinite(s) and math.isfinite(v)) or v_m_s < 0.0 or not 0 <= stage < len(lines):
        return 0
    s = min(max(s, rounded(path_m[0])), rounded(path_m[1]))
    lower, upper = lines[stage]
    if lower is not None and v < horner(lower, s):
        return -1
    may_raise = s >= 0.0 or stage < entrance_stage
    if may_raise and upper is not None and v > horner(upper, s):
        return 1
    return 0
