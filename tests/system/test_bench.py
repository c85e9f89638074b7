"""`bench`: the exported C at the end of a cable keeps its tables' promise, a wrong controller does not; refusals."""

from __future__ import annotations

import json
import shutil
import socket
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from synth.retarder.bench.wires import c_header
from tests.corpus import ROOT
from tests.synth.bench.played import HOST, free_port
from tests.system.conftest import Command
from tests.tuning_tables.passages.made_tables import table_of
from tuning_tables import to_json

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
