"""The command line `retarder-synth`: what the exit codes mean, and how a fault is told.

0 done; 1 ran, but a limit of the configuration is missed or not decidable, or a case has no table; 2 the input is at
fault; 3 a table or book is damaged; 70 a fault of this program; 74 a fault of the machine (a full disk, for one); 130
interrupted; 141 nobody reads what is printed. A fault is one sentence on stderr. Nothing heavy is imported here: each
command imports what it needs.
"""

from __future__ import annotations

import contextlib
import ctypes
import gc
import os
import sys
from collections.abc import Callable, Sequence
from typing import NoReturn

from synth.frame.terminal.telling import (
    DAMAGED,
    INPUT_FAULT,
    LIMITS_MISSED,
    MACHINE_FAULT,
    OK,
    PIPE_CLOSED,
    UNFORESEEN,
    leave,
    say,
    say_each,
)

M_TRIM_THRESHOLD, M_MMAP_MAX, M_ARENA_MAX = -1, -4, -8
"""Names of settings of memory in glibc's malloc.h."""

MIB = 2**20

TRACEBACK = "RETARDER_SYNTH_TRACEBACK"
"""Name of the environment variable that has the traceback of an unforeseen fault printed."""


def script() -> NoReturn:
    """The program `retarder-synth`.

    What it loads is there to stay, so Python need not look for garbage in it all the time.
    """
    gc.set_threshold(100_000)
    keep_freed_memory()
    leave(main())


def keep_freed_memory() -> None:
    """Have glibc keep the memory of freed arrays for the next ones; another C library is left alone.

    By itself it gives large arrays back at once, and fetches the next ones page by page from the system; in a thread
    but the first, it gives back whatever is freed.
    """
    if sys.platform != "linux":
        return
    with contextlib.suppress(AttributeError):  # of a C library that has no such function
        mallopt = ctypes.CDLL(None).mallopt
        mallopt(M_MMAP_MAX, 0)
        mallopt(M_ARENA_MAX, 1)
        mallopt(M_TRIM_THRESHOLD, 512 * MIB)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line (by default that of the process) and return its exit code."""
    from synth.frame.terminal.interrupt import interruptible
    from synth.frame.terminal.standard_streams import standard_streams

    # See `synth.solver.descent`; before BLAS is loaded it starts no threads at all.
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    # No other package changes what a file may say, and nobody waits while all that are installed are asked for plugins.
    os.environ["PYDANTIC_DISABLE_PLUGINS"] = "__all__"
    with interruptible(), standard_streams() as stderr:
        from synth.cli.commands import run

        code = told(lambda: run(sys.argv[1:] if arguments is None else list(arguments)))
        flushed = told(flush_stdout)
        if code in (OK, LIMITS_MISSED):
            # A whole result may have been left all the same: nothing ends for want of a reader of its progress.
            return flushed or (PIPE_CLOSED if stderr.reader_left else code)
        return code


def flush_stdout() -> int:
    """Have what was printed out."""
    sys.stdout.flush()
    return OK


def told(call: Callable[[], int]) -> int:
    """The exit code of `call()`, or that of the fault it raised, told in one sentence."""
    from synth.frame.terminal.standard_streams import ReaderLeftError

    try:
        return call()
    except ReaderLeftError:  # whoever read our output has had enough of it
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return PIPE_CLOSED
    except OSError as fault:
        return told_of_system(fault)
    except MemoryError:
        say("there is not enough memory; free some, or raise the limit of it (ulimit -v), then run the command again")
        return MACHINE_FAULT
    except ValueError as fault:
        from synth.frame.faults import InputError

        if isinstance(fault, InputError):
            say_each(fault.sentences)
            return INPUT_FAULT
        return told_of_value(fault)
    except Exception as fault:
        return told_of_unforeseen(fault)


def told_of_value(fault: ValueError) -> int:
    """Tell of a value that plant or tables refuse; the exit code."""
    from plant_models import PlantError
    from tuning_tables import OtherKind, TableError
    from tuning_tables.errors import InvalidLog

    if not isinstance(fault, PlantError | TableError | InvalidLog):
        return told_of_unforeseen(fault)
    say(str(fault))
    damaged = isinstance(fault, TableError) and not isinstance(fault, OtherKind)
    return DAMAGED if damaged else INPUT_FAULT


def told_of_system(fault: OSError) -> int:
    """Tell of what the system has refused; the exit code."""
    from synth.frame.faults import MACHINE_FAULTS

    if fault.errno is None:  # from a library, not from the system
        return told_of_unforeseen(fault)
    where = f"{fault.filename}: " if fault.filename else ""
    what = MACHINE_FAULTS.get(fault.errno)
    say(f"{where}{fault.strerror or fault}{f'; {what}' if what else ''}")
    return MACHINE_FAULT if what else INPUT_FAULT


def told_of_unforeseen(fault: Exception) -> int:
    """Tell of a fault of this program; the exit code."""
    from synth.frame.faults import unforeseen

    if os.environ.get(TRACEBACK):
        import traceback

        traceback.print_exception(fault)
    say(
        f"this is a fault of retarder-synth itself: {unforeseen(fault)}; please report this line with the command and "
        f"its input ({TRACEBACK}=1 shows where it comes from)"
    )
    return UNFORESEEN
