"""What is printed fits the terminal, and each figure in it is the one of `--json`.

A page is caught as a command hands it over, and laid out for terminals of several widths: that costs nothing. Tables of
commands that take longer are tried beside their other tests.
"""

from __future__ import annotations

import fcntl
import json
import os
import pty
import re
import struct
import subprocess
import sys
import termios
from pathlib import Path
from typing import Any

import pytest

from synth.cli import main
from synth.frame.exhibits import Column, Table
from synth.frame.terminal.printed_page import PrintedTable, PrintedVerdict, page_lines, table_lines, wrapped
from tests.printed_page import WIDTHS, Page, cells_of, plain, require_column, require_nothing_cut, table_of, with_half
from tests.system.conftest import Command

COLUMNS = (
    Column("case", "case", words=True, once=True),
    Column("rms", "rms", "m/s"),
    Column("within", "99\u00a0of\u00a0100 within\u00a0±", "m/s", spare=2),
    Column("saturated", "brake saturated in 10\u00a0000", spare=1),
    Column("verdict", "what it comes to", words=True),
)
KEPT = {"verdict": "the limits are kept, as the file states; " * 2}
TABLE = PrintedTable(
    Table(
        "cases",
        "A title that is longer than the narrowest of the terminals, which has sixty characters",
        COLUMNS,
        (
            {"case": "gondola-4-22t", "rms": "0.0256 ±0.0011", "within": "0.1234 ±0.0100", "saturated": "0.02", **KEPT},
            {"case": "gondola-4-22t", "rms": "0.0333 ±0.0012", "within": None, "saturated": "0.03", **KEPT},
            {"case": "gondola-4-85t", "rms": "–", "within": "0.2222 ±0.0200", "saturated": "–", **KEPT},
        ),
    ),
    "summary.json",
)


def test_a_table_is_whole_at_every_width() -> None:
    require_nothing_cut((TABLE,))
    for width in range(20, 200):
        assert all(len(line) <= width for line in table_lines(TABLE, width))


def test_columns_go_by_their_importance_and_then_rows_are_stacked() -> None:
    rules = {width: next((line for line in table_lines(TABLE, width) if "─" in line), "") for width in range(20, 200)}
    counts = [len(rule.split()) for rule in rules.values()]
    assert counts == sorted(counts)
    assert set(counts) == {0, 3, 4, 5}
    narrow = " ".join(table_lines(TABLE, 20 + counts.index(4)))
    assert "too narrow for 1 of 5 columns; every figure is in summary.json." in " ".join(narrow.split())
    assert "within" not in narrow
    assert "brake" in narrow
    stacked = table_lines(TABLE, 40)
    assert stacked.count("  99 of 100 within ±, m/s: –") == 1
    assert stacked.count("case: gondola-4-22t") == 2


def test_a_case_is_named_once_and_none_is_told_by_a_dash() -> None:
    lines = table_lines(TABLE, None)
    assert [line.split()[0] for line in lines[-3:]] == ["gondola-4-22t", "0.0333", "gondola-4-85t"]
    assert "  –  " in lines[-2]
    assert table_lines(PrintedTable(Table("none", "", COLUMNS, ()), ""), None)[-1].strip("─ ") == ""


def test_only_a_word_longer_than_a_line_is_broken_and_behind_a_sign() -> None:
    path = "/tmp/pytest-of-root/pytest-0/tuned0/out/tables/gondola-4-22t-to-1.5-m-s.json"
    for width in range(12, 100):
        lines = wrapped(f"  tables in {path} and 0.0256\u00a0±0.002", width, 2)
        assert all(len(line) <= width for line in lines)
        assert "".join("".join(lines).split()) == f"tablesin{path}and0.0256±0.002"
        assert any(path in line for line in lines) == (len(path) + 4 <= width)
        assert width < 20 or all(line[-1] in "/_-" for line in lines if line.strip() in path[:-1])
    assert wrapped("a b", 80) == ["a b"]
    assert wrapped("", 80) == [""]


def test_a_page_keeps_tables_apart_and_colours_a_verdict() -> None:
    lines = list(
        page_lines(("before", TABLE, PrintedVerdict(False, "too slow"), PrintedVerdict(True, "all kept")), None)
    )
    assert lines[:2] == [("before", ""), ("", "")]
    assert lines[-3:] == [("", ""), ("not accepted: too slow", "bold red"), ("accepted: all kept", "bold green")]


def printed(pages: list[Page], *words: object) -> Page:
    """The page that a command prints."""
    before = len(pages)
    assert main([str(word) for word in words]) in (0, 1)
    (page,) = pages[before:]
    return page


def of(row: dict[str, Any], key: str, digits: int) -> str | None:
    """A figure of the JSON as it has to be printed."""
    told = row[key]
    return None if told is None else with_half(told["value"], (told["low95"], told["high95"]), digits)


