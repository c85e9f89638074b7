"""The faults of the program can be planted: what each one changes stands once where it says."""

from __future__ import annotations

import shutil
from collections import Counter
from pathlib import Path

import pytest

from tests.program_faults.faults import FAULTS, PACKAGES, PLANTED, TESTS, ProgramFault

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("fault", FAULTS, ids=str)
def test_a_fault_changes_one_place(fault: ProgramFault, tmp_path: Path) -> None:
    assert fault.file.partition("/")[0] in PACKAGES
    (tmp_path / fault.file).parent.mkdir(parents=True)
    shutil.copy(ROOT / fault.file, tmp_path / fault.file)
    fault.plant(tmp_path)
    planted = (tmp_path / fault.file).read_text(encoding="utf-8")
    assert planted != (ROOT / fault.file).read_text(encoding="utf-8")
    compile(planted, fault.file, "exec")


def test_there_are_some_of_every_part() -> None:
    assert PLANTED.keys() == TESTS.keys()
    assert all((ROOT / folder).is_dir() for folders in TESTS.values() for folder in folders)
    assert min(Counter(fault.part for fault in FAULTS).values()) >= 4
    with pytest.raises(ValueError, match="does not stand there once"):
        ProgramFault("rule", FAULTS[0].file, "no such line", "").plant(ROOT)
