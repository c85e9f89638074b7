"""`retarder-synth verify`: exit codes, output, start-up; known defects are in order and warned of."""

from __future__ import annotations

import html
import json
import random
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from scripts.documentation.known_defects_page import defects_text
from synth.checker.code_export import code_at
from synth.cli import main
from synth.frame.version import PLACE, Defect, known_defects, release
from tests.effort import sized
from tests.tuning_tables.every_kind import smallest_aim, smallest_lines, smallest_points
from tuning_tables import document, write_json
from tuning_tables.document import to_document


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


MADE_UP = Defect(
    id="RS-0", introduced="0.0.9", fixed=None, kinds=("lines",), steps=("made", "exported"), unsafe=True,
    wrong="lines lie 1 m/s too high", effect="cuts leave too fast", detect="validate them", remedy="tune again",
)  # fmt: skip
KEYS = [*MADE_UP.__dataclass_fields__]


@pytest.fixture(params=[True, False], ids=["unsafe", "safe"])
def unsafe(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> bool:
    """Whether the made-up defect, which the program then knows, makes tables unsafe."""
    listed = {**vars(MADE_UP), "unsafe": request.param}
    (tmp_path / "defects.json").write_text(json.dumps({"defects": [listed]}), encoding="utf-8")
    monkeypatch.setattr("synth.frame.version.PLACE", tmp_path / "defects.json")
    return bool(request.param)


@pytest.mark.requirement("VERIFY-07")
@pytest.mark.parametrize("name", ["", "book.h5"])
def test_tables_of_a_version_with_a_defect_are_named(
    tuned_once: Path, name: str, unsafe: bool, capfd: pytest.CaptureFixture[str]
) -> None:
    count = 2 + len(code_at(tuned_once / name))
    for words, code in ((("verify", "--passes", "100"), int(unsafe)), (("inspect",), 0)):
        capfd.readouterr()
        assert main([*words, str(tuned_once / name)]) == code
        printed = " ".join(capfd.readouterr().out.split())
        warning = f"known defect RS-0{', unsafe' * unsafe}: a version that has it made or exported {count} of these: "
        assert warning in printed
        assert printed.endswith(": nothing found, but made by a version with an unsafe defect") == bool(code)
        assert main([*words, str(tuned_once / name), "--json"]) == code
        told = json.loads(capfd.readouterr().out)
        assert [(each["id"], each["unsafe"], len(each["tables"])) for each in told["known_defects"]] == [
            ("RS-0", unsafe, count)
        ]
        assert told.get("exit_code", 0) == code


@pytest.mark.parametrize(
    ("made_by", "introduced", "fixed", "is_concerned"),
    [
        ("0.1.0", "0.1.0", None, True),
        ("0.1", "0.1.0", "0.1.1", True),
        ("0.1.1", "0.1.0", "0.1.1", False),
        ("0.1.10", "0.1.9", "0.1.11", True),
        ("0.0.9", "0.1.0", None, False),
        ("1.0rc1", "1.0", None, True),
        ("a build of ours", "0.1.0", "0.1.1", True),  # it cannot be told, so it is taken for one that has it
    ],
)
def test_a_defect_concerns_the_versions_that_have_it(
    made_by: str, introduced: str, fixed: str | None, is_concerned: bool
) -> None:
    for kind in ("lines", "passages"):
        each = Defect(**{**vars(MADE_UP), "introduced": introduced, "fixed": fixed, "kinds": (kind,)})
        for made in (smallest_lines, smallest_points, smallest_aim):
            table: dict[str, Any] = to_document(made())
            table["generator"], exported = {"name": "by hand", "version": "9"}, f"retarder-synth {made_by}"
            assert each.concerns({**table, "exported_by": exported}) == (is_concerned and table["kind"] == kind)
            table |= {"generator": {"name": "retarder-synth", "version": made_by}, "exported_by": "another one"}
            assert each.concerns(table) == (is_concerned and table["kind"] == kind)
            assert not replace(each, steps=("exported",)).concerns(table)
            assert not each.concerns({**table, "generator": {"name": "another program", "version": made_by}})


def test_inspect_warns_of_a_table_by_the_version_that_exported_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    with monkeypatch.context() as later:
        later.setattr(document, "exporter", lambda: "retarder-synth 98.7")
        write_json(smallest_lines(), tmp_path / "later.json")
    write_json(smallest_lines(), tmp_path / "now.json")
    monkeypatch.setattr(
        "synth.frame.version.known_defects", lambda: (replace(MADE_UP, introduced="98", steps=("exported",)),)
    )
    for name in ("later", "now"):
        assert main(["inspect", str(tmp_path / f"{name}.json")]) == 0
        assert ("known defect RS-0" in capfd.readouterr().out) == (name == "later")


def test_a_program_that_tells_no_version_may_have_any_defect() -> None:
    assert MADE_UP.concerns({"kind": "lines", "exported_by": "retarder-synth"})


@pytest.mark.usefixtures("unsafe")
def test_the_page_has_a_row_for_each() -> None:
    assert "| RS-0 | from 0.0.9 | lines (made, exported) | " in defects_text()


def test_the_list_that_ships_is_in_order() -> None:
    listed = json.loads(PLACE.read_text(encoding="utf-8"))["defects"]
    assert [each for each in listed if list(each) != KEYS] == []
    found = known_defects()
    assert len({each.id for each in found}) == len(found)
    for each in found:
        assert release(each.introduced)
        assert each.fixed is None or release(each.introduced) < release(each.fixed)
        assert set(each.kinds) <= {"lines", "passages", "aim"}
        assert set(each.steps) <= {"made", "exported"}
        assert all(vars(each)[key] for key in KEYS if key not in ("fixed", "unsafe"))
