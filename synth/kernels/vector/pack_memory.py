"""How packs are loaded and stored: the instructions of those functions of `packs` that take an array."""

from __future__ import annotations

from numba import types

from synth.kernels.vector.numba_internals import array_data, declared_function, intrinsic, ir
from synth.kernels.vector.pack_code import Pack, machine_type, suffix

LANE = ir.IntType(32)
"""The type of a lane's number."""


def addresses(context, builder, array_type, array, at):
    """Pointer to element `at` of a contiguous array, in flat order."""
    return builder.gep(array_data(context, builder, array_type, array), [at])


def loading(lanes):
    """The intrinsic that loads `lanes` neighbours."""

    @intrinsic
    def load(typing, array, at):
        def code(context, builder, sig, args):
            vector = ir.VectorType(machine_type(sig.args[0].dtype), lanes)
            pointer = addresses(context, builder, sig.args[0], *args)
            return builder.load(builder.bitcast(pointer, vector.as_pointer()), align=array.dtype.bitwidth // 8)

        return Pack(array.dtype, lanes)(array, types.intp), code

    return load


@intrinsic
def item(typing, array, at):
    """Read one element."""

    def code(context, builder, sig, args):
        return builder.load(addresses(context, builder, sig.args[0], *args))

    return array.dtype(array, types.intp), code


@intrinsic
def add_to(typing, array, at, number):
    """Add to one element."""

    def code(context, builder, sig, args):
        place = addresses(context, builder, sig.args[0], *args[:2])
        builder.store(builder.fadd(builder.load(place), args[2]), place)
        return context.get_dummy_value()

    return types.void(array, types.intp, types.float64), code


@intrinsic
def fetch(typing, array, at):
    """Ask the cache for one element."""

    def code(context, builder, sig, args):
        place = addresses(context, builder, sig.args[0], *args)
        place = builder.bitcast(place, ir.IntType(8).as_pointer())
        kinds = [place.type, *[ir.IntType(32)] * 3]
        function = declared_function(builder, "llvm.prefetch.p0", ir.VoidType(), kinds)
        builder.call(function, [place, *(ir.IntType(32)(number) for number in (0, 3, 1))])  # to read, to keep, data
        return context.get_dummy_value()

    return types.void(array, types.intp), code


@intrinsic
def store(typing, array, at, pack):
    """Write a pack, in the type of the array."""

    def code(context, builder, sig, args):
        pointer = addresses(context, builder, sig.args[0], *args[:2])
        lanes = args[2]
        if (pack.element, array.dtype) == (types.float64, types.float32):
            lanes = builder.fptrunc(lanes, ir.VectorType(ir.FloatType(), pack.lanes))
        builder.store(lanes, builder.bitcast(pointer, lanes.type.as_pointer()), align=array.dtype.bitwidth // 8)
        return context.get_dummy_value()

    return types.void(array, types.intp, pack), code


def masked(builder, name, result, *arguments):
    """Call LLVM's function `masked.NAME`."""
    kinds = [argument.type for argument in arguments]
    return builder.call(declared_function(builder, f"llvm.masked.{name}", result, kinds), arguments)


def lane_addresses(context, builder, array_type, array, where, lanes):
    """One after the other the pointers to the elements of a contiguous array at a pack of flat indices.

    What they load is put side by side then. An AMD EPYC (Zen 4) takes longer by its own instruction for that: passes of
    the closed loop take 0.82 to 0.86 of the time that they take with it, and gradients with four neighbours in one load
    (`gather_four`) 0.87 to 0.95. No other processor was measured.
    """
    data = array_data(context, builder, array_type, array)
    return [builder.gep(data, [builder.extract_element(where, LANE(lane))]) for lane in range(lanes)]


@intrinsic
def gather(typing, array, where):
    """Read a pack from scattered places."""

    def code(context, builder, sig, args):
        found = ir.Constant(ir.VectorType(machine_type(array.dtype), where.lanes), ir.Undefined)
        for lane, place in enumerate(lane_addresses(context, builder, sig.args[0], args[0], args[1], where.lanes)):
            found = builder.insert_element(found, builder.load(place), LANE(lane))
        return found

    return Pack(array.dtype, where.lanes)(array, where), code


@intrinsic
def gather_four(typing, array, where):
    """Read four neighbours for each of eight lanes: the first ones as a pack, the second ones, and so on."""
    four = ir.VectorType(machine_type(array.dtype), 4)

    def code(context, builder, sig, args):
        def joined(a, b, lanes):
            return builder.shuffle_vector(a, b, ir.Constant(ir.VectorType(LANE, 8), list(lanes)))

        places = lane_addresses(context, builder, sig.args[0], args[0], args[1], 8)
        width = array.dtype.bitwidth // 8
        rows = [builder.load(builder.bitcast(place, four.as_pointer()), align=width) for place in places]
        # Transposed: two rows in a vector, then of four rows two columns in a vector, then of eight rows one column.
        twos = [joined(rows[i], rows[i + 1], range(8)) for i in range(0, 8, 2)]
        columns = []
        for i in (0, 2):
            pairs = [(twos[k], twos[k + 1], (i, i + 4, i + 8, i + 12, i + 1, i + 5, i + 9, i + 13)) for k in (0, 2)]
            upper, lower = (joined(*pair) for pair in pairs)
            columns += [joined(upper, lower, (*range(k, k + 4), *range(k + 8, k + 12))) for k in (0, 4)]
        return context.make_tuple(builder, sig.return_type, columns)

    return types.UniTuple(Pack(array.dtype, 8), 4)(array, where), code


@intrinsic
def scatter(typing, array, where, mask, pack):
    """Write the lanes of a mask to scattered places."""

    def code(context, builder, sig, args):
        data = array_data(context, builder, sig.args[0], args[0])
        places = builder.gep(data, [args[1]], source_etype=machine_type(array.dtype))
        # llvmlite knows no vector of indices here. By other means the machine would work out every address by itself.
        places.type = ir.VectorType(data.type, where.lanes)
        width = ir.IntType(32)(array.dtype.bitwidth // 8)
        name = f"scatter.{suffix(array.dtype, where.lanes)}.v{where.lanes}p0"
        masked(builder, name, ir.VoidType(), args[3], places, width, args[2])
        return context.get_dummy_value()

    return types.void(array, where, mask, pack), code


@intrinsic
def keep(typing, array, at, mask, pack):
    """Write the lanes of a mask side by side, and count them."""

    def code(context, builder, sig, args):
        pointer = addresses(context, builder, sig.args[0], *args[:2])
        masked(builder, f"compressstore.{suffix(array.dtype, mask.lanes)}", ir.VoidType(), args[3], pointer, args[2])
        bits = builder.bitcast(args[2], ir.IntType(mask.lanes))
        return builder.zext(builder.ctpop(bits), ir.IntType(64))

    return types.int64(array, types.intp, mask, pack), code


load16, load8 = loading(16), loading(8)
