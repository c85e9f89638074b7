"""The exit code of every fault, and one sentence for each."""

from __future__ import annotations

import errno
from collections.abc import Iterator
from contextlib import contextmanager
from types import SimpleNamespace

import pytest

from plant_models import PlantError
from synth.cli import commands, main, told
from synth.frame.input_error import InputError
from synth.frame.machine_fault import MACHINE_FAULTS
from synth.frame.terminal import standard_streams
from synth.frame.terminal.telling import (
    DAMAGED,
    INPUT_FAULT,
    INTERRUPTED,
    LIMITS_MISSED,
    MACHINE_FAULT,
    OK,
    PIPE_CLOSED,
    UNFORESEEN,
)
from tuning_tables import OtherKind, TableError
from tuning_tables.errors import InvalidLog

FAULTS = (
    *((fault("x"), INPUT_FAULT) for fault in (InputError, PlantError, InvalidLog, OtherKind)),
    *((fault("x"), DAMAGED) for fault in TableError.__subclasses__() if fault is not OtherKind),
    *((OSError(number, "x"), MACHINE_FAULT) for number in MACHINE_FAULTS),
    (OSError(errno.ENOENT, "x", "file"), INPUT_FAULT),
    (OSError("of a library"), UNFORESEEN),
    (MemoryError(), MACHINE_FAULT),
    (ValueError("x"), UNFORESEEN),
    (ZeroDivisionError("x"), UNFORESEEN),
)


@pytest.mark.requirement("CMD-01")
@pytest.mark.parametrize(("fault", "code"), FAULTS, ids=lambda each: repr(each))
def test_a_fault_has_its_code_and_is_one_line(
    fault: BaseException, code: int, capsys: pytest.CaptureFixture[str]
) -> None:
    def call() -> int:
        raise fault

    assert told(call) == code
    printed = capsys.readouterr()
    assert (printed.out, printed.err.count("\n")) == ("", 1)


@pytest.mark.requirement("CMD-01")
def test_codes_are_those_that_the_documents_tell() -> None:
    codes = (OK, LIMITS_MISSED, INPUT_FAULT, DAMAGED, UNFORESEEN, MACHINE_FAULT, INTERRUPTED, PIPE_CLOSED)
    assert codes == (0, 1, 2, 3, 70, 74, 130, 141)


@pytest.mark.parametrize("code", [OK, LIMITS_MISSED, INPUT_FAULT, DAMAGED, UNFORESEEN, INTERRUPTED])
def test_only_a_whole_result_has_a_code_of_its_own_where_nobody_reads_the_progress(
    code: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    @contextmanager
    def left() -> Iterator[SimpleNamespace]:
        yield SimpleNamespace(reader_left=True)

    monkeypatch.setattr(standard_streams, "standard_streams", left)
    monkeypatch.setattr(commands, "run", lambda _: code)
    assert main([]) == (PIPE_CLOSED if code in (OK, LIMITS_MISSED) else code)
