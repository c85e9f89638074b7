"""Some mutants of each kind of input, and readers with a fault each, which an attack must find."""

from __future__ import annotations

import os
import sys
import time
import warnings
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Final, NoReturn

import pytest

from synth.frame.faults import InputError
from tests.attack.kinds import KINDS
from tests.attack.processes import Kind, Limits, Outcome, Reading, attempts
from tests.effort import every, sized
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


FEW = sized(3, 30)
IMPATIENT = Limits(clock_s=1.0)
SHORT = Limits(processor_s=0.5, memory_bytes=2**28)

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="the limits of the processes are those of Linux")


FORGED = [name for name in KINDS if name.startswith("forged")]


@pytest.mark.parametrize("name", [*(name for name in KINDS if name not in FORGED), *every(4, FORGED)])
def test_a_changed_file_is_refused_in_order_or_read_as_what_it_is(name: str) -> None:
    kind = KINDS[name]()
    numbers = range(0, max(FEW, len(kind.first)), max(1, len(kind.first) // FEW))
    found = list(attempts(kind, numbers))
    assert [each.number for each in found] == list(numbers)
    assert [each for each in found if each.outcome not in (Outcome.REFUSED, Outcome.ACCEPTED)] == []
    assert any(each.outcome is Outcome.REFUSED for each in found)


@pytest.mark.parametrize("reader", PLANTED)
def test_a_planted_fault_is_found_and_the_attack_goes_on(reader: Callable[[Path], str]) -> None:
    read = partial(only_if_changed, reader=reader)
    allowed = Reading.SAME if PLANTED[reader] is Outcome.MISREAD else Reading.ANY
    kind = Kind("planted", {FILE: SOUND}, FILE, read, allowed=allowed)
    limits = IMPATIENT if reader is waits_for_ever else SHORT
    numbers = [number for number in range(20) if kind.changed(0, number).content != SOUND][:2]
    assert [each.outcome for each in attempts(kind, numbers, limits=limits)] == [PLANTED[reader]] * 2


def test_mutants_follow_from_their_numbers_and_are_not_the_original() -> None:
    kind = KINDS["aim"]()
    first, again, other = ([kind.changed(seed, number).content for number in range(200)] for seed in (0, 0, 1))
    assert first == again != other
    assert len(set(first)) > 180
    assert first.count(kind.files[kind.attacked]) < 10
