"""Readers with a fault each, which an attack must find; module and names, for a process of its own has to find them."""

from __future__ import annotations

import os
import time
import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Final, NoReturn

from synth.frame.input_error import InputError
from tests.attack.attempt import Outcome
from tuning_tables import DamagedTable

FILE: Final = "file.txt"
SOUND: Final = b"sound"


def fails(folder: Path) -> NoReturn:
    raise KeyError("zones_m")


def computes_for_ever(folder: Path) -> NoReturn:
    while True:
        pass


def waits_for_ever(folder: Path) -> NoReturn:
    while True:
        time.sleep(1.0)


def takes_all_memory(folder: Path) -> str:
    return str(len(bytes(2**40)))


def dies(folder: Path) -> NoReturn:
    os.abort()


def reads_on(folder: Path) -> str:
    return (folder / FILE).read_text(errors="replace")


def says_damage(folder: Path) -> NoReturn:
    raise DamagedTable(f"{folder / FILE}: damaged")


def blames_another(folder: Path) -> NoReturn:
    raise InputError(f"{folder / 'other.txt'}: it is at fault")


def talks(folder: Path) -> NoReturn:
    raise InputError(f"{folder / FILE}: {'so ' * 1000}")


def prints_signs(folder: Path) -> str:
    print("\x1b[31m")
    return ""


def warns(folder: Path) -> str:
    warnings.warn("overflow", stacklevel=1)
    return ""


def refuses(folder: Path) -> NoReturn:
    raise InputError(f"{folder / FILE}: it is at fault")


def accepts(folder: Path) -> str:
    return ""


PLANTED: Final[Mapping[Callable[[Path], str], Outcome]] = {
    fails: Outcome.TRACEBACK,
    computes_for_ever: Outcome.HANG,
    waits_for_ever: Outcome.HANG,
    takes_all_memory: Outcome.MEMORY,
    dies: Outcome.CRASH,
    reads_on: Outcome.MISREAD,
    says_damage: Outcome.WRONG_CODE,
    blames_another: Outcome.WRONG_FILE,
    talks: Outcome.NO_LINE,
    prints_signs: Outcome.NO_LINE,
    warns: Outcome.WARNING,
    refuses: Outcome.REFUSED,
    accepts: Outcome.ACCEPTED,
}


def only_if_changed(folder: Path, reader: Callable[[Path], str]) -> str:
    """The fault shows only where the file is not the original."""
    return SOUND.decode() if (folder / FILE).read_bytes() == SOUND else reader(folder)
