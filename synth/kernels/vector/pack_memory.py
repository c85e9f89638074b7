"""How packs are loaded and stored: the instructions of those functions of `packs` that take an array."""

from __future__ import annotations

from numba import types

from synth.kernels.vector.numba_internals import array_data, declared_function, intrinsic, ir
from synth.kernels.vector.pack_code import Pack, machine_type, suffix


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


def spread(context, builder, array_type, array, where, lanes):
    """Pointers to the elements of a contiguous array at a pack of flat indices, the machine type of what lies there."""
    data = array_data(context, builder, array_type, array)
    element = machine_type(array_type.dtype)
    places = builder.gep(data, [where], source_etype=element)
    # llvmlite knows no vector of indices here. By other means the machine would work out every address by itself.
    places.type = ir.VectorType(data.type, lanes)
    return places, element


def masked(builder, name, result, *arguments):
    """Call LLVM's function `masked.NAME`."""
    kinds = [argument.type for argument in arguments]
    return builder.call(declared_function(builder, f"llvm.masked.{name}", result, kinds), arguments)


@intrinsic
def gather(typing, array, where):
    """Read a pack from scattered places."""

    def code(context, builder, sig, args):
        places, element = spread(context, builder, sig.args[0], args[0], args[1], where.lanes)
        found = ir.VectorType(element, where.lanes)
        every = ir.Constant(ir.VectorType(ir.IntType(1), where.lanes), [1] * where.lanes)
        width = ir.IntType(32)(array.dtype.bitwidth // 8)
        name = f"gather.{suffix(array.dtype, where.lanes)}.v{where.lanes}p0"
        return masked(builder, name, found, places, width, every, ir.Constant(found, ir.Undefined))

    return Pack(array.dtype, where.lanes)(array, where), code


@intrinsic
def scatter(typing, array, where, mask, pack):
    """Write the lanes of a mask to scattered places."""

    def code(context, builder, sig, args):
        places, _ = spread(context, builder, sig.args[0], args[0], args[1], where.lanes)
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
