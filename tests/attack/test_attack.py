"""Some mutants of each kind of input; `python -m tests.attack` tries thousands. Faults that are planted are found."""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest

from tests.attack.attempt import Kind, Outcome, Reading
from tests.attack.kinds import KINDS
from tests.attack.planted import FILE, PLANTED, SOUND, only_if_changed, waits_for_ever
from tests.attack.processes import Limits, attempts
from tests.effort import every, sized

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
