"""Chunks of work that threads of one kernel take from each other, phase by phase, without a lock.

A phase is over when every chunk is done; which thread did it does not matter. A thread takes its own
chunks first (they are in its cache), then those that the others have not taken yet. So a thread that starts late, or
never, costs time but hangs nobody: the others do its part. Waiting spins for a while and then yields, for on a shared
machine the thread that one waits for may need this very processor.

`taken` (phases, threads, 8) and `done` (phases, 8) are int64 counters, zero at the start, one cache line each.
"""

from __future__ import annotations

from numba import njit, types

from synth.kernels.vector.numba_internals import array_data, declared_function, intrinsic, ir

SPINS_BEFORE_YIELD = 2000


def _place(context, builder, array_type, array, index):
    return builder.gep(array_data(context, builder, array_type, array), [index])


@intrinsic
def fetch_add(typing_context, counters, index, amount):
    """Add `amount` to `counters[index]` at one stroke and return what was there; orders memory both ways."""

    def generate(context, builder, signature, arguments):
        place = _place(context, builder, signature.args[0], *arguments[:2])
        return builder.atomic_rmw("add", place, arguments[2], "seq_cst")

    return types.int64(counters, types.intp, types.int64), generate


@intrinsic
def fetch(typing_context, counters, index):
    """`counters[index]` as the other threads have left it, with all that they wrote before."""

    def generate(context, builder, signature, arguments):
        place = _place(context, builder, signature.args[0], *arguments)
        return builder.load_atomic(place, "acquire", align=8)

    return types.int64(counters, types.intp), generate


@intrinsic
def yield_processor(typing_context):
    """POSIX sched_yield: let another thread run."""

    def generate(context, builder, signature, arguments):
        return builder.call(declared_function(builder, "sched_yield", ir.IntType(32), []), [])

    return types.int32(), generate


@njit(cache=True, nogil=True, error_model="numpy")
def take(taken, phase, thread, threads, chunks):
    """Next chunk of this phase for `thread`, or −1. Thread t owns every chunk t + k·threads."""
    for turn in range(threads):
        owner = (thread + turn) % threads
        at = (phase * threads + owner) * 8
        if turn > 0 and owner + fetch(taken, at) * threads >= chunks:
            continue
        chunk = owner + fetch_add(taken, at, 1) * threads
        if chunk < chunks:
            return chunk
    return -1


@njit(cache=True, nogil=True, error_model="numpy")
def finish(done, phase):
    """Say that one chunk of the phase is done; what was written for it is then seen by whoever waited."""
    fetch_add(done, phase * 8, 1)


@njit(cache=True, nogil=True, error_model="numpy")
def wait(done, phase, chunks):
    """Return when all chunks of the phase are done."""
    spins = 0
    while fetch(done, phase * 8) < chunks:
        spins += 1
        if spins > SPINS_BEFORE_YIELD:
            yield_processor()
