"""The C program on the page of controllers compiles, and commands the stages that Python does."""

from __future__ import annotations

import ctypes
import re
from pathlib import Path

import numpy as np
import pytest

from synth.studies.in_the_loop.controller_process import CONTRACT, compile_with
from tests.controller_code.conftest import Tool
from tests.controller_code.sample_book import estimating_book
from tuning_tables import decide_for
from tuning_tables.c_source import c_files

PAGE = Path(__file__).parents[2] / "docs" / "controllers.md"
ASK = """
int commanded(unsigned number, int stage, float s_m, float v_m_s)
{
    table = retarder_tables[number];
    speed_m_s = v_m_s;
    return on_rest(stage, s_m);
}
"""


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory, tool: Tool) -> ctypes.CDLL:
    """The page's program with one more function, as a library."""
    folder = tmp_path_factory.mktemp("page")
    for name, text in c_files(estimating_book()).items():
        (folder / name).write_bytes(text)
    (block,) = (b for b in re.findall(r"```c\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.S) if "on_rest" in b)
    (folder / "page.c").write_text(block + ASK, encoding="utf-8")
    sources = [str(each) for each in folder.glob("*.c")]
    library = folder / "page.so"
    compile_with([tool("gcc"), *CONTRACT, "-shared", "-fPIC", *sources, "-o", str(library)])
    loaded = ctypes.CDLL(str(library))
    loaded.commanded.argtypes = [ctypes.c_uint, ctypes.c_int, ctypes.c_float, ctypes.c_float]
    return loaded


def test_the_page_commands_what_python_does(program: ctypes.CDLL) -> None:
    rng, book, far = np.random.default_rng(7), estimating_book(), 0
    for _ in range(20_000):
        number = int(rng.integers(len(book.tables)))
        table = book.tables[number]
        stage = int(rng.integers(-1, len(table.stages) + 1))
        s, v = float(rng.uniform(-5.0, 45.0)), float(rng.uniform(0.0, 9.0))
        wanted = decide_for(table, stage, s, v)
        assert program.commanded(number, stage, s, v) == wanted
        far += abs(wanted - stage) > 1
    assert far > 500
