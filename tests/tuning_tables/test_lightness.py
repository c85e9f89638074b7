"""A controller that imports the package gets numpy and the standard library, nothing else, and gets them soon."""

import math
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import tuning_tables
from tuning_tables import ControllerTable, write_json

MOST_TIMES = 2.0
"""Of what a process takes that loads numpy and ends: 1.5 here, on a slow processor as on a fast one."""

ATTEMPTS = 20  # a busy machine may be slow again and again, but a heavy import is slow every time
NUMPY_ALONE = "import numpy"

PROGRAM = """
import sys
from tuning_tables import decide_for, read_json
table = read_json(sys.argv[1])
assert decide_for(table, 0, 4.0, 9.0) == 1
known = {"numpy", "tuning_tables", "__main__"} | sys.stdlib_module_names
print(sorted({name.partition(".")[0] for name in sys.modules} - known))
"""


@pytest.fixture(scope="module")
def only_numpy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A directory of packages in which there is numpy and tuning_tables, and nothing else."""
    folder = tmp_path_factory.mktemp("packages")
    numpy = Path(np.__file__).parent
    for package in (numpy, numpy.with_name("numpy.libs"), Path(tuning_tables.__file__).parent):
        if package.is_dir():
            (folder / package.name).symlink_to(package, target_is_directory=True)
    return folder


def asked_in_a_new_process(packages: Path, table: Path, program: str = PROGRAM) -> tuple[str, float]:
    """What `program` prints with these packages only, and the seconds from the start to the end of its process."""
    environment = {"PYTHONPATH": str(packages), "PATH": os.environ["PATH"]}
    started = time.perf_counter()
    ended = subprocess.run(
        [sys.executable, "-S", "-s", "-P", "-c", program, str(table)],
        env=environment,
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    return ended.stdout.strip(), time.perf_counter() - started


@pytest.mark.requirement("FILE-09")
def test_loading_and_asking_a_table_needs_numpy_alone(
    only_numpy: Path, linear_table: ControllerTable, tmp_path: Path
) -> None:
    write_json(linear_table, tmp_path / "table.json")
    foreign, _ = asked_in_a_new_process(only_numpy, tmp_path / "table.json")
    assert foreign == "[]"


def test_a_new_process_loads_and_asks_a_table_at_once(
    only_numpy: Path, linear_table: ControllerTable, tmp_path: Path
) -> None:
    write_json(linear_table, tmp_path / "table.json")
    best, numpy_alone = math.inf, math.inf
    for _ in range(ATTEMPTS):
        numpy_alone = min(numpy_alone, asked_in_a_new_process(only_numpy, tmp_path / "table.json", NUMPY_ALONE)[1])
        best = min(best, asked_in_a_new_process(only_numpy, tmp_path / "table.json")[1])
        if best < MOST_TIMES * numpy_alone:
            break
    assert best < MOST_TIMES * numpy_alone


def test_books_are_told_apart_from_what_needs_h5py(only_numpy: Path, tmp_path: Path) -> None:
    program = "from tuning_tables import read_book; read_book('absent.h5')"
    ended = subprocess.run(
        [sys.executable, "-S", "-s", "-P", "-c", program],
        env={"PYTHONPATH": str(only_numpy)},
        stderr=subprocess.PIPE,
        check=False,
    )
    assert b"ModuleNotFoundError: No module named 'h5py'" in ended.stderr
