"""HDF5 logs with and without a seal: what was changed is refused, and no file holds the reader for ever."""

from __future__ import annotations

import io
import os
from pathlib import Path

import h5py
import numpy as np
import pytest

from tests.tuning_tables.pass_log.sample_logs import sample_log
from tuning_tables.errors import InvalidLog
from tuning_tables.pass_log import hdf5_child, hdf5_log
from tuning_tables.pass_log.hdf5_child import FORMAT, MOST_ROWS, STORED, VERSION, columns_by_child, stored_columns
from tuning_tables.pass_log.log_files import read_logs, write_log
from tuning_tables.whole_file import SEAL_BYTES


@pytest.fixture
def sealed(tmp_path: Path) -> bytes:
    """A sound log as it is written."""
    write_log(sample_log(passes=3, rows=8), tmp_path / "sound.h5")
    return (tmp_path / "sound.h5").read_bytes()


def endless(content: bytes) -> bytes:
    """`content` with one byte changed over which HDF5 2.0 runs in a circle: the length of a text in its heap."""
    place = content.index(FORMAT.encode()) - 8
    assert content[place] == len(FORMAT)
    return content[:place] + b"\x3a" + content[place + 1 :]


def test_a_process_of_its_own_reads_the_same(sealed: bytes) -> None:
    here, there = stored_columns(sealed), columns_by_child(sealed[:-SEAL_BYTES])
    assert there.path_word == here.path_word == "independent"
    assert list(there.arrays) == list(here.arrays) == list(STORED)
    for name in STORED:
        assert there.arrays[name].dtype == here.arrays[name].dtype, name
        assert np.array_equal(there.arrays[name], here.arrays[name], equal_nan=here.arrays[name].dtype.kind == "f")


@pytest.mark.requirement("LOG-03")
def test_an_endless_file_is_refused_in_time(sealed: bytes) -> None:
    """Where a later HDF5 tells the fault itself, this test needs another such byte."""
    with pytest.raises(InvalidLog, match="HDF5 does not come to an end with it in 1 s"):
        columns_by_child(endless(sealed[:-SEAL_BYTES]), least_time_s=1.0)


@pytest.mark.requirement("LOG-03")
def test_every_changed_byte_of_a_sealed_log_is_refused(
    sealed: bytes, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By the seal, before HDF5 sees it; only where the seal itself is gone does a process look at it."""
    path, asked = tmp_path / "log.h5", []

    def by_child(content: bytes) -> None:
        asked.append(content)
        raise InvalidLog("looked at")

    monkeypatch.setattr(hdf5_log, "columns_by_child", by_child)
    for place in range(0, len(sealed), 97):
        path.write_bytes(sealed[:place] + bytes([sealed[place] ^ 0x10]) + sealed[place + 1 :])
        with pytest.raises(InvalidLog, match=r"log\.h5: (the seal at its end does not fit|looked at)"):
            read_logs([path], None, None)
    assert len(asked) <= 1
    path.write_bytes(sealed[:-3])
    with pytest.raises(InvalidLog, match="looked at"):
        read_logs([path], None, None)


def test_other_programs_open_a_sealed_log(sealed: bytes) -> None:
    with h5py.File(io.BytesIO(sealed), "r") as file:
        assert file.attrs["format"] == FORMAT
        assert len(file["time_s"]) == 24


@pytest.mark.parametrize(
    ("rows", "dtype", "words"),
    [
        (MOST_ROWS + 1, "f8", f"column time_s has {MOST_ROWS + 1} entries; at most {MOST_ROWS} may be"),
        (MOST_ROWS, "S60", "no column of numbers"),
    ],
)
def test_what_no_log_has_is_told(tmp_path: Path, rows: int, dtype: str, words: str) -> None:
    """A short file can claim any number of rows."""
    path = tmp_path / "log.h5"
    with h5py.File(path, "w") as file:
        file.attrs["format"], file.attrs["version"], file.attrs["path"] = FORMAT, VERSION, "independent"
        for name in STORED:
            if name == "time_s":
                file.create_dataset(name, shape=(rows,), chunks=(1000,), dtype=dtype)
            else:
                file[name] = np.array([b"a"]) if name in ("cut_id", "category") else np.zeros(2)
    assert path.stat().st_size < 100_000
    with pytest.raises(InvalidLog) as refused:
        read_logs([path], None, None)
    assert words in str(refused.value)
    assert str(path) in str(refused.value)


def test_columns_that_are_too_long_together_are_refused() -> None:
    content = io.BytesIO()
    with h5py.File(content, "w") as file:
        file.attrs["format"], file.attrs["version"], file.attrs["path"] = FORMAT, VERSION, "independent"
        for name in STORED:
            texts = name in ("cut_id", "category")
            file.create_dataset(name, shape=(MOST_ROWS,), chunks=(1000,), dtype="S40" if texts else "f8")
    with pytest.raises(InvalidLog, match="its columns have 3200000000 bytes; at most 1073741824 may be"):
        stored_columns(content.getvalue())


@pytest.mark.skipif(os.name == "nt", reason="the system limits no memory")
def test_the_limit_of_memory_is_told(sealed: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hdf5_child, "MEMORY_BYTES", 0)
    with pytest.raises(InvalidLog, match=r"HDF5 (takes more memory for it|breaks down over it)|not readable"):
        columns_by_child(sealed[:-SEAL_BYTES])


@pytest.mark.parametrize("chunks", [(4,), None])
def test_values_that_were_never_stored_are_not_taken_for_zeros(tmp_path: Path, chunks: tuple[int, ...] | None) -> None:
    """HDF5 reads them as 0; so it does where the index of a column is damaged."""
    path = tmp_path / "log.h5"
    write_log(sample_log(passes=2, rows=8), path)
    with h5py.File(path, "r+") as file:
        values = file["speed_m_s"][()]
        del file["speed_m_s"]
        kept = file.create_dataset("speed_m_s", shape=(16,), chunks=chunks, dtype="f8")
        if chunks:
            kept[:12] = values[:12]
    with pytest.raises(InvalidLog, match="column speed_m_s: some of its values are not there"):
        read_logs([path], None, None)
    if chunks:
        with h5py.File(path, "r+") as file:
            file["speed_m_s"][12:] = values[12:]
        assert len(read_logs([path], None, None).log) == 2


def test_a_name_that_is_no_text_is_told(tmp_path: Path) -> None:
    path = tmp_path / "log.h5"
    write_log(sample_log(passes=2, rows=8), path)
    with h5py.File(path, "r+") as file:
        file["cut_id"][1] = b"cut-\xf8"
    with pytest.raises(InvalidLog, match=r"column cut_id, pass 2: 'cut-.*' is no name; write one"):
        read_logs([path], None, None)


def test_a_large_chunk_that_was_never_stored_is_told_as_such(sealed: bytes) -> None:
    """HDF5 2 then asks for memory of any size."""
    image = io.BytesIO(sealed[:-SEAL_BYTES])
    with h5py.File(image, "r+") as file:
        del file["pressure_kpa"]
        file.create_dataset("pressure_kpa", shape=(2**20,), dtype="<f8", chunks=(2**20,), fillvalue=1.0)
    with pytest.raises(InvalidLog, match="column pressure_kpa: some of its values are not there"):
        stored_columns(image.getvalue())
