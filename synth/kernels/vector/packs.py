"""Packs: some numbers that the processor works on at once, for loops that the compiler cannot vectorise by itself.

The compiler leaves a loop scalar where it reads places that it cannot foresee (a landing's value) or where outputs
could overlay inputs. With packs the kernel says itself what goes side by side. They follow the same IEEE operations in
the same order as the scalar form, so results do not depend on how wide the machine is.

A pack is loaded from, and stored to, a contiguous array at a flat index; arithmetic, comparison, `least`, `greatest`
and `choose` work lane by lane, with plain numbers standing for equal lanes. Nothing checks bounds. Below stands what
each function means, in numpy: it is what runs without the compiler, and what numba compiles where its inside is left
alone (`kernels.plain`). `pack_code` has what the machine does.
"""

from __future__ import annotations

import numpy as np
from numba.extending import register_jitable

from synth.kernels.plain import IS_PLAIN

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
    flat = array.reshape(-1)
    return flat[where], flat[where + 1], flat[where + 2], flat[where + 3]


def scatter(array, where, mask, pack):
    """Write the lanes in which the mask holds to the flat indices of a pack of whole numbers, no two the same."""
    flat = array.reshape(-1)
    for lane in range(len(mask)):
        if mask[lane]:
            flat[where[lane]] = pack[lane]


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
    lane = 0
    while lane < len(mask) and not mask[lane]:
        lane += 1
    return lane


def last_lane(mask, count):
    """The last of the first `count` lanes of eight in which the mask holds, −1 if there is none."""
    lane = count - 1
    while lane >= 0 and not mask[lane]:
        lane -= 1
    return lane


DEFINITIONS = (
    item,
    add_to,
    fetch,
    eight,
    load16,
    load8,
    store,
    gather,
    gather_four,
    scatter,
    keep,
    choose,
    least,
    greatest,
    magnitude,
    opposite,
    holds_anywhere,
    whole,
    fraction,
    narrow,
    wide,
    root,
    nearest,
    first_lane,
    last_lane,
)

if IS_PLAIN:
    for definition in DEFINITIONS:
        register_jitable(definition)
else:
    from synth.kernels.vector.pack_overloads import overload_all

    overload_all({each.__name__: each for each in DEFINITIONS})
