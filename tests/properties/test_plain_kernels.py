"""Without numba's undocumented options kernels do the same, to the bit."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from synth.kernels.plain import VARIABLE
from tests.frame.results import results_in

ROOT = Path(__file__).parents[2]
CASE = """\
[[cut]]
car = "gondola-4"
mass_t = 22.0
[targets]
exit_speeds_m_s = [2.0]
[grid]
path_step_m = 1.0
speed_step_m_s = 0.06
[validation]
passes = 1000
[output]
plots = false
report = false
"""
OPTIONS = "from synth.kernels.vector.numba_internals import *; print(WITHOUT_REFERENCE_COUNTS | WITHOUT_CALLBACK)"


def ran(*words: str, plain: bool, folder: Path = ROOT) -> str:
    """What Python prints with these words, with plain kernels or fast ones."""
    environment = {name: value for name, value in os.environ.items() if name != "NUMBA_CACHE_DIR"}
    environment |= {VARIABLE: "1" if plain else "0", "SOURCE_DATE_EPOCH": "1700000000"}
    done = subprocess.run(
        [sys.executable, *words], cwd=folder, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_the_variable_leaves_the_options_out() -> None:
    assert ran("-c", OPTIONS, plain=True) == "{}\n"
    assert "_nrt" in ran("-c", OPTIONS, plain=False)


def test_packs_are_those_of_their_definitions() -> None:
    ran(
        "-m", "pytest", "-q", "-p", "no:cacheprovider", "tests/properties/test_packs.py", "-k", "to_the_bit", plain=True
    )


@pytest.mark.long
def test_a_tune_gives_the_same_bytes(tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text(CASE)
    tune = "import sys; from synth.cli import main; sys.exit(main(['tune', 'case.toml', '-o', sys.argv[1]]))"
    for name, plain in (("plain", True), ("fast", False)):
        ran("-c", tune, name, plain=plain, folder=tmp_path)
    assert results_in(tmp_path / "plain") == results_in(tmp_path / "fast")
