"""The kernel cache: a new directory for any change, no alien file touched, and a damaged cache mends itself."""

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from synth.kernels.cache import empty_kernel_cache, guarded, kernel_fingerprint, use_kernel_cache

SOURCES = (
    "plant_models/valve_drive.py",
    "scripts/studies/peers/kernels/peer.py",
    "synth/kernels/sweep/bellman.py",
    "synth/kernels/deep/er.py",
    "tuning_tables/programs/decide.py",
    "tuning_tables/programs/observe.py",
)


OTHERS = (
    "plant_models/cut.py",
    "scripts/studies/peers/study.py",
    "synth/retarder/configuration/settings.py",
    "tuning_tables/table.py",
    "tuning_tables/rule.py",
)


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    for name in (*SOURCES, *OTHERS):
        path = tmp_path / "checkout" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"# {name}\nx = 1\n")
    return tmp_path / "checkout"


@pytest.fixture
def base(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("RETARDER_SYNTH_CACHE", str(tmp_path / "cache"))
    monkeypatch.setenv("NUMBA_CACHE_DIR", "")  # so that the value of before the test comes back after it
    if "numba" in sys.modules:
        config = sys.modules["numba"].config
        monkeypatch.setattr(config, "CACHE_DIR", config.CACHE_DIR)
    return tmp_path / "cache"


@pytest.mark.parametrize("name", SOURCES)
def test_one_changed_byte_in_a_kernel_source_changes_the_fingerprint(checkout: Path, name: str) -> None:
    before = kernel_fingerprint(checkout)
    path = checkout / name
    path.write_text(path.read_text().replace("x = 1", "x = 2"))
    assert kernel_fingerprint(checkout) != before


def test_renamed_and_new_sources_change_the_fingerprint(checkout: Path) -> None:
    seen = {kernel_fingerprint(checkout)}
    (checkout / "synth/kernels/sweep/bellman.py").rename(checkout / "synth/kernels/sweep/bellmann.py")
    seen.add(kernel_fingerprint(checkout))
    (checkout / "synth/kernels/loop/empty.py").parent.mkdir()
    (checkout / "synth/kernels/loop/empty.py").write_text("")
    seen.add(kernel_fingerprint(checkout))
    assert len(seen) == 3


@pytest.mark.parametrize("name", OTHERS)
def test_files_without_kernels_leave_the_fingerprint_alone(checkout: Path, name: str) -> None:
    """The physics of a yard, for one, may change without a minute of compiling."""
    before = kernel_fingerprint(checkout)
    (checkout / name).write_text("x = 2\n")
    (checkout / "plant_models/new.py").write_text("")
    assert kernel_fingerprint(checkout) == before


@pytest.mark.parametrize(("setting", "changes"), [("NUMBA_BOUNDSCHECK", True), ("NUMBA_NUM_THREADS", False)])
def test_settings_that_change_the_machine_code_change_the_fingerprint(
    checkout: Path, monkeypatch: pytest.MonkeyPatch, setting: str, changes: bool
) -> None:
    monkeypatch.delenv(setting, raising=False)
    before = kernel_fingerprint(checkout)
    monkeypatch.setenv(setting, "1")
    assert (kernel_fingerprint(checkout) != before) is changes


def test_directory_is_named_by_the_fingerprint_and_handed_to_numba(base: Path) -> None:
    directory = use_kernel_cache()
    assert directory == base / "retarder-synth" / kernel_fingerprint()
    assert directory.is_dir()
    assert os.environ["NUMBA_CACHE_DIR"] == str(directory)
    assert use_kernel_cache() == directory


def test_unwritable_bases_are_passed_over(base: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "a-file").write_text("")
    monkeypatch.setenv("RETARDER_SYNTH_CACHE", str(tmp_path / "a-file" / "below"))
    monkeypatch.setenv("XDG_CACHE_HOME", "relative/path")
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    assert use_kernel_cache().is_relative_to(tmp_path / "home" / ".cache")
    monkeypatch.setenv("HOME", str(tmp_path / "a-file"))
    monkeypatch.setenv("NUMBA_CACHE_DIR", "")
    private = use_kernel_cache()
    assert private.is_dir()
    assert not private.is_relative_to(tmp_path / "home")
    assert use_kernel_cache() == private


def modes(directory: Path, top: Path) -> set[int]:
    """The permissions of `directory` and all above it below `top`."""
    return {each.stat().st_mode & 0o777 for each in (directory, *directory.parents) if each.is_relative_to(top)}


def test_what_is_made_is_the_users_alone_whatever_the_umask(base: Path) -> None:
    before = os.umask(0)
    try:
        assert modes(use_kernel_cache(), base) == {0o700}
    finally:
        os.umask(before)


@pytest.mark.parametrize("which", ["retarder-synth", "fingerprint"])
@pytest.mark.parametrize("fault", ["group", "others", "alien"])
def test_a_directory_of_others_is_passed_over_with_one_warning(
    base: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    which: str,
    fault: str,
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", "")
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    ours = use_kernel_cache()
    victim = ours if which == "fingerprint" else ours.parent
    if fault == "alien" and os.getuid() != 0:
        monkeypatch.setattr(os, "getuid", lambda: 4321)
    elif fault == "alien":
        os.chown(victim, 4321, -1)
    else:
        victim.chmod(0o720 if fault == "group" else 0o702)
    found = use_kernel_cache()
    assert not found.is_relative_to(base)
    assert found.is_dir()
    (told,) = capsys.readouterr().err.splitlines()
    assert str(victim) in told or fault == "alien"
    assert f"kernels are kept in {found.parent}" in told
    if fault != "alien":
        assert found.is_relative_to(tmp_path / "home" / ".cache")
        assert use_kernel_cache() == found  # as what this process starts does
        assert capsys.readouterr().err == ""


def test_without_user_ids_the_directory_is_taken_as_it_is(base: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As on Windows."""
    ours = use_kernel_cache()
    ours.chmod(0o777)
    monkeypatch.delattr(os, "getuid")
    assert use_kernel_cache() == ours
    monkeypatch.setenv("NUMBA_CACHE_DIR", "")
    assert use_kernel_cache() == ours


def test_only_own_directories_unused_for_a_month_are_removed(base: Path) -> None:
    now = time.time()
    ages_days = {"0123456789abcdef": 31, "fedcba9876543210": 29, "notes": 400}
    for name, days in ages_days.items():
        (base / "retarder-synth" / name).mkdir(parents=True)
        os.utime(base / "retarder-synth" / name, (now - days * 86400, now - days * 86400))
    directory = use_kernel_cache()
    left = {path.name for path in (base / "retarder-synth").iterdir()}
    assert left == {"fedcba9876543210", "notes", directory.name}


def test_emptying_takes_compiled_kernels_only(tmp_path: Path) -> None:
    for name in ("a/kernel.nbi", "a/kernel.1.nbc", "a/notes.txt"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("x")
    empty_kernel_cache(tmp_path)
    assert [path.name for path in tmp_path.rglob("*.*")] == ["notes.txt"]


def test_other_errors_pass_through_and_are_not_retried(base: Path) -> None:
    directory = use_kernel_cache()
    (directory / "kernel.nbi").write_text("x")
    calls = []

    def fail() -> None:
        calls.append(1)
        raise EOFError("not from the cache")

    with pytest.raises(EOFError, match="not from the cache"):
        guarded(fail)
    assert len(calls) == 1
    assert (directory / "kernel.nbi").exists()


KERNEL = """
from numba import njit

@njit(cache=True)
def double(x):
    return 2.0 * x
"""

DAMAGE_AND_MEND = """
import importlib, json, pickle, sys
from synth.kernels.cache import cache_in_use, guarded

directory = cache_in_use()
assert "numba" not in sys.modules
import kernel

def fresh():
    return importlib.reload(kernel).double  # a new dispatcher: it must read the cache again

def hits(function):
    return sum(function.stats.cache_hits.values())

damages = {
    "truncated": lambda data: data[: len(data) // 2],
    "empty": lambda data: b"",
    "zeros": lambda data: bytes(len(data)),
    "garbage": lambda data: b"\\xff" * 7 + data[::-1],
    "another pickle": lambda data: pickle.dumps("something else"),
}
fresh()(1.5)
report = {}
for suffix in ("nbi", "nbc"):
    for name, damage in damages.items():
        (path,) = directory.rglob("*." + suffix)
        path.write_bytes(damage(path.read_bytes()))
        function = fresh()
        first = guarded(function, 1.5)
        again = fresh()
        report[suffix + " " + name] = [first, hits(function), guarded(again, 2.5), hits(again)]
print(json.dumps(report))
"""


FORGE = """
import importlib, json, os, pickle, sys
from synth.kernels.cache import cache_in_use, use_kernel_cache
import kernel

class Forged:
    def __reduce__(self):
        return os.mkdir, ("PWNED",)

def cached(directory):
    (path,) = directory.rglob("*.nbi")
    return path

kernel.double(1.5)
forged = cached(cache_in_use())
forged.write_bytes(pickle.dumps(Forged()))
cache_in_use().chmod(0o777)
os.environ["HOME"] = os.getcwd()
use_kernel_cache()
result = importlib.reload(kernel).double(1.5)
print(json.dumps([result, os.path.exists("PWNED"), cached(cache_in_use()) != forged]))
"""


def test_a_forged_kernel_in_a_directory_that_others_may_write_is_not_run(tmp_path: Path) -> None:
    run = in_a_process(FORGE, tmp_path)
    assert run.returncode == 0, run.stderr
    assert json.loads(run.stdout) == [3.0, False, True]
    assert "other users may write to" in run.stderr


def in_a_process(text: str, tmp_path: Path) -> subprocess.CompletedProcess[str]:
    """`text` run with a cache and the module `kernel` of its own."""
    (tmp_path / "kernel.py").write_text(KERNEL)
    environment = {k: v for k, v in os.environ.items() if not k.startswith("NUMBA_")}
    environment |= {"RETARDER_SYNTH_CACHE": str(tmp_path / "cache"), "XDG_CACHE_HOME": ""}
    environment["PYTHONPATH"] = os.pathsep.join((str(tmp_path), str(Path(__file__).parents[2])))
    return subprocess.run(
        [sys.executable, "-c", text], env=environment, cwd=tmp_path, capture_output=True, text=True, check=False
    )


def test_damaged_cache_is_emptied_and_the_kernel_compiled_anew(tmp_path: Path) -> None:
    run = in_a_process(DAMAGE_AND_MEND, tmp_path)
    assert run.returncode == 0, run.stderr
    report = json.loads(run.stdout)
    assert len(report) == 10
    # right result, compiled anew; right result, read from the mended cache
    assert report == {name: [3.0, 0, 5.0, 1] for name in report}