COMMON = (
    ("rms, m/s", "rms_m_s", 4),
    ("95 of 100 within ±, m/s", "p95_m_s", 4),
    ("99 of 100 within ±, m/s", "p99_m_s", 4),
    ("predicted / simulated", "prediction_ratio", 2),
    ("switchings a pass", "switchings", 1),
    ("time, s", "time_s", 2),
)


def require_figures(told: list[dict[str, str]], rows: list[dict[str, Any]]) -> None:
    """What tables of simulated cases have in common, and cuts that saturate the brake in 10 000, of two figures, or
    their bound where no pass met one."""
    for heading, key, digits in COMMON:
        require_column(told, heading, [of(row, key, digits) for row in rows])
    for cells, row in zip(told, rows, strict=True):
        value, low, high = (row["brake_saturated"][key] for key in ("value", "low95", "high95"))
        numbers = [float(each) for each in re.findall(r"[\d.]+", cells["brake saturated, in 10 000"])]
        half = max(value - low, high - value)
        wanted = ([value, low, high] if half > value else [value, half]) if value else [high]
        assert numbers == pytest.approx([1e4 * each for each in wanted], rel=0.06)


@pytest.mark.requirement("CMD-08")
def test_a_tune_prints_the_figures_of_its_summary(one_class: Path, tmp_path: Path, pages: list[Page]) -> None:
    told = table_of(printed(pages, "tune", one_class, "-o", tmp_path))
    rows = json.loads((tmp_path / "summary.json").read_bytes())["tables"]["cases"]
    require_column(told, "case", [row["label"] for row in rows])
    require_column(told, "target, m/s", [f"{row['target_speed_m_s']:g}" for row in rows])
    require_figures(told, rows)
    require_column(told, "regret", [of(row, "regret", 2) for row in rows])
    require_column(told, "best baseline, m/s", [of(row, "best_baseline_m_s", 4) for row in rows])
    require_column(told, "which", [row["best_baseline"] for row in rows])


def test_inspect_prints_the_lines_of_its_json(tuned: Path, command: Command, pages: list[Page]) -> None:
    page, found = (
        printed(pages, "inspect", tuned / "book.h5"),
        json.loads(command("inspect", tuned / "book.h5", "--json").out),
    )
    tables = [each for each in page if isinstance(each, PrintedTable)]
    for table, document in zip(tables, found["files"][0]["tables"], strict=True):
        lines = document["lines_at"]
        told = cells_of(table)
        require_column(told, "line, m/s", [f"stage {x['k']} ({x['pressure_kpa']:g} kPa) {x['line']}" for x in lines])
        for place, path_m in enumerate(lines[0]["s_m"]):
            require_column(told, f"at {path_m:.2f} m", [f"{line['v_m_s'][place]:.3f}" for line in lines])


def test_verify_prints_the_figures_of_its_json(tuned: Path, command: Command, pages: list[Page]) -> None:
    words = ("verify", tuned, "--passes", "100")
    page, found = printed(pages, *words), json.loads(command(*words, "--json").out)
    for each in found["tables"]:
        simulated, (low, high) = each["simulated"], each["simulated"]["rms_ci95_m_s"]
        sentence = (
            f"rms {simulated['rms_m_s']:.3f} [{low:.3f}, {high:.3f}] m/s in {simulated['passes']} passes, "
            f"{each['predicted_rms_m_s']:.3f} predicted"
        )
        assert sum(sentence in str(line) for line in page) == 1


@pytest.mark.parametrize("width", WIDTHS)
def test_the_width_is_that_of_the_terminal(tuned: Path, pages: list[Page], width: int) -> None:
    leader, follower = pty.openpty()
    fcntl.ioctl(follower, termios.TIOCSWINSZ, struct.pack("HHHH", 24, width, 0, 0))
    environment = {key: value for key, value in os.environ.items() if key not in ("COLUMNS", "LINES", "NO_COLOR")}
    words = ("-c", "from synth.cli import script; script()", "inspect", str(tuned / "book.h5"))
    with subprocess.Popen([sys.executable, *words], stdout=follower, env={**environment, "TERM": "xterm"}) as process:
        os.close(follower)
        text = b""
        while part := read_from(leader):
            text += part
    os.close(leader)
    assert process.returncode == 0
    lines = text.decode().splitlines()
    page = printed(pages, "inspect", tuned / "book.h5")
    assert lines == [line.rstrip() for line, _ in page_lines(page, width)]
    assert width - 12 < max(map(len, lines)) <= width


def read_from(terminal: int) -> bytes:
    """What stands there; nothing when the other side has gone."""
    try:
        return os.read(terminal, 65536)
    except OSError:
        return b""


def test_a_pipe_gets_every_column_and_no_broken_line(tuned: Path, command: Command, pages: list[Page]) -> None:
    page = printed(pages, "inspect", tuned)
    ran = command("inspect", tuned)
    assert ran.out.splitlines() == [line for line, _ in page_lines(page, None)]
    assert all(plain(each) in map(plain, ran.out.splitlines()) for each in page if isinstance(each, str))
