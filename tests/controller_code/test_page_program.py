"""The C programs on the page of controllers compile, and command the stages that Python does."""

from __future__ import annotations

import ctypes
import re
from pathlib import Path

import numpy as np
import pytest

from scripts.studies.in_the_loop.controller_process import CONTRACT, compile_with
from tests.controller_code.conftest import Tool
from tests.controller_code.sample_book import estimating_book
from tests.controller_code.weighed_cuts import NAMES, TARGET_M_S, braked_by, weighed_book, weighed_cuts
from tests.effort import sized
from tuning_tables import decide_for
from tuning_tables.exports import c_files
from tuning_tables.table_book import TableBook

PAGE = Path(__file__).parents[2] / "docs" / "how-to" / "controllers.md"
ASK = """
int commanded(unsigned number, int stage, float s_m, float v_m_s)
{
    table = retarder_tables[number];
    speed_m_s = v_m_s;
    return on_rest(stage, s_m);
}
"""


SAMPLES, CUTS = sized((4_000, 60), (20_000, 300))

TELL = """
float told_speed(void) { return speed_m_s; }
"""


def compiled(folder: Path, tool: Tool, book: TableBook, marked: str, more: str) -> ctypes.CDLL:
    """The page's program that has the word `marked`, with `more` functions, as a library with the tables of `book`."""
    for name, text in c_files(book).items():
        (folder / name).write_bytes(text)
    (block,) = (b for b in re.findall(r"```c\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.S) if marked in b)
    (folder / "page.c").write_text(block + more, encoding="utf-8")
    sources = [str(each) for each in folder.glob("*.c")]
    library = folder / "page.so"
    compile_with([tool("gcc"), *CONTRACT, "-shared", "-fPIC", *sources, "-o", str(library)])
    return ctypes.CDLL(str(library))


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory, tool: Tool) -> ctypes.CDLL:
    """The first program."""
    loaded = compiled(tmp_path_factory.mktemp("page"), tool, estimating_book(), "on_rest", ASK)
    loaded.commanded.argtypes = [ctypes.c_uint, ctypes.c_int, ctypes.c_float, ctypes.c_float]
    return loaded


def test_the_page_commands_what_python_does(program: ctypes.CDLL) -> None:
    rng, book, far = np.random.default_rng(7), estimating_book(), 0
    for _ in range(SAMPLES):
        number = int(rng.integers(len(book.tables)))
        table = book.tables[number]
        stage = int(rng.integers(-1, len(table.stages) + 1))
        s, v = float(rng.uniform(-5.0, 45.0)), float(rng.uniform(0.0, 9.0))
        wanted = decide_for(table, stage, s, v)
        assert program.commanded(number, stage, s, v) == wanted
        far += abs(wanted - stage) > 1
    assert far > SAMPLES // 40


def test_the_page_goes_over_to_the_tables_that_python_does(tmp_path: Path, tool: Tool) -> None:
    book = weighed_book()
    loaded = compiled(tmp_path, tool, book, "on_weighed_cut", TELL)
    loaded.on_weighed_cut.argtypes = [ctypes.c_uint, ctypes.c_uint, ctypes.c_float]
    loaded.on_observed_sample.argtypes = [ctypes.c_float] * 3
    loaded.on_observed_sample.restype = None
    loaded.on_stage_reached.argtypes = [ctypes.c_int, ctypes.c_float]
    loaded.told_speed.restype = ctypes.c_float
    tables = dict(zip(NAMES, book.tables, strict=True))
    assert loaded.on_weighed_cut(3, 4, TARGET_M_S) == 0  # the book lacks it
    left = 0
    for told, samples in weighed_cuts(CUTS):
        assert loaded.on_weighed_cut(told, 4, TARGET_M_S) == 1
        for sample, (number, speed) in zip(samples, braked_by(book, told, samples), strict=True):
            loaded.on_observed_sample(*map(float, sample))
            assert loaded.told_speed() == speed
            for stage in range(5):
                assert loaded.on_stage_reached(stage, sample[0]) == decide_for(
                    tables[number], stage, float(sample[0]), speed
                )
        left += number != told
    assert CUTS // 3 < left < 5 * CUTS // 6
