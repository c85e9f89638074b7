"""A tune that is killed leaves nothing that looks complete and is not; the same problem gives the same bytes."""

from __future__ import annotations

import hashlib
import json
import os
import random
import signal
import subprocess
import sys
import time
import tomllib
from pathlib import Path
from xml.etree import ElementTree

import pytest

from synth.frame.own_files import LOCK, MARKER
from synth.frame.results_directory import LEFTOVER
from tests.system.conftest import EPOCH, Command
from tuning_tables import read_book, read_json

TUNE = [sys.executable, "-c", "import sys; from synth.cli import main; raise SystemExit(main(sys.argv[1:]))", "tune"]


def start(config: Path, out: Path) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [*TUNE, str(config), "-o", str(out)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
    )


def wait_for(tune: subprocess.Popen[str], words: str) -> None:
    """Until `tune` says `words`, or ends."""
    assert tune.stderr is not None
    for line in tune.stderr:
        if words in line:
            return


def check(out: Path) -> None:
    """Every file in `out` is whole, and a summary describes exactly the files that are there."""
    for path in out.rglob("*"):
        if path.is_file() and path.name not in (MARKER, LOCK) and not LEFTOVER.fullmatch(path.name):
            check_file(path)
    if (out / "summary.json").exists():
        files = json.loads((out / "summary.json").read_bytes())["files"]
        for name, digest in files.items():
            assert hashlib.sha256((out / name).read_bytes()).hexdigest() == digest, name


def check_file(path: Path) -> None:
    content = path.read_bytes()
    match path.parent.name, path.suffix:
        case "tables", ".json":
            read_json(path)
        case "tables", ".csv":
            assert content.endswith(b"\r\n")
        case "c", ".c" | ".h":
            assert content.startswith(b"/* ")
            assert content.endswith((b"\n}\n", b"#endif\n"))
        case "c" | "sheets", ".csv":
            assert content.endswith(b"\n")
        case "plots", ".svg":
            ElementTree.fromstring(content)
        case _, ".h5":
            assert read_book(path)
        case _, ".html":
            assert content.endswith(b"</html>\n")
        case _, ".toml":
            assert content
            tomllib.loads(content.decode("utf-8"))
        case _:
            assert path.name == "summary.json"
            json.loads(content)


MOMENTS = (("", 3.0), ("[1/1]", 0.9), ("pictures drawn", 0.12))
"""(what to wait for, longest further wait in seconds) of each kill."""


@pytest.mark.requirement("CMD-06")
def test_killed_tunes_leave_nothing_half_done(tuned: Path, one_class: Path) -> None:
    # Begun in the results of another book: the old summary must be gone before anything else changes.
    rng = random.Random(20261120)
    for words, longest in MOMENTS:
        tune = start(one_class, tuned)
        if words:
            wait_for(tune, words)
        time.sleep(rng.uniform(0.0, longest))
        tune.kill()
        tune.communicate()
        check(tuned)
    last = start(one_class, tuned)
    assert last.communicate(timeout=120) is not None
    assert last.returncode == 0
    check(tuned)
    files = {path.relative_to(tuned).as_posix() for path in tuned.rglob("*") if path.is_file()}
    assert files - {"summary.json", MARKER} == set(json.loads((tuned / "summary.json").read_bytes())["files"])


@pytest.mark.requirement("CMD-06")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_it_at_once_with_one_line(one_class: Path, tmp_path: Path, number: int) -> None:
    tune = start(one_class, tmp_path)
    while not (tmp_path / "tables").exists():
        time.sleep(0.01)
    time.sleep(0.05)
    tune.send_signal(number)
    told = time.monotonic()
    _, said = tune.communicate(timeout=60)
    assert tune.returncode == 130
    assert time.monotonic() - told < 5.0
    assert said.splitlines()[-1] == f"retarder-synth: interrupted; {tmp_path} holds no complete summary"
    assert "Traceback" not in said
    assert not (tmp_path / "summary.json").exists()
    assert list(tmp_path.rglob("*.part")) == []


