"""A file is replaced whole or not at all, and nothing is left lying about."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tuning_tables.atomic_file import replacing, write_atomically


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
        "from tuning_tables.atomic_file import replacing\n"
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
