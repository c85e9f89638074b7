"""The command line answers at once, imports nothing heavy before it must, and completes what is typed."""

from __future__ import annotations

import json
import os
import platform
import resource
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from plant_models.library import BUILT_IN, CARS
from plant_models.library.hump_entry import hump_names
from synth.cli.file_kinds import FILE_KINDS

HEAVY = {"control", "h5py", "matplotlib", "numba", "scipy"}


def python(source: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", source, *arguments], capture_output=True, text=True, timeout=60, check=False
    )


def modules_after(*commands: list[str]) -> set[str]:
    """The modules in a program that has run all `commands`."""
    source = (
        "import json, sys; from synth.cli import main; "
        "codes = [main(arguments) for arguments in json.loads(sys.argv[1])]; "
        "print(*{name.partition('.')[0] for name in sys.modules}, file=sys.stderr); raise SystemExit(max(codes))"
    )
    ran = python(source, json.dumps(commands))
    assert ran.returncode == 0, ran.stderr
    return set(ran.stderr.split())


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="a setting of glibc")
def test_arrays_get_the_memory_of_those_that_were_freed() -> None:
    """Arrays of 20 and 40 MB again and again, each time in a new thread: by itself glibc gives their memory back."""
    source = (
        "import resource, sys, threading, numpy as np; from synth.cli import keep_freed_memory; "
        "'kept' in sys.argv and keep_freed_memory(); arrays = lambda: [np.ones(n * 2**17) for n in (20, 20, 40)]; "
        "threads = [threading.Thread(target=arrays) for _ in range(12)]; "
        "faults = [(thread.start(), thread.join(), resource.getrusage(0).ru_minflt)[2] for thread in threads]; "
        "print(faults[-1] - faults[1])"
    )
    given_back, kept = (int(python(source, word).stdout) for word in ("given back", "kept"))
    assert kept < 0.1 * given_back


def test_help_imports_nothing_numeric() -> None:
    asked: list[list[str]] = [["tune"], ["aim"], ["hump", "simulate"], ["sweep", "run"], []]
    assert modules_after(*([*words, "--help"] for words in asked), ["--version"]).isdisjoint(HEAVY | {"numpy"})


def test_init_and_a_hump_need_no_solver() -> None:
    inits = (["init", kind.word] for kind in FILE_KINDS)
    commands = (["init"], *inits, ["init", "--schema"], ["hump", "routes", "dumper"])
    assert modules_after(*commands).isdisjoint(HEAVY)


def test_inspect_of_a_table_needs_no_solver(tuned: Path) -> None:
    table = next((tuned / "tables").glob("*.json"))
    assert modules_after(["inspect", str(table)]).isdisjoint(HEAVY)


@pytest.mark.parametrize(("form", "makes_code"), [("json", False), ("csv", False), ("c", True)])
def test_only_an_export_of_code_imports_what_makes_code(
    tuned: Path, tmp_path: Path, form: str, makes_code: bool
) -> None:
    source = (
        "import sys; from synth.cli import main; code = main(sys.argv[1:]); "
        "print('tuning_tables.controller_code' in sys.modules, file=sys.stderr); raise SystemExit(code)"
    )
    table = next((tuned / "tables").glob("*.json"))
    ran = python(source, "export", str(table), "--format", form, "-o", str(tmp_path / "out"))
    assert (ran.returncode, ran.stderr) == (0, f"{makes_code}\n")


@pytest.mark.parametrize("arguments", [["--help"], ["tune", "--help"]])
def test_help_is_quick(arguments: list[str]) -> None:
    """The program as it is installed: it does not look for garbage while it loads. Seconds of a processor, which other
    tests beside this one do not lengthen; alone it takes as many."""
    program = f"import sys; sys.argv[1:] = {arguments}; from synth.cli import script; script()"

    def seconds() -> float:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        assert python(program).returncode == 0
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    assert 0.02 < min(seconds() for _ in range(4)) < 0.4


def test_installed_command_and_closed_pipe() -> None:
    command = str(Path(sys.executable).with_name("retarder-synth"))
    done = subprocess.run(
        f"{command} init | head -n 1", shell=True, capture_output=True, text=True, timeout=60, check=True
    )
    assert done.stdout.startswith("#:schema ./configuration.schema.json")
    assert done.stderr == ""


