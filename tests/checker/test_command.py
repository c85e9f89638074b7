"""`retarder-synth verify`: exit codes, output, start-up, and whatever bytes it is fed."""

from __future__ import annotations

import html
import json
import random
import re
import subprocess
import sys
from pathlib import Path

import pytest

from synth.checker.verdict import verify
from synth.cli import main
from tests.effort import sized


def test_words_and_exit_code(tuned_once: Path, capfd: pytest.CaptureFixture[str]) -> None:
    capfd.readouterr()
    assert main(["verify", str(tuned_once), "--passes", "100"]) == 0
    out, err = capfd.readouterr()
    assert err == ""
    lines = out.splitlines()
    assert len(lines) == 3
    assert all(": ok; rms " in line for line in lines[:2])
    assert lines[2].endswith("files: nothing found")


def test_a_page_tells_what_is_printed(tuned_once: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    for words in (("verify", str(tuned_once), "--passes", "100"), ("inspect", str(tuned_once))):
        capfd.readouterr()
        assert main([*words, "-o", str(tmp_path / words[0])]) == 0
        page = html.unescape((tmp_path / words[0] / "report.html").read_text(encoding="utf-8"))
        plain = " ".join(re.sub(r"<[^>]+>", " ", page).split())
        printed = re.sub("(?m)^accepted: ", "", capfd.readouterr().out)  # a heading of the page
        lines = [line for line in printed.splitlines() if ": " in line]
        assert len(lines) > 2
        assert [line for line in lines if " ".join(line.split()) not in plain] == []
        assert ("Load the tables" in page) == (words[0] == "verify")
    assert main(["verify", str(tuned_once), "--passes", "100", "-o", str(tuned_once)]) == 2


def test_json(tuned: Path, capfd: pytest.CaptureFixture[str]) -> None:
    min((tuned / "tables").glob("*.json")).write_bytes(b"{}")
    capfd.readouterr()
    assert main(["verify", str(tuned), "--passes", "100", "--json"]) == 3
    found = json.loads(capfd.readouterr().out)
    assert found["exit_code"] == 3
    assert not found["confirmed"]
    assert {finding["kind"] for finding in found["findings"]} >= {"damaged", "disagrees"}
    assert {"id", "ok", "skipped", "predicted_rms_m_s", "simulated", "exit_gap_m_s"} == set(found["tables"][0])


@pytest.mark.parametrize("missing", ["nowhere", "empty"])
def test_nothing_to_read(tmp_path: Path, missing: str, capfd: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "empty").mkdir()
    capfd.readouterr()
    assert main(["verify", str(tmp_path / missing)]) == 2
    out, err = capfd.readouterr()
    assert out == ""
    assert err.startswith("retarder-synth: ")
    assert err.count("\n") == 1


def test_a_table_is_verified_without_numpy(tuned_once: Path) -> None:
    table = min((tuned_once / "tables").glob("*.json"))
    source = (
        "import sys; from synth.cli import main; code = main(['verify', sys.argv[1], '--passes', '100']); "
        "print(*sorted({name.partition('.')[0] for name in sys.modules}), file=sys.stderr); raise SystemExit(code)"
    )
    ran = subprocess.run(
        [sys.executable, "-c", source, str(table)], capture_output=True, text=True, timeout=60, check=False
    )
    assert ran.returncode == 0, ran.stderr
    loaded = set(ran.stderr.split())
    assert loaded.isdisjoint({"numpy", "scipy", "numba", "h5py", "tuning_tables", "plant_models"})


WAYS = sized(8, 25)


def broken(content: bytes, chance: random.Random) -> bytes:
    """`content` with a few bytes changed, dropped or doubled, or cut off."""
    found = bytearray(content)
    for _ in range(chance.randint(1, 4)):
        at = chance.randrange(len(found))
        match chance.randrange(4):
            case 0:
                found[at] = chance.randrange(256)
            case 1:
                del found[at : at + chance.randint(1, 20)]
            case 2:
                found[at:at] = found[at : at + chance.randint(1, 20)]
            case _:
                found[at] = ord(chance.choice('0123456789-+eE.,:"{}[]nN'))
        if not found:
            return b"\0"
    return bytes(found[: chance.randrange(1, len(found))]) if chance.random() < 0.1 else bytes(found)


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "comments"),
    [("tables/*1.5*.json", False), ("tables/*1.5*.csv", False), ("book.h5", False), ("c/retarder_table.c", False),
     ("c/retarder_table.h", False), ("c/golden_vectors.csv", False), ("st/retarder_table.st", True),
     ("summary.json", True)],
)  # fmt: skip
def test_broken_bytes_never_raise(tuned: Path, name: str, comments: bool) -> None:
    """A file broken in many ways: a verdict each time. With `comments`, much of it is of no concern to the checker."""
    (file,) = tuned.glob(name)
    whole, chance, codes = file.read_bytes(), random.Random(name), []
    for _ in range(WAYS):
        file.write_bytes(broken(whole, chance))
        if file.read_bytes() != whole:
            codes.append(verify(tuned, 2, 1).code)
    if comments:
        assert codes.count(3) >= WAYS // 5
    else:
        assert set(codes) == {3}


@pytest.mark.long
@pytest.mark.parametrize("name", ["tables/*1.5*.json", "book.h5", "c/retarder_table.c", "c/golden_tracks.csv"])
def test_broken_bytes_of_an_estimator_never_raise(estimated: Path, name: str) -> None:
    (file,) = estimated.glob(name)
    whole, chance, codes = file.read_bytes(), random.Random(name), []
    for _ in range(WAYS):
        file.write_bytes(broken(whole, chance))
        if file.read_bytes() != whole:
            codes.append(verify(estimated, 2, 1).code)
    assert set(codes) == {3}
