"""Packs: some numbers that the processor works on at once, for loops that the compiler cannot vectorise by itself.

The compiler leaves a loop scalar where it reads places that it cannot foresee (a landing's value) or where outputs
could overlay inputs. With packs the kernel says itself what goes side by side. They follow the same IEEE operations in
the same order as the scalar form, so results do not depend on how wide the machine is.

A pack is loaded from, and stored to, a contiguous array at a flat index; arithmetic, comparison, `least`, `greatest`
and `choose` work lane by lane, with plain numbers standing for equal lanes. Nothing checks bounds. Below stands what
each function means, in numpy, which is also what runs without the compiler; `pack_code` has what the machine does.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from numba.extending import overload

from synth.kernels.vector import mask_code, pack_code, pack_memory
from synth.kernels.vector.numba_internals import WITHOUT_CALLBACK

SIXTEEN, EIGHT = 16, 8
"""Lanes of a pack: two packs of energies at once; energies or targets."""


def item(array, at):
    """The element of a contiguous array at flat index `at`."""
    return array.reshape(-1)[at]


def add_to(array, at, number):
    """Add a number to the element of a contiguous array at flat index `at`."""
    array.reshape(-1)[at] += number


def fetch(array, at):
    """Ask the memory for the element at flat index `at`, which will be needed soon; may be beyond the end."""


def eight(number):
    """The same number in eight lanes."""
    return np.full(EIGHT, float(number))


def load16(array, at):
    """Sixteen neighbours of a contiguous array from flat index `at` on."""
    return array.reshape(-1)[at : at + SIXTEEN].copy()


def load8(array, at):
    """Eight neighbours of a contiguous array from flat index `at` on."""
    return array.reshape(-1)[at : at + EIGHT].copy()


def store(array, at, pack):
    """Write a pack into a contiguous array from flat index `at` on, rounded to the array's type of number."""
    array.reshape(-1)[at : at + len(pack)] = pack


def gather(array, where):
    """The elements of a contiguous array at the flat indices of a pack of whole numbers."""
    return array.reshape(-1)[where]


def gather_four(array, where):
    """Of each flat index in a pack of eight the element there, and its next three: four packs."""
    return tuple(array.reshape(-1)[where + i] for i in range(4))


def scatter(array, where, mask, pack):
    """Write the lanes in which the mask holds to the flat indices of a pack of whole numbers, no two the same."""
    array.reshape(-1)[where[mask]] = pack[mask]


def keep(array, at, mask, pack):
    """Write the lanes in which the mask holds side by side, from flat index `at` on; returns how many they are."""
    kept = pack[mask]
    array.reshape(-1)[at : at + len(kept)] = kept
    return len(kept)


def choose(mask, yes, no):
    """`yes` in the lanes where the mask holds, else `no`."""
    return np.where(mask, yes, no)


def least(a, b):
    """The smaller of two in every lane."""
    return np.where(b < a, b, a)


def greatest(a, b):
    """The larger of two in every lane."""
    return np.where(b > a, b, a)


def magnitude(pack):
    """Absolute values."""
    return np.abs(pack)


def opposite(mask):
    """The lanes in which the mask does not hold."""
    return ~mask


def holds_anywhere(mask):
    """Whether the mask holds in any lane."""
    return bool(np.any(mask))


def whole(pack):
    """Rounded towards zero, as whole numbers."""
    return np.asarray(pack).astype(np.int64)


def fraction(pack):
    """Whole numbers as floating-point ones."""
    return np.asarray(pack).astype(np.float64)


def narrow(pack):
    """As float32 numbers."""
    return np.asarray(pack).astype(np.float32)


def wide(pack):
    """float32 numbers as float64."""
    return np.asarray(pack).astype(np.float64)


def root(pack):
    """Square roots."""
    return np.sqrt(pack)


def nearest(pack):
    """Rounded to whole numbers, halves to the even one."""
    return np.rint(pack)


def first_lane(mask):
    """The first lane of eight in which the mask holds, 8 if there is none."""
    return int(np.argmax(np.append(mask, True)))


def last_lane(mask, count):
    """The last of the first `count` lanes of eight in which the mask holds, −1 if there is none."""
    return int(np.max(np.flatnonzero(mask[:count]), initial=-1))


overloaded: Any = overload
compiled = partial(overloaded, jit_options=WITHOUT_CALLBACK)

compiled(item)(lambda array, at: lambda array, at: pack_memory.item(array, at))
compiled(add_to)(lambda array, at, number: lambda array, at, number: pack_memory.add_to(array, at, number))
compiled(fetch)(lambda array, at: lambda array, at: pack_memory.fetch(array, at))
compiled(eight)(lambda number: lambda number: pack_code.eight(number))
compiled(load16)(lambda array, at: lambda array, at: pack_memory.load16(array, at))
compiled(load8)(lambda array, at: lambda array, at: pack_memory.load8(array, at))
compiled(store)(lambda array, at, pack: lambda array, at, pack: pack_memory.store(array, at, pack))
compiled(gather)(lambda array, where: lambda array, where: pack_memory.gather(array, where))
compiled(gather_four)(lambda array, where: lambda array, where: pack_memory.gather_four(array, where))
compiled(choose)(lambda mask, yes, no: lambda mask, yes, no: pack_code.choose(mask, yes, no))
compiled(least)(lambda a, b: lambda a, b: pack_code.choose(b < a, b, a))
compiled(greatest)(lambda a, b: lambda a, b: pack_code.choose(b > a, b, a))
compiled(magnitude)(lambda pack: lambda pack: pack_code.choose(pack < 0.0, pack * -1.0, pack))
compiled(holds_anywhere)(lambda mask: lambda mask: pack_code.holds_anywhere(mask))
compiled(whole)(lambda pack: lambda pack: pack_code.whole(pack))
compiled(fraction)(lambda pack: lambda pack: pack_code.fraction(pack))
compiled(scatter)(
    lambda array, where, mask, pack: lambda array, where, mask, pack: pack_memory.scatter(array, where, mask, pack)
)
compiled(keep)(lambda array, at, mask, pack: lambda array, at, mask, pack: pack_memory.keep(array, at, mask, pack))
compiled(opposite)(lambda mask: lambda mask: pack_code.opposite(mask))
compiled(narrow)(lambda pack: lambda pack: pack_code.narrow(pack))
compiled(wide)(lambda pack: lambda pack: pack_code.wide(pack))
compiled(root)(lambda pack: lambda pack: pack_code.root(pack))
compiled(nearest)(lambda pack: lambda pack: pack_code.nearest(pack))
compiled(first_lane)(lambda mask: lambda mask: mask_code.first_lane(mask))
compiled(last_lane)(lambda mask, count: lambda mask, count: mask_code.last_lane(mask, count))
