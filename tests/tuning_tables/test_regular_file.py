"""Files read whole: no more memory than they need, and nothing of one that is too long."""

from __future__ import annotations

import tracemalloc
from pathlib import Path

import pytest

from tuning_tables import DamagedTable
from tuning_tables.regular_file import read_regular_file


def test_a_short_file_takes_no_more_memory_than_it_needs(tmp_path: Path) -> None:
    """However long a file may be: the log of a day may have a gigabyte, which not every machine has to give."""
    path = tmp_path / "short"
    path.write_bytes(b"content")
    tracemalloc.start()
    try:
        assert read_regular_file(path, 2**30) == b"content"
        assert tracemalloc.get_traced_memory()[1] < 2**20
    finally:
        tracemalloc.stop()


STATUS = Path("/proc/self/status")


@pytest.mark.skipif(not STATUS.exists(), reason="a file that is longer than the system says is one of Linux")
def test_a_file_that_has_grown_since_its_length_was_asked_comes_whole() -> None:
    assert STATUS.stat().st_size == 0
    assert read_regular_file(STATUS, 2**20).endswith(STATUS.read_bytes()[-20:])
    with pytest.raises(DamagedTable, match="but at most 10 are allowed"):
        read_regular_file(STATUS, 10)
