"""Closed or full streams, full disks, faults of our own: what was computed is whole, and the exit code true."""

from __future__ import annotations

import errno
import json
import os
import resource
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from synth.cli import TRACEBACK
from synth.cli import init as init_module
from tests.effort import every
from tests.frame.small_command import results_in
from tests.system.conftest import CLASS, Command

PROGRAM = "from synth.cli import script; script()"
COMMAND = [sys.executable, "-c", PROGRAM]


def shell(line: str, *arguments: object, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run `line` by bash, where `$tool` is the program with `arguments`; its code is that of the program."""
    tool = shlex.join([*COMMAND, *map(str, arguments)])
    return subprocess.run(
        ["bash", "-c", line.replace("$tool", tool)],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One class, without pictures."""
    path = tmp_path_factory.mktemp("plain") / "plain.toml"
    path.write_text(CLASS.replace("csv = true", "plots = false\nreport = false"))
    return path


@pytest.mark.parametrize(
    ("line", "code", "said"),
    every(
        2,
        [
            ("$tool >&- 2>&- <&-", 0, ""),
            ("$tool >&-", 0, ""),
            ("{ sleep 0.5; $tool 2>&1 >/dev/null; echo code $? >&2; } | true", None, "code 141"),
            ("$tool 2>&-", 0, ""),
            ("$tool >/dev/full", 74, "standard output: No space left on device; make room"),
            ("$tool 2>/dev/full", 0, ""),
        ],
    ),
)
def test_a_stream_that_takes_nothing_costs_no_result(
    plain: Path, tmp_path: Path, line: str, code: int | None, said: str
) -> None:
    ran = shell(line, "tune", plain, "-o", tmp_path / "out")
    assert said in ran.stderr
    assert "Traceback" not in ran.stderr
    assert code in (None, ran.returncode)
    assert json.loads((tmp_path / "out" / "summary.json").read_bytes())["accepted"] is True


@pytest.mark.parametrize("command", ["inspect", "verify"])
def test_nobody_reads_a_long_output(tuned: Path, command: str) -> None:
    ran = shell("{ sleep 0.5; $tool; echo code $? >&2; } | true", command, tuned, "--json")
    assert "code 141" in ran.stderr
    assert "Traceback" not in ran.stderr


def test_no_file_takes_the_place_of_a_closed_stream(tuned: Path, tmp_path: Path) -> None:
    assert shell("$tool >&- 2>&-", "export", tuned / "book.h5", "--format", "c", "-o", tmp_path / "c").returncode == 0
    for name in ("retarder_table.c", "golden_vectors.csv"):
        assert (tmp_path / "c" / name).read_bytes() == (tuned / "c" / name).read_bytes()


@pytest.mark.requirement("CMD-07")
@pytest.mark.parametrize("limit", [0, 700])
def test_a_full_disk_names_the_file_and_is_no_fault_of_the_input(tuned: Path, tmp_path: Path, limit: int) -> None:
    ran = subprocess.run(
        [*COMMAND, "export", tuned / "book.h5", "--format", "c", "-o", tmp_path / "c"],
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY)),
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert ran.returncode == 74
    assert ran.stderr.startswith(f"retarder-synth: {tmp_path}/c/")
    assert "File too large; raise the limit of a file's size" in ran.stderr
    assert ran.stderr.count("\n") == 1
    assert results_in(tmp_path / "c") == {}


@pytest.mark.requirement("CMD-07")
@pytest.mark.usefixtures("tuned_once")  # compiles the kernels, whose files are larger than the limit
def test_a_full_disk_in_a_tune_is_74(plain: Path, tmp_path: Path) -> None:
    ran = subprocess.run(
        [*COMMAND, "tune", plain, "-o", tmp_path],
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (50_000, resource.RLIM_INFINITY)),
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert ran.returncode == 74
    assert f"{tmp_path}/book.h5: File too large" in ran.stderr.splitlines()[-1]
    assert not (tmp_path / "summary.json").exists()
    assert list(tmp_path.rglob("*.part")) == []


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EIO, errno.EMFILE])
@pytest.mark.parametrize("step", ["make_directory", "read_book"])
def test_faults_of_the_machine_are_74_wherever_they_come_from(
    command: Command, tuned: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, number: int, step: str
) -> None:
    def fail(path: object, *_: object, **__: object) -> None:
        raise OSError(number, os.strerror(number), str(path))

    monkeypatch.setattr(
        "synth.retarder.forms.tables_at.read_book" if step == "read_book" else "pathlib.Path.mkdir", fail
    )
    ran = command("export", tuned / "book.h5", "--format", "csv", "-o", tmp_path / "csv")
    assert (ran.code, ran.out) == (74, "")
    assert f"{os.strerror(number)}; " in ran.sentence
    assert str(tuned if step == "read_book" else tmp_path) in ran.sentence


