"""Kernel that turns random words into standard normal numbers, two a word (Box and Muller), in vector registers.

Logarithm, sine and cosine are the float32 polynomials of the Cephes library (S. L. Moshier: logf, sinf, cosf), written
out because a call would leave the vector registers. Only +, −, ·, / and the root are used, each rounded by itself: the
numbers are the same to the bit on every processor.
"""

from __future__ import annotations

import math

import numpy as np

from synth.kernels.compiling import borrowing

f32 = np.float32

BELOW_ROOT_HALF = 0x3F3504F3
"""Bits of sqrt(1/2) in float32: from here on, a mantissa and its exponent are split."""

RADIANS = math.pi / 2.0**33
"""A quarter turn, π/2, is 2^32 of these."""


@borrowing
def normal_pairs(words, first, second):
    """Independent standard normal numbers `first` and `second` float32 from random `words` uint64, all (n,).

    The upper half u of a word is the radius, sqrt(−2 ln((u + ½) / 2³²)) ≤ 6.8; the lower half is the angle: two bits
    for the quadrant and thirty within it.
    """
    for i in range(words.shape[0]):
        word = words[i]
        uniform = f32(np.uint32(word >> np.uint64(32))) + f32(0.5)
        # uniform = mantissa · 2^exponent, mantissa from sqrt(1/2) to sqrt(2); ln by a polynomial in mantissa − 1
        bits = np.float32(uniform).view(np.int32)
        exponent = np.int32((bits - BELOW_ROOT_HALF) >> 23)
        x = np.int32(bits - (exponent << 23)).view(np.float32) - f32(1.0)
        y = f32(7.0376836292e-2)
        y = y * x - f32(1.1514610310e-1)
        y = y * x + f32(1.1676998740e-1)
        y = y * x - f32(1.2420140846e-1)
        y = y * x + f32(1.4249322787e-1)
        y = y * x - f32(1.6668057665e-1)
        y = y * x + f32(2.0000714765e-1)
        y = y * x - f32(2.4999993993e-1)
        y = y * x + f32(3.3333331174e-1)
        square = x * x
        logarithm = x + (y * x * square - f32(0.5) * square) + f32(np.int32(exponent - 32)) * f32(math.log(2.0))
        logarithm = logarithm if logarithm < f32(0.0) else f32(0.0)
        radius = math.sqrt(f32(-2.0) * logarithm)
        angle = np.int32(np.uint32(word))
        quadrant = angle >> 30
        turn = f32(np.int32(angle << 2)) * f32(RADIANS)  # −π/4 to π/4
        square = turn * turn
        sine = f32(-1.9515295891e-4) * square + f32(8.3321608736e-3)
        sine = (sine * square - f32(1.6666654611e-1)) * square * turn + turn
        cosine = f32(2.443315711809948e-5) * square - f32(1.388731625493765e-3)
        cosine = (cosine * square + f32(4.166664568298827e-2)) * square * square - f32(0.5) * square + f32(1.0)
        radius = -radius if (quadrant & 2) != 0 else radius
        across = (quadrant & 1) != 0
        first[i] = radius * (-sine if across else cosine)
        second[i] = radius * (cosine if across else sine)


@borrowing
def normal_rows(words, rows, memory):
    """Standard normal `rows` (n, m) float32; columns 2j and 2j + 1 are the pairs of `words` (n·j …) uint64.

    `memory` (2, t) float32: t rows are filled at a time, so that they stay in the cache.
    """
    n, together = rows.shape[0], memory.shape[1]
    for start in range(0, n, together):
        count = min(together, n - start)
        for pair in range((rows.shape[1] + 1) // 2):
            place, column = pair * n + start, 2 * pair
            normal_pairs(words[place : place + count], memory[0], memory[1])
            for k in range(count):
                rows[start + k, column] = memory[0, k]
            if column + 1 < rows.shape[1]:
                for k in range(count):
                    rows[start + k, column + 1] = memory[1, k]
