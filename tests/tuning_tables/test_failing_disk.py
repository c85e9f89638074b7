"""A disk that takes a write only in part, or never: no damaged book, and an `OSError` that names the file.

The writes fail in earnest: beyond RLIMIT_FSIZE the system refuses them (EFBIG), h5py's own too.
"""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tuning_tables import ControllerTable, book_image, hdf5_file, read_book, write_book
from tuning_tables.atomic_file import replacing

pytestmark = pytest.mark.skipif(os.name != "posix", reason="the limit of a file's size is that of POSIX")

LOST_FOR_A_MOMENT = """
import resource, sys
from tuning_tables import book_image, read_book, write_book
writes_axis, (_, hard) = book_image.write_axis, resource.getrlimit(resource.RLIMIT_FSIZE)
def lost(*arguments):
    resource.setrlimit(resource.RLIMIT_FSIZE, (0, hard))
    writes_axis(*arguments)  # what it writes is flushed by a destructor, which can raise nothing
    resource.setrlimit(resource.RLIMIT_FSIZE, (hard, hard))
tables = read_book(sys.argv[1])
book_image.write_axis = lost
try:
    write_book(tables, sys.argv[2])
except OSError as fault:
    raise SystemExit(f"refused: {fault}")
"""

FULL = """
import json, resource, sys
from tuning_tables import read_book, write_book
tables, (_, hard) = read_book(sys.argv[1]), resource.getrlimit(resource.RLIMIT_FSIZE)
for limit in map(int, sys.argv[3:]):
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, hard))
    try:
        write_book(tables, sys.argv[2])
        told = None
    except Exception as fault:
        told = [type(fault).__name__, getattr(fault, "filename", None), str(fault)]
    print(json.dumps(told))
"""


def run(program: str, *arguments: object) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, "-c", program, *map(str, arguments)]
    return subprocess.run(command, env=environment, capture_output=True, text=True, timeout=60, check=False)


@pytest.fixture
def book(table: ControllerTable, linear_table: ControllerTable, tmp_path: Path) -> Path:
    path = tmp_path / "whole.h5"
    write_book([table, linear_table], path)
    return path


def test_a_write_that_fails_for_a_moment_leaves_no_damaged_book(book: Path, tmp_path: Path) -> None:
    path = tmp_path / "book.h5"
    ran = run(LOST_FOR_A_MOMENT, book, path)
    if ran.returncode == 0:
        assert read_book(path) == read_book(book)
    else:
        assert ran.stderr.startswith("refused: ")
        assert not path.exists()


def test_a_full_disk_is_an_os_error_that_names_the_book(book: Path, tmp_path: Path) -> None:
    path = tmp_path / "book.h5"
    path.write_bytes(b"old")
    size = len(book.read_bytes())
    limits = [*range(0, size, size // 12), size - 1]
    told = [json.loads(line) for line in run(FULL, book, path, *limits).stdout.splitlines()]
    assert [each and each[:2] for each in told] == [["OSError", str(path)]] * len(limits)
    assert all("too large" in each[2] for each in told)
    assert path.read_bytes() == b"old"
    assert sorted(os.listdir(tmp_path)) == ["book.h5", "whole.h5"]


def with_a_gap(content: bytes, at: int) -> bytes:
    """`content` with nothing in one of its quarters, as where a write was lost."""
    quarter = len(content) // 4
    return content[: at * quarter] + bytes(quarter) + content[(at + 1) * quarter :]


@pytest.mark.parametrize("lost", [0, 1])
@pytest.mark.parametrize("lost_before_the_seal", [True, False])
def test_what_was_written_is_read_back_before_it_takes_the_name(
    table: ControllerTable, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, lost_before_the_seal: bool, lost: int
) -> None:
    path = tmp_path / "book.h5"
    path.write_bytes(b"old")
    body, write = book_image.image_of, Path.write_bytes
    with monkeypatch.context() as patched:
        if lost_before_the_seal:
            patched.setattr(hdf5_file, "image_of", lambda *parts: with_a_gap(body(*parts), lost))
        else:
            patched.setattr(Path, "write_bytes", lambda part, content: write(part, with_a_gap(content, lost)))
        with pytest.raises(OSError, match="does not read back") as caught:
            write_book([table], path)
    assert caught.value.filename == str(path)
    assert path.read_bytes() == b"old"
    assert os.listdir(tmp_path) == ["book.h5"]


@pytest.mark.parametrize("step", ["open", "fsync", "replace"])
def test_a_failing_step_names_the_file_that_was_asked_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, step: str
) -> None:
    path = tmp_path / "table.json"

    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patched:
        patched.setattr(os, step, fail)
        with pytest.raises(OSError, match="No space") as caught, replacing(path) as part:
            part.write_bytes(b"new")
    assert caught.value.filename == str(path)
    assert os.listdir(tmp_path) == []


def test_a_fault_that_concerns_another_file_keeps_its_name(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError) as caught, replacing(tmp_path / "table.json"):
        (tmp_path / "other").read_bytes()
    assert caught.value.filename == str(tmp_path / "other")
