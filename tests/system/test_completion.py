"""Completion of the command line: commands, options, choices, names of the library and files, at once."""

from __future__ import annotations

import os
import resource
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from plant_models.library import BUILT_IN, CARS
from plant_models.library.hump_entry import hump_names
from synth.cli.file_kinds import FILE_KINDS

PROGRAM = str(Path(sys.executable).with_name("retarder-synth"))
HEAVY = {"control", "h5py", "matplotlib", "numba", "numpy", "scipy"}

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
    assert found[0][1].isdisjoint(HEAVY)
    assert 0.02 < min(seconds for seconds, _ in found) < 0.3
