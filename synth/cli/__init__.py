"""The command line `retarder-synth`: what the exit codes mean, and how a fault is told.

0 done; 1 ran, but a limit of the configuration is not kept; 2 the input is at fault; 3 a table or book is damaged;
130 interrupted. A fault is one sentence on stderr. Nothing heavy is imported here: each command imports what it needs.
"""

from __future__ import annotations

import contextlib
import gc
import os
import sys
from collections.abc import Callable, Sequence
from typing import NoReturn

OK, LIMITS_MISSED, INPUT_FAULT, DAMAGED, INTERRUPTED, PIPE_CLOSED = 0, 1, 2, 3, 130, 141


def script() -> NoReturn:
    """The program `retarder-synth`.

    What it loads is there to stay, so Python need not look for garbage in it all the time, nor take it apart at the
    end, which lasts a fifth of a second after a tune. All files are closed by then, and what helpers there are end
    with their pipes.
    """
    gc.set_threshold(100_000)
    code = main()
    with contextlib.suppress(OSError, ValueError):
        sys.stderr.flush()
    os._exit(code)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line (by default that of the process) and return its exit code."""
    from synth.cli.commands import run

    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")  # a terminal that knows no Cyrillic letters shall not stop us
    # See `synth.one_blas_thread`; before BLAS is loaded it starts no threads at all.
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    try:
        code = told(lambda: run(sys.argv[1:] if arguments is None else list(arguments)))
        sys.stdout.flush()
    except BrokenPipeError:  # whoever read our output has had enough of it
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return PIPE_CLOSED
    except KeyboardInterrupt:
        code = INTERRUPTED
    if code == INTERRUPTED:
        say("interrupted")
    return code


def told(call: Callable[[], int]) -> int:
    """The exit code of `call()`, or that of the fault it raised, told in one sentence."""
    try:
        return call()
    except BrokenPipeError:
        raise
    except OSError as error:
        where = f"{error.filename}: " if error.filename else ""
        say(f"{where}{error.strerror or error}")
        return INPUT_FAULT
    except ValueError as error:
        from plant_models import PlantError
        from synth.input_error import InputError
        from tuning_tables import TableError

        if not isinstance(error, InputError | PlantError | TableError):
            raise
        say(str(error))
        return DAMAGED if isinstance(error, TableError) else INPUT_FAULT


def say(sentence: str) -> None:
    """One line on stderr."""
    print(f"retarder-synth: {' '.join(sentence.split())}", file=sys.stderr, flush=True)
