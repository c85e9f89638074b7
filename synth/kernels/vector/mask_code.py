"""What the machine does to find a lane of a mask, for `packs`."""

from __future__ import annotations

from numba import types

from synth.kernels.vector.numba_internals import intrinsic, ir

WORD, BIT = ir.IntType(64), ir.IntType(1)


def bits(builder, mask, pack):
    """The lanes of a mask as the lowest bits of a whole number."""
    return builder.zext(builder.bitcast(mask, ir.IntType(pack.lanes)), WORD)


@intrinsic
def first_lane(typing, mask):
    """Number of the first lane that holds."""

    def code(context, builder, sig, args):
        at_last = builder.or_(bits(builder, args[0], mask), WORD(1 << mask.lanes))
        return builder.cttz(at_last, BIT(1))

    return types.int64(mask), code


@intrinsic
def last_lane(typing, mask, count):
    """Number of the last lane that holds among the first `count`."""

    def code(context, builder, sig, args):
        beyond = builder.shl(WORD(-1), args[1])
        within = builder.and_(bits(builder, args[0], mask), builder.not_(beyond))
        return builder.sub(WORD(63), builder.ctlz(within, BIT(0)))

    return types.int64(mask, types.int64), code
