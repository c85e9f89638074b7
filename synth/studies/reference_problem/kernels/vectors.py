"""Sixteen float32 numbers as one value of LLVM, for kernels whose loops numba cannot turn into vector code itself.

numba must assume that any two arrays overlap, so it keeps most loops scalar. A vector loaded here lives in a register
(one of AVX-512, two of AVX, four of SSE or NEON: LLVM splits it), and `+`, `-`, `*` and the functions below work on all
sixteen lanes. Nothing checks an index: the caller keeps `index … index + 15` inside a contiguous array.
"""

from __future__ import annotations

import operator

from numba import types
from numba.extending import overload

from synth.kernels.vector.numba_internals import array_data, declared_function, intrinsic, ir, register_vector

LANES = 16


class Float32x16(types.Type):
    """numba's name for the vector; it cannot cross the border to Python."""

    def __init__(self) -> None:
        super().__init__(name="float32x16")


VECTOR = Float32x16()
FLOATS = ir.VectorType(ir.FloatType(), LANES)
_BYTES = ir.VectorType(ir.IntType(8), LANES)


register_vector(Float32x16, lambda vector: FLOATS)


def data_of(context, builder, kind, value):
    """Code for the address of the first element of an array, or of what a pointer points to; for code generators."""
    return value if isinstance(kind, types.CPointer) else array_data(context, builder, kind, value)


def _place(context, builder, kind, value, index, vector):
    return builder.bitcast(builder.gep(data_of(context, builder, kind, value), [index]), vector.as_pointer())


def load_at(builder, data, index, further):
    """Code that loads the vector at `data[index + further]`; for code generators."""
    place = builder.gep(data, [builder.add(index, ir.Constant(index.type, further))])
    return builder.load(builder.bitcast(place, FLOATS.as_pointer()), align=4)


def call_vector(builder, name, *vectors):
    """Code that calls the LLVM intrinsic `name` of vectors; for code generators."""
    called = declared_function(builder, f"llvm.{name}.v{LANES}f32", FLOATS, [FLOATS] * len(vectors))
    return builder.call(called, vectors)


@intrinsic
def pointer(typing_context, array):
    """The data of an array, to be read and written by index; valid as long as the caller holds the array.

    Inside hot loops a pointer costs nothing to hand on; an array brings its shape and its reference count along.
    """

    def generate(context, builder, signature, arguments):
        return data_of(context, builder, signature.args[0], arguments[0])

    return types.CPointer(array.dtype)(array), generate


@intrinsic
def load(typing_context, array, index):
    """Lanes `array[index], …, array[index + 15]` of a contiguous float32 array, or of what a pointer points to."""

    def generate(context, builder, signature, arguments):
        place = _place(context, builder, signature.args[0], arguments[0], arguments[1], FLOATS)
        return builder.load(place, align=4)

    return VECTOR(array, types.intp), generate


@intrinsic
def store(typing_context, array, index, vector):
    """Set `array[index], …, array[index + 15]` of a contiguous float32 array."""

    def generate(context, builder, signature, arguments):
        place = _place(context, builder, signature.args[0], arguments[0], arguments[1], FLOATS)
        builder.store(arguments[2], place, align=4)
        return context.get_dummy_value()

    return types.void(array, types.intp, VECTOR), generate


@intrinsic
def store_bytes(typing_context, array, index, vector):
    """Set sixteen elements of a contiguous uint8 array to the whole, small, not negative numbers of `vector`."""

    def generate(context, builder, signature, arguments):
        place = _place(context, builder, signature.args[0], arguments[0], arguments[1], _BYTES)
        builder.store(builder.fptoui(arguments[2], _BYTES), place, align=1)
        return context.get_dummy_value()

    return types.void(array, types.intp, VECTOR), generate


@intrinsic
def splat(typing_context, number):
    """The same number, rounded to float32, in every lane."""

    def generate(context, builder, signature, arguments):
        one = builder.insert_element(ir.Constant(FLOATS, ir.Undefined), arguments[0], ir.IntType(32)(0))
        lanes = ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)
        return builder.shuffle_vector(one, one, lanes)

    return VECTOR(types.float32), generate


@intrinsic
def lane_numbers(typing_context):
    """0, 1, …, 15."""

    def generate(context, builder, signature, arguments):
        return ir.Constant(FLOATS, [float(lane) for lane in range(LANES)])

    return VECTOR(), generate


@intrinsic
def multiply_add(typing_context, a, b, c):
    """a·b + c, rounded once where the processor can."""

    def generate(context, builder, signature, arguments):
        return call_vector(builder, "fmuladd", *arguments)

    return VECTOR(VECTOR, VECTOR, VECTOR), generate


@intrinsic
def choose(typing_context, a, b, below, above):
    """Lane by lane: `below` where a < b, else `above`."""

    def generate(context, builder, signature, arguments):
        a, b, below, above = arguments
        return builder.select(builder.fcmp_ordered("<", a, b), below, above)

    return VECTOR(VECTOR, VECTOR, VECTOR, VECTOR), generate


def _of_one(name):
    @intrinsic
    def function(typing_context, vector):
        def generate(context, builder, signature, arguments):
            return call_vector(builder, name, *arguments)

        return VECTOR(VECTOR), generate

    return function


def _of_two(emit):
    @intrinsic
    def function(typing_context, a, b):
        def generate(context, builder, signature, arguments):
            return emit(builder, *arguments)

        return VECTOR(VECTOR, VECTOR), generate

    return function


def _to_number(name):
    @intrinsic
    def function(typing_context, vector):
        def generate(context, builder, signature, arguments):
            called = declared_function(builder, f"llvm.vector.reduce.{name}.v{LANES}f32", ir.FloatType(), [FLOATS])
            return builder.call(called, arguments)

        return types.float32(VECTOR), generate

    return function


magnitude = _of_one("fabs")
root = _of_one("sqrt")
smaller = _of_two(lambda builder, a, b: builder.select(builder.fcmp_ordered("<", a, b), a, b))
larger = _of_two(lambda builder, a, b: builder.select(builder.fcmp_ordered(">", a, b), a, b))
smallest_lane = _to_number("fmin")
largest_lane = _to_number("fmax")
_sum = _of_two(lambda builder, a, b: builder.fadd(a, b))
_difference = _of_two(lambda builder, a, b: builder.fsub(a, b))
_product = _of_two(lambda builder, a, b: builder.fmul(a, b))
_quotient = _of_two(lambda builder, a, b: builder.fdiv(a, b))


def _are_vectors(a, b):
    return isinstance(a, Float32x16) and isinstance(b, Float32x16)


@overload(operator.add)
def _add(a, b):
    return (lambda a, b: _sum(a, b)) if _are_vectors(a, b) else None


@overload(operator.sub)
def _subtract(a, b):
    return (lambda a, b: _difference(a, b)) if _are_vectors(a, b) else None


@overload(operator.mul)
def _multiply(a, b):
    return (lambda a, b: _product(a, b)) if _are_vectors(a, b) else None


@overload(operator.truediv)
def _divide(a, b):
    return (lambda a, b: _quotient(a, b)) if _are_vectors(a, b) else None
