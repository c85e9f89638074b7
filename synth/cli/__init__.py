"""The command line `retarder-synth`: what the exit codes mean, and how a fault is told.

0 done; 1 ran, but a limit of the configuration is missed or not decidable, or a case has no table; 2 the input is at
fault; 3 a table or book is damaged; 70 a fault of this program; 74 a fault of the machine (a full disk, for one); 130
interrupted; 141 nobody reads what is printed. A fault is one sentence on stderr. Nothing heavy is imported here: each
command imports what it needs.
"""

from __future__ import annotations

import atexit
import gc
import os
import sys
from collections.abc import Callable, Sequence
from typing import NoReturn

OK, LIMITS_MISSED, INPUT_FAULT, DAMAGED, INTERRUPTED, PIPE_CLOSED = 0, 1, 2, 3, 130, 141
UNFORESEEN, MACHINE_FAULT = 70, 74
"""EX_SOFTWARE and EX_IOERR of sysexits.h."""

MOST_FAULTS = 50
"""Of one configuration, that are told."""

LONGEST_WORD, LONGEST_LINE = 300, 2000
"""Characters of what is told."""

TRACEBACK = "RETARDER_SYNTH_TRACEBACK"
"""Name of the environment variable that has the traceback of an unforeseen fault printed."""


def script() -> NoReturn:
    """The program `retarder-synth`.

    What it loads is there to stay, so Python need not look for garbage in it all the time.
    """
    gc.set_threshold(100_000)
    leave(main())


def leave(code: int) -> NoReturn:
    """End the process at once with `code`.

    Python is not taken apart, which lasts a fifth of a second after a tune; but all that was registered for the end is
    done, temporary directories removed among it.
    """
    atexit._run_exitfuncs()
    os._exit(code)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line (by default that of the process) and return its exit code."""
    from synth.cli.commands import run
    from synth.cli.standard_streams import standard_streams

    # See `synth.solver.one_blas_thread`; before BLAS is loaded it starts no threads at all.
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    with standard_streams() as stderr:
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
    from synth.cli.standard_streams import ReaderLeftError

    try:
        return call()
    except ReaderLeftError:  # whoever read our output has had enough of it
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return PIPE_CLOSED
    except KeyboardInterrupt:
        say("interrupted")
        return INTERRUPTED
    except OSError as fault:
        return told_of_system(fault)
    except MemoryError:
        say("there is not enough memory; free some, or raise the limit of it (ulimit -v), then run the command again")
        return MACHINE_FAULT
    except ValueError as fault:
        from plant_models import PlantError
        from synth.frame.input_error import InputError
        from tuning_tables import OtherDecisions, TableError
        from tuning_tables.errors import InvalidLog

        if not isinstance(fault, InputError | PlantError | TableError | InvalidLog):
            return told_of_unforeseen(fault)
        say_each(fault.sentences if isinstance(fault, InputError) else (str(fault),))
        damaged = isinstance(fault, TableError) and not isinstance(fault, OtherDecisions)
        return DAMAGED if damaged else INPUT_FAULT
    except Exception as fault:
        return told_of_unforeseen(fault)


def told_of_system(fault: OSError) -> int:
    """Tell of what the system has refused; the exit code."""
    from synth.frame.machine_fault import MACHINE_FAULTS

    if fault.errno is None:  # from a library, not from the system
        return told_of_unforeseen(fault)
    where = f"{fault.filename}: " if fault.filename else ""
    what = MACHINE_FAULTS.get(fault.errno)
    say(f"{where}{fault.strerror or fault}{f'; {what}' if what else ''}")
    return MACHINE_FAULT if what else INPUT_FAULT


def told_of_unforeseen(fault: Exception) -> int:
    """Tell of a fault of this program; the exit code."""
    from synth.frame.unforeseen import unforeseen

    if os.environ.get(TRACEBACK):
        import traceback

        traceback.print_exception(fault)
    say(
        f"this is a fault of retarder-synth itself: {unforeseen(fault)}; please report this line with the command and "
        f"its input ({TRACEBACK}=1 shows where it comes from)"
    )
    return UNFORESEEN


def say_each(sentences: Sequence[str]) -> None:
    """One line on stderr for each of the first sentences, and how many are left."""
    for sentence in sentences[:MOST_FAULTS]:
        say(sentence)
    if len(sentences) > MOST_FAULTS:
        say(f"and {len(sentences) - MOST_FAULTS} more faults")


def say(sentence: str) -> None:
    """One line on stderr; long words, as paths can be, and long lines show their beginning and their end."""
    from tuning_tables.excerpt import excerpt

    words = (excerpt(printable(word), LONGEST_WORD) for word in sentence.split())
    print(f"retarder-synth: {excerpt(' '.join(words), LONGEST_LINE)}", file=sys.stderr, flush=True)


def printable(text: str) -> str:
    """`text` with the codes of signs that would steer a terminal: files of others may hold such."""
    return "".join(sign if sign.isprintable() else ascii(sign)[1:-1] for sign in text)
