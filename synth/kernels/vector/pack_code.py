"""What the machine does for `packs`: numba types for vectors of LLVM, and the instructions of every function."""

from __future__ import annotations

import operator

from numba import types

from synth.kernels.vector.numba_internals import (
    declared_function,
    infer_operation,
    intrinsic,
    ir,
    lower_operation,
    register_vector,
)

MACHINE_TYPES = {
    types.boolean: ir.IntType(1),
    types.int64: ir.IntType(64),
    types.float32: ir.FloatType(),
    types.float64: ir.DoubleType(),
}


class Pack(types.Type):
    """`lanes` numbers of a scalar numba type side by side."""

    def __init__(self, element, lanes):
        self.element, self.lanes = element, lanes
        super().__init__(name=f"Pack({element}, {lanes})")


def machine_type(element):
    """LLVM's type of a lane."""
    return MACHINE_TYPES[element]


register_vector(Pack, lambda pack: ir.VectorType(machine_type(pack.element), pack.lanes))


def suffix(element, lanes):
    """LLVM's name of a vector at the end of a function's name."""
    return f"v{lanes}{'f' if isinstance(element, types.Float) else 'i'}{element.bitwidth}"


def lanes_of(context, builder, value, given, wanted):
    """`value` of numba type `given` as a vector of the pack type `wanted`, plain numbers in every lane."""
    if isinstance(given, Pack):
        return value
    scalar = context.cast(builder, value, given, wanted.element)
    vector = ir.Constant(ir.VectorType(scalar.type, wanted.lanes), ir.Undefined)
    vector = builder.insert_element(vector, scalar, ir.Constant(ir.IntType(32), 0))
    zeros = ir.Constant(ir.VectorType(ir.IntType(32), wanted.lanes), [0] * wanted.lanes)
    return builder.shuffle_vector(vector, vector, zeros)


def is_number(given):
    """Whether a numba type is a plain number (a literal counts)."""
    return isinstance(types.unliteral(given), types.Number)


def common_pack(a, b):
    """The pack type of an operation on `a` and `b`, None if there is none."""
    if isinstance(a, Pack) and (a == b or is_number(b)):
        return a
    if isinstance(b, Pack) and is_number(a):
        return b
    return None


ARITHMETIC = {
    operator.add: ("fadd", "add"),
    operator.sub: ("fsub", "sub"),
    operator.mul: ("fmul", "mul"),
    operator.truediv: ("fdiv", None),
}
COMPARISON = {operator.lt: "<", operator.le: "<=", operator.gt: ">", operator.ge: ">=", operator.eq: "=="}


def register_arithmetic(symbol, names):
    """Teach numba the operation `symbol` between packs, and between packs and numbers."""
    infer_operation(symbol, common_pack)

    def lower(context, builder, sig, args):
        pack = sig.return_type
        a, b = (lanes_of(context, builder, x, t, pack) for x, t in zip(args, sig.args, strict=True))
        return getattr(builder, names[0 if isinstance(pack.element, types.Float) else 1])(a, b)

    register_lowering(symbol, lower)


def register_comparison(symbol, sign):
    """Teach numba a comparison, lane by lane."""

    def mask(a, b):
        pack = common_pack(a, b)
        return None if pack is None else Pack(types.boolean, pack.lanes)

    infer_operation(symbol, mask)

    def lower(context, builder, sig, args):
        pack = common_pack(*sig.args)
        a, b = (lanes_of(context, builder, x, t, pack) for x, t in zip(args, sig.args, strict=True))
        compare = builder.fcmp_ordered if isinstance(pack.element, types.Float) else builder.icmp_signed
        return compare(sign, a, b)

    register_lowering(symbol, lower)


def register_lowering(symbol, lower):
    """Use `lower` for every combination of packs and numbers."""
    for pair in ((Pack, Pack), (Pack, types.Number), (types.Number, Pack)):
        lower_operation(symbol, pair, lower)


for each, instructions in ARITHMETIC.items():
    register_arithmetic(each, instructions)
for each, comparison in COMPARISON.items():
    register_comparison(each, comparison)
for each in (operator.and_, operator.or_):
    register_arithmetic(each, (None, each.__name__))


@intrinsic
def eight(typing, number):
    """A number in eight lanes."""

    pack = Pack(types.float64, 8)

    def code(context, builder, sig, args):
        return lanes_of(context, builder, args[0], sig.args[0], pack)

    return pack(number), code


@intrinsic
def choose(typing, mask, yes, no):
    """Lane by lane one of two."""

    pack = common_pack(yes, no) or Pack(types.float64, mask.lanes)

    def code(context, builder, sig, args):
        a, b = (lanes_of(context, builder, x, t, pack) for x, t in zip(args[1:], sig.args[1:], strict=True))
        return builder.select(args[0], a, b)

    return pack(mask, yes, no), code


@intrinsic
def holds_anywhere(typing, mask):
    """Whether a mask holds in a lane."""

    def code(context, builder, sig, args):
        bits = builder.bitcast(args[0], ir.IntType(mask.lanes))
        return builder.icmp_unsigned("!=", bits, ir.Constant(bits.type, 0))

    return types.boolean(mask), code


def conversion(instruction, element):
    """The intrinsic that converts every lane."""

    @intrinsic
    def convert(typing, pack):
        wanted = Pack(element, pack.lanes)

        def code(context, builder, sig, args):
            return getattr(builder, instruction)(args[0], ir.VectorType(machine_type(element), pack.lanes))

        return wanted(pack), code

    return convert


def by_llvm(name):
    """The intrinsic that applies a function of LLVM to every lane."""

    @intrinsic
    def apply(typing, pack):
        def code(context, builder, sig, args):
            called = f"llvm.{name}.{suffix(pack.element, pack.lanes)}"
            return builder.call(declared_function(builder, called, args[0].type, [args[0].type]), args)

        return pack(pack), code

    return apply


@intrinsic
def opposite(typing, mask):
    """The lanes where a mask does not hold."""

    def code(context, builder, sig, args):
        return builder.not_(args[0])

    return mask(mask), code


whole, fraction = conversion("fptosi", types.int64), conversion("sitofp", types.float64)
narrow, wide = conversion("fptrunc", types.float32), conversion("fpext", types.float64)
root, nearest = by_llvm("sqrt"), by_llvm("rint")
