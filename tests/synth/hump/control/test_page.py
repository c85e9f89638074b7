"""The example of the page runs, and its tables are those of the code."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

from synth.hump.control.event import ALARMS
from synth.hump.control.record_word import WIDTHS
from synth.hump.control.sorting_list_file import COLUMNS

ROOT = Path(__file__).parents[4]
PAGE = (ROOT / "docs/explanation/hump-control.md").read_text(encoding="utf-8")


def test_the_example_runs(tmp_path: Path) -> None:
    [program] = re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL)
    ran = subprocess.run(
        [sys.executable, "-W", "error", "-c", program],
        cwd=tmp_path, capture_output=True, text=True, timeout=120, env={**os.environ}, check=False,
    )  # fmt: skip
    assert ran.returncode == 0, ran.stderr
    assert re.fullmatch(r"40 cuts, \d{3,} events, \d+ alarms\n", ran.stdout)


def test_the_widths_of_the_page_are_those_of_the_record() -> None:
    table = PAGE.split("| field | bits | step and range |")[1].split("\n\n")[0]
    bits = [int(cells.split("|")[2]) for cells in table.splitlines()[2:]]
    assert bits == list(WIDTHS.values())


def test_columns_and_alarms_of_counters_are_named() -> None:
    assert all(f"`{column}`" in PAGE or f"{column}," in PAGE or f"{column}`" in PAGE for column in COLUMNS)
    named = set(re.findall(r"^\| `([A-Z_]+)` \|", PAGE, flags=re.MULTILINE))
    assert named < {kind.name for kind in ALARMS}
    assert len(named) == 5
