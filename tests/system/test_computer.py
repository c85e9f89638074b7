"""`computer` and `bench` as a user runs them: files, figures, exit codes, the promise of the tables in C."""

from __future__ import annotations

import json
import os
import re
import shutil
import socket
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from synth.cli import main
from synth.frame.results_directory import SUMMARY
from synth.frame.terminal.printed_page import PrintedTable, PrintedVerdict
from synth.retarder.bench.wires import c_header
from tests.printed_page import Page, page_about
from tests.synth.bench.played import HOST, free_port
from tests.system.conftest import Command
from tests.tuning_tables.passages.made_tables import table_of
from tuning_tables import to_json

ROOT = Path(__file__).parents[2]
COMMAND = (sys.executable, "-c", "import sys; from synth.cli import main; raise SystemExit(main(sys.argv[1:]))")

FEW = """[service]
simulated_requests = 3000
[uncertainty]
draws = 200
sobol_points = 16
"""


def run(*words: str, day: str = "1700000000") -> subprocess.CompletedProcess[str]:
    """The command in a process of its own."""
    environment = {**os.environ, "SOURCE_DATE_EPOCH": day, "COLUMNS": "120"}
    return subprocess.run([*COMMAND, *words], capture_output=True, text=True, env=environment, check=False)


def written(path: Path, text: str) -> Path:
    """A configuration."""
    path.write_text(text, encoding="utf-8")
    return path


def told(directory: Path) -> dict[str, Any]:
    """The summary."""
    document: dict[str, Any] = json.loads((directory / SUMMARY).read_bytes())
    return document


