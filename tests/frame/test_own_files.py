"""The marker of a directory of results, and who holds it."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from synth.frame.held_directory import LOCK, held, is_held
from synth.frame.own_files import MARKER
from synth.frame.results_directory import results_directory
from tests.frame.results import SUMMARY, files, refused, run


def test_a_line_that_was_torn_makes_a_file_a_strangers(tmp_path: Path) -> None:
    run(tmp_path, {"a": b"a", "b": b"b"})
    marker = tmp_path / MARKER
    content = marker.read_bytes()
    marker.write_bytes(content[: content.index(b'["summary.json"')] + b'["summary.json","12')
    with refused(str(tmp_path / "summary.json"), "did not write it"):
        run(tmp_path, {"c": b"c"})
    assert files(tmp_path) == {"c": b"c", "summary.json": SUMMARY}
    (tmp_path / "summary.json").unlink()
    run(tmp_path, {"c": b"c"})
    assert files(tmp_path) == {"c": b"c", "summary.json": SUMMARY}


def test_a_marker_that_is_none_marks_nothing(tmp_path: Path) -> None:
    for content in (b"", b"notes of mine", b'{"format": "retarder-synth-results"}\n', b"[" * 100_000, b"\xff\xfe"):
        (tmp_path / MARKER).write_bytes(content)
        with refused(MARKER, "did not write"):
            run(tmp_path, {"a": b"a"})
        assert (tmp_path / MARKER).read_bytes() == content


def test_a_marker_of_somebody_else_reaches_nothing_outside(tmp_path: Path) -> None:
    """It lists files elsewhere as results that may have any content."""
    users = tmp_path / "users"
    users.mkdir()
    (users / "a").write_bytes(b"precious")
    out = tmp_path / "out"
    run(out, {"b": b"b"})
    (out / "link").symlink_to(users)
    (out / "file").symlink_to(users / "a")
    (out / "loop").symlink_to(out / "loop")
    names = ("../users/a", str(users / "a"), "link/a", "file", "loop", "loop/a", "a\0b", "c/../../users/a")
    with (out / MARKER).open("ab") as marker:
        marker.write(b"".join(json.dumps([name, "changes"]).encode() + b"\n" for name in names))
    run(out, {"c": b"c"})
    assert files(users) == {"a": b"precious"}
    for name in ("link/a", "file"):
        with refused("did not write it"):
            run(out, {name: b"ours"})
    assert files(users) == {"a": b"precious"}


def test_the_same_run_leaves_the_same_marker(tmp_path: Path) -> None:
    markers = []
    for name, names in (("first", "abc"), ("second", "cab")):
        run(tmp_path / name, {each: each.encode() for each in names})
        run(tmp_path / name, {each: each.encode() for each in reversed(names)})
        markers.append((tmp_path / name / MARKER).read_bytes())
    assert markers[0] == markers[1]


def test_the_marker_is_on_the_disk_before_a_file_has_its_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Else a machine that stops would leave a file of the command that the marker does not know."""
    synced: set[int] = set()
    to_disk, naming = os.fsync, os.replace

    def sync(descriptor: int) -> None:
        to_disk(descriptor)
        if os.fstat(descriptor).st_ino == (tmp_path / MARKER).stat().st_ino:
            synced.add((tmp_path / MARKER).stat().st_size)

    def name(source: Path, target: Path) -> None:
        if target.name != MARKER:
            assert (tmp_path / MARKER).stat().st_size in synced
        naming(source, target)

    with results_directory(tmp_path, "tune") as results:
        monkeypatch.setattr(os, "fsync", sync)
        monkeypatch.setattr(os, "replace", name)
        results.write("tables/a.json", b"abc")
        results.store("units/b", b"abc")


def test_a_directory_is_held_by_one_command(tmp_path: Path) -> None:
    with results_directory(tmp_path, "tune"), refused("another tune is writing there"):
        run(tmp_path, {}, "tune")
    with results_directory(tmp_path, "tune"), refused("another tune is writing there"):
        run(tmp_path, {}, "aim")
    run(tmp_path, {})


def test_who_only_asks_is_not_taken_for_a_run(tmp_path: Path) -> None:
    assert not is_held(tmp_path)
    with held(tmp_path) as is_ours:
        assert is_ours
        assert is_held(tmp_path)
    assert not is_held(tmp_path)
    assert list(tmp_path.iterdir()) == []


HOLD = """
import sys
from pathlib import Path
from synth.frame.held_directory import held

with held(Path(sys.argv[1])) as is_ours:
    print(is_ours, flush=True)
    sys.stdin.read()
"""


def test_a_killed_process_holds_nothing(tmp_path: Path) -> None:
    command = [sys.executable, "-c", HOLD, str(tmp_path)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as holder:
        assert holder.stdout is not None
        assert holder.stdout.readline() == "True\n"
        assert is_held(tmp_path)
        with refused("another tune is writing there"):
            run(tmp_path, {}, "tune")
        holder.kill()
        holder.wait()
    assert (tmp_path / LOCK).exists()
    assert not is_held(tmp_path)
    run(tmp_path, {}, "tune")
    assert not (tmp_path / LOCK).exists()