def test_installed_command_ends_at_once_but_says_all() -> None:
    """It leaves without taking itself apart: every byte is out by then, and the exit code is that of `main`."""
    command = str(Path(sys.executable).with_name("retarder-synth"))

    def ran(*arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run([command, *arguments], capture_output=True, text=True, timeout=60, check=False)

    written = ran("init")
    assert written.returncode == 0
    assert written.stdout == python("from synth.cli import main; raise SystemExit(main(['init']))").stdout
    assert len(written.stdout) > 4096
    refused = ran("inspect", "nowhere.json")
    assert (refused.returncode, refused.stdout) == (2, "")
    assert refused.stderr.startswith("retarder-synth: nowhere.json: there is no such file")
    assert refused.stderr.endswith("\n")


PROGRAM = str(Path(sys.executable).with_name("retarder-synth"))

IN_BASH = """
eval "$(_RETARDER_SYNTH_COMPLETE=source_bash retarder-synth)"
COMP_WORDS=("$@")
COMP_CWORD=$(($# - 1))
_retarder_synth_completion retarder-synth
printf '%s\\n' "${COMPREPLY[@]}"
"""

CASES = {
    "a command": (["in"], {"init", "inspect"}),
    "a command of a group": (["hump", "d"], {"draw", "design"}),
    "an option": (["tune", "--w"], {"--workers"}),
    "an option of a group": (["hump", "simulate", "--tra"], {"--trains"}),
    "a choice": (["export", "out", "--format", "p"], {"plcopen"}),
    "a kind of file": (["init", "ca"], {"car", "car-mix"}),
    "a car": (["init", "car", "tank"], {name for name in BUILT_IN.names(CARS) if name.startswith("tank")}),
    "a retarder": (["init", "retarder", "knp"], {"knp-5"}),
    "a hump or a file": (["hump", "check", "m"], {"medium", "my-hump.toml"}),
    "a hump behind an option": (["aim", "--hump", "dum"], {"dumper"}),
    "a file, by the shell": (["tune", "my"], {""}),
}


def completions(folder: Path, words: list[str], script: str = IN_BASH, shell: str = "bash") -> set[str]:
    environment = {**os.environ, "PATH": f"{Path(PROGRAM).parent}{os.pathsep}{os.environ['PATH']}"}
    ran = subprocess.run(
        [shell, "-c", script, shell, "retarder-synth", *words],
        env=environment, cwd=folder, capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert (ran.returncode, ran.stderr) == (0, ""), ran.stderr
    return set(ran.stdout.splitlines())


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("typed")
    for name in ("my-hump.toml", "other.toml"):
        (made / name).touch()
    return made


@pytest.mark.parametrize("case", CASES)
def test_bash_completes(folder: Path, case: str) -> None:
    words, found = CASES[case]
    assert completions(folder, words) == found


@pytest.mark.skipif(shutil.which("zsh") is None, reason="zsh is not installed")
@pytest.mark.parametrize("case", CASES)
def test_zsh_completes(folder: Path, case: str) -> None:
    """What zsh is told to evaluate: `_arguments` with each word, or `_files`."""
    words, found = CASES[case]
    script = 'env _TYPER_COMPLETE_ARGS="${(j: :)@}" _RETARDER_SYNTH_COMPLETE=complete_zsh retarder-synth'
    told = " ".join(completions(folder, words, script, "zsh"))
    if found == {""}:
        assert "_files" in told
    else:
        assert all(f'"{each}"' in told or f'"{each}":' in told for each in found)


def test_the_names_are_those_of_the_library() -> None:
    """They are found by their files, without the library, which has numpy."""
    names = {kind.word: tuple(kind.names) for kind in FILE_KINDS}
    assert names["car"] == BUILT_IN.names(CARS)
    assert names["hump"] == hump_names()


def test_it_is_quick_and_loads_nothing_heavy(folder: Path) -> None:
    """Seconds of a processor, which other tests beside this one do not lengthen."""
    program = (
        "import sys; from synth.cli import main; code = main([]); "
        "print(*{name.partition('.')[0] for name in sys.modules}, file=sys.stderr); raise SystemExit(code)"
    )
    asked = {
        "_RETARDER_SYNTH_COMPLETE": "complete_bash",
        "COMP_WORDS": "retarder-synth aim --hump m",
        "COMP_CWORD": "3",
    }

    def run() -> tuple[float, set[str]]:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        ran = subprocess.run(
            [sys.executable, "-c", program], env={**os.environ, **asked}, cwd=folder, capture_output=True, text=True,
            timeout=60, check=False,
        )  # fmt: skip
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        assert "medium" in ran.stdout.split()
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, set(ran.stderr.split())

    found = [run() for _ in range(4)]
    assert found[0][1].isdisjoint(HEAVY | {"numpy"})
    assert 0.02 < min(seconds for seconds, _ in found) < 0.3