@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="children are found in /proc")
def test_ctrl_c_at_a_terminal_is_told_in_one_line(tmp_path: Path) -> None:
    """A terminal sends it to the process that is about to load matplotlib, too."""
    command = [*TUNE, "-o", str(tmp_path / "out")]
    tune = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, start_new_session=True)
    while not any(b"spawn_main" in command_of(pid) for pid in children_of(tune.pid)):
        assert tune.poll() is None
        time.sleep(0.01)
    time.sleep(0.1)
    os.killpg(tune.pid, signal.SIGINT)
    said = tune.communicate(timeout=60)[1]
    assert tune.returncode == 130
    assert "Traceback" not in said
    assert "interrupted" in said.splitlines()[-1]


DRAW_FOR_EVER = """
from synth.retarder.shown.pictures import case_chart
from synth.frame.picture.studio import Studio
from tests.synth.case_factory import make_case
if __name__ == "__main__":
    with Studio(2) as studio:
        for drawn in [studio.drawing(case_chart(make_case())) for _ in range(500)]:
            drawn.result()
"""


@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="children are found in /proc")
def test_drawing_processes_end_with_the_tune(tmp_path: Path) -> None:
    script = tmp_path / "draw.py"
    script.write_text(DRAW_FOR_EVER)
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    parent = subprocess.Popen([sys.executable, str(script)], env=environment, stderr=subprocess.DEVNULL)
    drawing: set[int] = set()
    deadline = time.monotonic() + 20.0
    while len(drawing) < 2 and time.monotonic() < deadline:
        time.sleep(0.05)
        drawing = {pid for pid in children_of(parent.pid) if b"spawn_main" in command_of(pid)}
    time.sleep(1.5)
    parent.kill()
    parent.wait()
    assert len(drawing) == 2
    deadline = time.monotonic() + 10.0
    while any(b"spawn_main" in command_of(pid) for pid in drawing):
        assert time.monotonic() < deadline
        time.sleep(0.05)


def children_of(pid: int) -> set[int]:
    tasks = Path(f"/proc/{pid}/task").glob("*/children")
    try:
        return {int(child) for task in tasks for child in task.read_text().split()}
    except OSError:  # it has ended meanwhile
        return set()


def command_of(pid: int) -> bytes:
    try:
        return Path(f"/proc/{pid}/cmdline").read_bytes()
    except OSError:
        return b""


SWALLOWING = """
import signal, sys, time, weakref
import synth.cli.hump
from synth.cli import main
from tuning_tables.whole_file import replacing

class Given: ...

def ends(reference):
    signal.raise_signal(signal.SIGINT)
    time.sleep(0.01)  # Python takes signals between two steps

def check_command(source, manner):  # Ctrl-C comes while a file of it is being written
    with replacing(source) as part:
        given = Given()
        reference = weakref.ref(given, ends)
        del given
    return 0

synth.cli.hump.check_command = check_command
sys.exit(main(["hump", "check", sys.argv[1]]))
"""


def test_ctrl_c_ends_a_command_without_results_and_its_unfinished_file(tmp_path: Path) -> None:
    """Also where Python drops an exception, as it does while an object is given up."""
    command = [sys.executable, "-c", SWALLOWING, str(tmp_path / "hump.toml")]
    ended = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stderr) == (130, "retarder-synth: interrupted\n")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.requirement("PRED-09")
def test_one_worker_gives_the_bytes_of_two(
    command: Command,
    tuned_once: tuple[Path, int],
    two_classes: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", EPOCH)
    assert command("tune", two_classes, "-o", tmp_path, "--workers", "1").code == 0
    names = {path.relative_to(tmp_path) for path in tmp_path.rglob("*") if path.is_file()}
    assert names == {path.relative_to(tuned_once[0]) for path in tuned_once[0].rglob("*") if path.is_file()}
    assert [name for name in names if (tmp_path / name).read_bytes() != (tuned_once[0] / name).read_bytes()] == []
