"""Files are replaced whole or not at all, read whole, and a disk that fails leaves no damaged book.

The writes fail in earnest: beyond RLIMIT_FSIZE the system refuses them (EFBIG), h5py's own too.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tracemalloc
from pathlib import Path

import pytest

from tuning_tables import ControllerTable, DamagedTable, book_layout, hdf5_file, read_book, write_book
from tuning_tables.whole_file import read_regular_file, replacing, write_atomically


def test_content_arrives_and_replaces_what_was_there(tmp_path: Path) -> None:
    path = tmp_path / "table.json"
    write_atomically(path, b"old")
    write_atomically(str(path), b"new")
    assert path.read_bytes() == b"new"
    assert os.listdir(tmp_path) == ["table.json"]


def test_the_part_is_a_recognisable_sibling(tmp_path: Path) -> None:
    with replacing(tmp_path / "table.json") as part:
        assert part.parent == tmp_path
        assert part.name.startswith(".table.json.")
        assert part.suffix == ".part"
        assert not (tmp_path / "table.json").exists()
        part.write_bytes(b"x")


@pytest.mark.parametrize("fault", [ValueError, KeyboardInterrupt, SystemExit])
def test_an_interrupted_writer_leaves_the_old_file(tmp_path: Path, fault: type[BaseException]) -> None:
    path = tmp_path / "table.json"
    path.write_bytes(b"old")

    def write_half() -> None:
        with replacing(path) as part:
            part.write_bytes(b"ne")
            raise fault

    with pytest.raises(fault):
        write_half()
    assert path.read_bytes() == b"old"
    assert os.listdir(tmp_path) == ["table.json"]


@pytest.mark.requirement("FILE-08")
def test_content_is_on_the_disk_before_the_name_and_the_name_before_the_return(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    steps: list[str] = []
    fsync, replace = os.fsync, os.replace

    def counted_fsync(fd: int) -> None:
        steps.append("fsync")
        fsync(fd)

    def counted_replace(source: Path, target: Path) -> None:
        steps.append("replace")
        replace(source, target)

    monkeypatch.setattr(os, "fsync", counted_fsync)
    monkeypatch.setattr(os, "replace", counted_replace)
    write_atomically(tmp_path / "a", b"x")
    assert steps == ["fsync", "replace", "fsync"]


@pytest.mark.requirement("FILE-08")
def test_a_killed_writer_leaves_the_old_file(tmp_path: Path) -> None:
    path = tmp_path / "table.json"
    path.write_bytes(b"old")
    program = (
        "import os, signal, sys\n"
        "from tuning_tables.whole_file import replacing\n"
        "with replacing(sys.argv[1]) as part:\n"
        "    part.write_bytes(b'new')\n"
        "    os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    ended = subprocess.run([sys.executable, "-c", program, str(path)], env=environment, check=False)
    assert ended.returncode == -9
    assert path.read_bytes() == b"old"
    leftovers = [name for name in os.listdir(tmp_path) if name != "table.json"]
    assert all(name.startswith(".table.json.") and name.endswith(".part") for name in leftovers)


@pytest.mark.skipif(os.name != "posix", reason="permissions of a new file are those of POSIX")
def test_permissions_are_those_of_any_new_file(tmp_path: Path) -> None:
    (tmp_path / "plain").write_bytes(b"")
    write_atomically(tmp_path / "atomic", b"")
    assert (tmp_path / "atomic").stat().st_mode == (tmp_path / "plain").stat().st_mode


def test_a_missing_directory_is_an_os_error(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        write_atomically(tmp_path / "nowhere" / "table.json", b"")


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


ON_POSIX = pytest.mark.skipif(os.name != "posix", reason="the limit of a file's size is that of POSIX")

LOST_FOR_A_MOMENT = """
import resource, sys
from tuning_tables import book_layout, read_book, write_book
writes_axis, (_, hard) = book_layout.write_axis, resource.getrlimit(resource.RLIMIT_FSIZE)
def lost(*arguments):
    resource.setrlimit(resource.RLIMIT_FSIZE, (0, hard))
    writes_axis(*arguments)  # what it writes is flushed by a destructor, which can raise nothing
    resource.setrlimit(resource.RLIMIT_FSIZE, (hard, hard))
tables = read_book(sys.argv[1])
book_layout.write_axis = lost
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


@ON_POSIX
def test_a_write_that_fails_for_a_moment_leaves_no_damaged_book(book: Path, tmp_path: Path) -> None:
    path = tmp_path / "book.h5"
    ran = run(LOST_FOR_A_MOMENT, book, path)
    if ran.returncode == 0:
        assert read_book(path) == read_book(book)
    else:
        assert ran.stderr.startswith("refused: ")
        assert not path.exists()


@ON_POSIX
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
    body, write = book_layout.image_of, Path.write_bytes
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