@pytest.fixture(scope="module")
def first(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """A run of few draws, and what it printed."""
    folder = tmp_path_factory.mktemp("computer")
    done = run("computer", str(written(folder / "c.toml", FEW)), "-o", str(folder / "out"))
    assert done.returncode == 1, done.stderr  # with the assumed failures the required availability is missed
    return folder, done.stdout


def test_a_run_leaves_what_it_says(first: tuple[Path, str]) -> None:
    folder, printed = first
    summary = told(folder / "out")
    assert (summary["format"], summary["command"]) == ("retarder-synth-summary", "computer")
    pictures = {f"plots/computer-{name}" for name in ("waits", "checks", "traffic", "tornado")}
    sheets = {f"sheets/{name}.csv" for name in summary["tables"]}
    drawn = {f"{each}.svg" for each in pictures}
    assert set(summary["files"]) == {"configuration.toml", "report.html", *sheets, *drawn}
    speed, reliability, money = summary["limits"]
    assert speed["sentence"].startswith("speed: the allowed waits need 105,694 op/s")
    assert (speed["kept"], reliability["kept"], money["kept"]) == (True, False, None)
    assert f"not accepted: {reliability['sentence']}; {money['sentence']}" in printed
    page = (folder / "out" / "report.html").read_text(encoding="utf-8")
    places = [page.index(f"<h2>{heading}") for heading in ("What it pays", "How reliable", "How fast", "Parameters")]
    assert places == sorted(places)
    assert not re.search(r"\bnan\b", page, re.IGNORECASE)


def test_the_first_screen_tells_money_with_no_more_figures_than_its_spread_leaves(first: tuple[Path, str]) -> None:
    folder, _ = first
    page = (folder / "out" / "report.html").read_text(encoding="utf-8")
    (row,) = (each for each in told(folder / "out")["tables"]["draws"] if each["output"] == "net present value")
    low, middle, high = (row[each]["value"] for each in ("q05", "q50", "q95"))
    (number, letter) = re.findall(r"<strong>(-?[\d.]+)([kM]) EUR</strong><p>net present value", page)[0]
    shown = float(number) * {"k": 1e3, "M": 1e6}[letter]
    assert abs(shown - middle) <= 0.05 * (high - low)
    assert len(number.strip("-").replace(".", "").strip("0")) <= len(f"{high - low:.0f}") - 4
    assert page.index("Find out ") < page.index("<h2>")
    (row,) = (each for each in told(folder / "out")["tables"]["draws"] if each["output"] == "pay back years")
    assert (row["q95"]["value"], 0.05 < row["never"]["value"] < 0.5) == (None, True)  # most draws pay back, not 95 %
    never = f"never in {100.0 * row['never']['value']:.3g} %"
    assert f"<p>it is paid back in the median; {never} of the draws" in page
    assert f"in the median and {never} [" in page
    assert "95 of 100 pay back" not in page


def test_the_published_computer_is_the_default(first: tuple[Path, str]) -> None:
    """120 000 op/s keep both waits of [hump-computer-1970s]; a cycle takes 1 000 000 op/s."""
    tables = told(first[0] / "out")["tables"]
    (task,) = tables["waits"]
    assert task["mean_wait_s"] == pytest.approx(0.825 * 0.0044444 / 2.0 / (1.0 - 0.055), rel=1e-4)
    assert task["long_share"] < 0.001
    assert tables["needed_speed"][-1]["speed_op_s"] == pytest.approx(1e6)


def test_limits_that_are_missed_are_told_and_change_the_exit_code(tmp_path: Path, pages: list[Page]) -> None:
    slow = "[service]\nsimulated_requests = 3000\nspeed_op_s = 60000.0\n[uncertainty]\ndraws = 200\nsobol_points = 16\n"
    config = written(tmp_path / "c.toml", slow + "[acceptance]\npay_back_years = 0.1\nloss_per_year = 1.0\n")
    assert main(["computer", str(config), "-o", str(tmp_path / "out")]) == 1
    summary, page = told(tmp_path / "out"), page_about(pages, tmp_path / "out")
    limits = summary["limits"]
    assert [limit["kept"] for limit in limits] == [False, False, False]
    assert page[-2] == PrintedVerdict(False, "; ".join(limit["sentence"] for limit in limits))
    assert next(each.table.title for each in page if isinstance(each, PrintedTable)) == "Over all uncertain inputs"


def test_a_pay_back_that_never_comes_is_a_statement(tmp_path: Path) -> None:
    text = f"range = []\n{FEW}[terms]\ninvestment = 1e12\n[output]\nplots = false\nreport = false\n"
    config = written(tmp_path / "c.toml", text)
    done = run("computer", str(config), "-o", str(tmp_path / "out"), "--json")
    assert done.returncode == 1, done.stderr
    document = json.loads(done.stdout)
    assert document["limits"][-1]["kept"] is False
    assert "never pays back" in document["limits"][-1]["sentence"]
    figures = {row["figure"]: row["value"] for row in document["tables"]["economics"]}
    assert figures["pay back years"] is None
    assert {name.partition("/")[0] for name in document["files"]} == {"configuration.toml", "sheets"}


def test_an_overloaded_hump_is_the_fault_of_the_input(tmp_path: Path) -> None:
    config = written(tmp_path / "c.toml", FEW + "[traffic]\ncars_per_day = 30000.0\n")
    done = run("computer", str(config), "-o", str(tmp_path / "out"))
    assert (done.returncode, done.stdout) == (2, "")
    assert "overloaded" in done.stderr
    assert "Traceback" not in done.stderr
    assert not (tmp_path / "out" / SUMMARY).exists()


@pytest.mark.long
def test_figures_of_the_hump_come_from_its_trials(tmp_path: Path) -> None:
    """Two trials of the same trains: their differences are paired, and are the ranges of the changes."""
    for name, std in (("today", 0.35), ("new", 0.03)):
        text = "".join(f"[[position]]\nnumber = {k}\nexit_std_m_s = {std}\n" for k in (1, 2, 3))
        judged = "[acceptance]\ncatch_ups = 1\noverspeed = 1\n[output]\nplots = false\nreport = false\n"
        text = f"[trains]\nnumber = 20\ncuts = 12\n{text}{judged}"
        trial = written(tmp_path / f"{name}.toml", text)
        assert run("hump", "simulate", str(trial), "-o", str(tmp_path / name)).returncode == 0
    config = written(tmp_path / "c.toml", FEW + '[rates]\ntoday_trial = "today"\nnew_trial = "new"\n')
    done = run("computer", str(config), "-o", str(tmp_path / "out"))
    assert done.returncode in (0, 1), done.stderr
    summary, trial_summary = told(tmp_path / "out"), told(tmp_path / "today")
    (cars,) = (row["mean"] for row in trial_summary["tables"]["means"] if row["name"] == "cars_per_hour")
    assert summary["config"]["today"]["cars_per_h"] == pytest.approx(cars["value"])
    assert "change.gap_m" in {bar["input"] for bar in summary["tables"]["tornado"]}


EXAMPLE = ROOT / "docs" / "examples" / "bench"
LEAST = 10


@pytest.fixture(scope="session")
def client(tuned_once: tuple[Path, int], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The worked example, built with the exported C as its page says."""
    if shutil.which("cc") is None:
        pytest.skip("there is no C compiler")
    folder = tmp_path_factory.mktemp("client")
    for file in (*(tuned_once[0] / "c").glob("*.[ch]"), *EXAMPLE.glob("*.[ch]")):
        shutil.copy(file, folder)
    strict = ["-Wall", "-Wextra", "-Werror", "-pedantic"]
    order = ["cc", "-std=c99", "-O2", *strict, "-I.", "-o", "client", "client.c", "retarder_table.c"]
    subprocess.run(order, cwd=folder, check=True)
    return folder / "client"


@contextmanager
def connected(client: Path, port: int, offset_m_s: float) -> Iterator[None]:
    """Within, the client runs, as soon as somebody listens."""
    over = threading.Event()

    def run() -> None:
        while not over.is_set():
            subprocess.run([client, HOST, str(port), str(offset_m_s)], stderr=subprocess.DEVNULL, check=False)
            over.wait(0.05)

    thread = threading.Thread(target=run)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


@pytest.mark.parametrize(("offset_m_s", "code"), [(0.0, 0), (0.5, 1)], ids=["the-exported-c", "wrong-on-purpose"])
def test_the_exported_c_keeps_the_promise_and_a_wrong_controller_does_not(
    command: Command, client: Path, tuned_once: tuple[Path, int], tmp_path: Path, offset_m_s: float, code: int
) -> None:
    port = free_port()
    words = ("--in-step", "--passes", LEAST, "--modbus", f"{HOST}:{port}", "--page", "none", "-o", tmp_path / "out")
    with connected(client, port, offset_m_s):
        ran = command("bench", tuned_once[0], *words)
    assert ran.code == code
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    [all_cuts, *each] = summary["tables"]["scores"]
    assert all_cuts["cuts"] == LEAST == sum(row["cuts"] for row in each)
    assert (tmp_path / "out" / "bench_wires.h").read_text() == c_header()
    assert "0 of " in ran.out
    low, high = all_cuts["range_m_s"]
    assert low < all_cuts["predicted_rms_m_s"] < 2 * high
    if offset_m_s:
        assert all_cuts["rms_m_s"] > 5 * high
    else:
        assert low < all_cuts["rms_m_s"] < high
        assert all_cuts["ratio"] == pytest.approx(1.0, abs=1e-9)
        assert all_cuts["switchings"] == all_cuts["switchings_by_table"]


def test_the_header_of_the_example_is_that_of_the_wires() -> None:
    assert (EXAMPLE / "bench_wires.h").read_text() == c_header()


def test_addresses_that_cannot_be_are_refused(command: Command, tuned_once: tuple[Path, int], tmp_path: Path) -> None:
    with socket.create_server((HOST, 0)) as taken:
        at = f"{HOST}:{taken.getsockname()[1]}"
        for words, sentence in (
            (("--modbus", at), f"--modbus is {at}, where nothing can listen (Address already in use); give another"),
            (
                ("--modbus", "5020"),
                "--modbus is '5020'; it must be HOST:PORT, as 127.0.0.1:5020 for this machine alone",
            ),
            (("--page", f"{HOST}:0"), f"--page is '{HOST}:0'; it must be HOST:PORT"),
            (("--modbus", "none"), "--modbus none, and no --opc-ua: no controller could come"),
            (("--modbus", at, "--opc-ua", at), "two of them name one address; give each a port of its own"),
            (("--passes", "9"), "--passes is '9'; it must be a whole number from 10 to 1000"),
        ):
            ran = command("bench", tuned_once[0], *words, "-o", tmp_path / "out")
            assert (ran.code, sentence in ran.sentence) == (2, True), ran.err
    assert not (tmp_path / "out").exists()


def test_a_missing_library_is_one_sentence(
    command: Command, tuned_once: tuple[Path, int], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "asyncua", None)
    ran = command("bench", tuned_once[0], "--opc-ua", f"{HOST}:{free_port()}", "-o", tmp_path / "out")
    assert ran.code == 2
    assert ran.sentence == "--opc-ua needs what speaks it: pip install 'retarder-synth[bench]'"


def test_tables_for_point_sensors_are_refused(command: Command, tmp_path: Path) -> None:
    (tmp_path / "passages.json").write_bytes(to_json(table_of()))
    ran = command("bench", tmp_path / "passages.json", "-o", tmp_path / "out")
    assert (ran.code, "bench takes tables for a radar" in ran.sentence) == (2, True)
