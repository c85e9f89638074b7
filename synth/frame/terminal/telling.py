"""The exit codes of the program, and its sentences on stderr."""

from __future__ import annotations

import atexit
import os
import sys
from collections.abc import Sequence
from typing import NoReturn

OK, LIMITS_MISSED, INPUT_FAULT, DAMAGED, INTERRUPTED, PIPE_CLOSED = 0, 1, 2, 3, 130, 141
UNFORESEEN, MACHINE_FAULT = 70, 74
"""EX_SOFTWARE and EX_IOERR of sysexits.h."""

MOST_FAULTS = 50
"""Of one configuration, that are told."""

LONGEST_WORD, LONGEST_LINE = 300, 2000
"""Characters of what is told."""


def leave(code: int) -> NoReturn:
    """End the process at once with `code`.

    Python is not taken apart, which lasts a fifth of a second after a tune; but all that was registered for the end is
    done: temporary directories and unfinished files are removed.
    """
    atexit._run_exitfuncs()
    os._exit(code)


def say_each(sentences: Sequence[str]) -> None:
    """One line on stderr for each of the first sentences, and how many are left."""
    for sentence in sentences[:MOST_FAULTS]:
        say(sentence)
    if len(sentences) > MOST_FAULTS:
        say(f"and {len(sentences) - MOST_FAULTS} more faults")


def say(sentence: str) -> None:
    """One line on stderr; long words, as paths can be, and long lines show their beginning and their end."""
    from tuning_tables.errors import excerpt

    words = (excerpt(printable(word), LONGEST_WORD) for word in sentence.split())
    print(f"retarder-synth: {excerpt(' '.join(words), LONGEST_LINE)}", file=sys.stderr, flush=True)


def printable(text: str) -> str:
    """`text` with the codes of signs that would steer a terminal: files of others may hold such."""
    return "".join(sign if sign.isprintable() else ascii(sign)[1:-1] for sign in text)