def test_a_directory_or_ledger_that_cannot_be_forced_out_is_named(
    command: Command, plain: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(_: int) -> None:
        raise OSError(errno.EIO, os.strerror(errno.EIO))

    monkeypatch.setattr(os, "fsync", fail)
    for words, named in ((("tune",), tmp_path / "tune"), (("sweep", "run"), tmp_path / "sweep")):
        ran = command(*words, plain, "-o", named)
        assert (ran.code, ran.out) == (74, "")
        said = f"{named}/.retarder-synth: Input/output error; check the disk, then run the command again"
        assert ran.err.splitlines()[-1] == f"retarder-synth: {said}"


def raising(fault: BaseException) -> object:
    def command(*_: object) -> int:
        raise fault

    return command


@pytest.mark.parametrize(
    "fault",
    [KeyError("x"), RuntimeError("odd\nthing"), ValueError("v"), RecursionError("deep"), OSError("of a library")],
)
def test_an_unforeseen_fault_has_a_code_of_its_own(
    command: Command, monkeypatch: pytest.MonkeyPatch, fault: BaseException
) -> None:
    monkeypatch.setattr(init_module, "init_command", raising(fault))
    ran = command("init")
    assert (ran.code, ran.out) == (70, "")
    assert f"{type(fault).__name__}: " in ran.sentence
    assert "(in test_surroundings.py, line " in ran.sentence
    assert "please report" in ran.sentence
    monkeypatch.setenv(TRACEBACK, "1")
    told = command("init").err
    assert told.startswith("Traceback (most recent call last):")
    assert told.splitlines()[-1].startswith("retarder-synth: this is a fault of retarder-synth itself")


def test_what_was_printed_before_a_fault_is_not_lost() -> None:
    monkey = "import sys, synth.cli.init as i\ndef f(*_):\n print('printed'); raise KeyError(1)\ni.init_command = f\n"
    ran = subprocess.run(
        [sys.executable, "-c", f"{monkey}{PROGRAM}", "init"], capture_output=True, text=True, timeout=60, check=False
    )
    assert (ran.returncode, ran.stdout) == (70, "printed\n")


def test_want_of_memory_is_74(command: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(init_module, "init_command", raising(MemoryError()))
    ran = command("init")
    assert ran.code == 74
    assert "not enough memory" in ran.sentence


@pytest.mark.long
def test_nothing_is_left_in_the_temporary_directory(two_classes: Path, tmp_path: Path) -> None:
    (tmp_path / "tmp").mkdir()
    ran = shell(
        "$tool >/dev/null", "tune", two_classes, "-o", tmp_path / "out", "--workers", "2", TMPDIR=str(tmp_path / "tmp")
    )
    assert ran.returncode == 0, ran.stderr
    assert len(list((tmp_path / "out" / "plots").iterdir())) > 4
    assert list((tmp_path / "tmp").rglob("*")) == []


def test_a_private_cache_goes_with_its_process(tmp_path: Path) -> None:
    source = (
        "from synth.kernels.cache import cache_in_use; from synth.cli import leave; import sys; "
        "d = cache_in_use(); (d / 'kernel.nbi').write_bytes(b'x'); print(d, flush=True); leave(5)"
    )
    nowhere = {"RETARDER_SYNTH_CACHE": "", "XDG_CACHE_HOME": "", "HOME": "/proc/none", "TMPDIR": str(tmp_path)}
    ran = subprocess.run(
        [sys.executable, "-c", source], env={**os.environ, "NUMBA_CACHE_DIR": "", **nowhere},
        capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert ran.returncode == 5
    assert ran.stdout.startswith(f"{tmp_path}/retarder-synth-")
    assert list(tmp_path.iterdir()) == []


def test_a_file_that_is_printed_is_utf_8_whatever_the_terminal_has() -> None:
    ascii_only = {**os.environ, "LC_ALL": "C", "PYTHONCOERCECLOCALE": "0", "PYTHONUTF8": "0"}
    ascii_only.pop("PYTHONIOENCODING", None)
    told = subprocess.run([*COMMAND, "init"], env=ascii_only, capture_output=True, timeout=60, check=True).stdout
    assert "КНП-5" in told.decode("utf-8")
    asked = {**ascii_only, "PYTHONIOENCODING": "ascii"}
    told = subprocess.run([*COMMAND, "init"], env=asked, capture_output=True, timeout=60, check=True).stdout
    assert b"???-5" in told
