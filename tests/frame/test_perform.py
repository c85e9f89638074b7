"""A command of the frame from words to files: every medium says the same, and what is refused leaves nothing."""

from __future__ import annotations

import csv
import hashlib
import json
import math
from pathlib import Path
from typing import Any

import pytest
import typer
from hypothesis import assume, given
from hypothesis import strategies as st
from typer.testing import CliRunner

from plant_models import PlantError
from synth.frame.command import Limit, Verdict
from synth.frame.command_line import CommandGuide, Listed, Shown, add_listed, listed_group
from synth.frame.exhibits import Chapter, Column, Table, brief_value
from synth.frame.faults import InputError
from synth.frame.interval import Interval
from synth.frame.page.told_page import shown
from synth.frame.perform import asked_of
from synth.frame.printed_numbers import ABSENT, as_known
from synth.frame.sheet import to_csv
from synth.frame.terminal.progress import pace
from synth.frame.told import Told, plain, rows_of
from tests.frame.small_command import COMMAND, CoinOptions, results_in
from tuning_tables.json_text import canonical_json

LISTED = Listed(
    "throw coins",
    "tests.frame.small_command:COMMAND",
    "tests.frame.small_command:CoinOptions",
    "init --coin",
    "Throw coins.\n\nFor nothing.",
)


GUIDE = CommandGuide("throw", {"All": ("coins", "other")}, {"coins": Shown("throw coins", "coins.md")})


@pytest.fixture
def app(monkeypatch: pytest.MonkeyPatch) -> typer.Typer:
    """A program with this command."""
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    made = typer.Typer(cls=listed_group([LISTED], GUIDE))
    made.command("other")(lambda: 0)
    add_listed(made, [LISTED])
    return made


def run(app: typer.Typer, *words: str) -> tuple[int, str]:
    """Exit code, and what is on stdout."""
    found = CliRunner().invoke(app, ["coins", *words], standalone_mode=False, catch_exceptions=False)
    return found.return_value, found.stdout


def summary(folder: Path) -> dict[str, Any]:
    """summary.json."""
    read: dict[str, Any] = json.loads((folder / "summary.json").read_bytes())
    return read


@pytest.mark.requirement("CMD-08")
def test_every_medium_tells_the_same_figures(app: typer.Typer, tmp_path: Path) -> None:
    code, printed = run(app, "-o", str(tmp_path))
    assert code == 0
    told = summary(tmp_path)
    share = told["tables"]["shares"][0]["share"]
    with (tmp_path / "sheets" / "shares.csv").open(encoding="utf-8", newline="") as file:
        first, _, nobody = csv.DictReader(file)
    columns = {"value": "share", "low95": "share_low95", "high95": "share_high95", "n": "share_n"}
    assert {part: float(first[column]) for part, column in columns.items()} == share
    assert first["told_by"] == "'=dice"  # no formula for a spreadsheet
    assert set(nobody.values()) == {"nobody", ""}
    words = f"{share['value']:.2f} [{share['low95']:.2f}, {share['high95']:.2f}]"
    half = max(share["high95"] - share["value"], share["value"] - share["low95"])
    assert f"{share['value']:.2f} ±{half:.2f}" in printed
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert words in page
    assert 'class="bad"' in page
    assert "=dice" in page
    assert "=dice" not in printed
    assert "Coins are not dice." in page
    assert told["figures"] == {"players": 2}
    assert told["tables"]["shares"][-1] == {"player": "nobody", "share": None, "throws": None, "told_by": None}


def test_the_summary_names_every_file_with_its_hash_and_is_what_json_prints(app: typer.Typer, tmp_path: Path) -> None:
    code, printed = run(app, "-o", str(tmp_path), "--json")
    assert (code, printed) == (0, (tmp_path / "summary.json").read_text(encoding="utf-8"))
    told = summary(tmp_path)
    files = {"coins.txt", "plots/coins.svg", "report.html", "sheets/shares.csv"}
    assert set(told["files"]) == files
    for name, digest in told["files"].items():
        assert hashlib.sha256((tmp_path / name).read_bytes()).hexdigest() == digest
    assert (told["command"], told["accepted"], told["limits"][0]["kept"]) == ("throw coins", True, True)


@pytest.mark.requirement("CMD-03")
@pytest.mark.parametrize(
    ("text", "kept"), [("[coin]\nheads = 0.95\n", False), ("[coin]\nheads = 0.75\n", None)], ids=["missed", "open"]
)
def test_a_limit_that_is_missed_or_open_gives_one(
    app: typer.Typer, tmp_path: Path, text: str, kept: bool | None
) -> None:
    (tmp_path / "c.toml").write_text(text, encoding="utf-8")
    code, printed = run(app, str(tmp_path / "c.toml"), "-o", str(tmp_path / "out"))
    assert code == 1
    assert f"{'not accepted' if kept is False else 'not decidable'}: the luckiest wins" in printed
    assert [limit["kept"] for limit in summary(tmp_path / "out")["limits"]] == [kept]
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert ("missed: the luckiest" if kept is False else "not decidable: the luckiest") in page


def test_the_same_question_gives_the_same_bytes_and_options_count(app: typer.Typer, tmp_path: Path) -> None:
    for name, words in (("one", ()), ("two", ()), ("other", ("--throws", "50"))):
        assert run(app, "-o", str(tmp_path / name), *words)[0] == 0
    one, two, other = (results_in(tmp_path / name) for name in ("one", "two", "other"))
    assert one == two
    assert one["sheets/shares.csv"] != other["sheets/shares.csv"]
    assert summary(tmp_path / "other")["warnings"] == ["few throws"]
    assert summary(tmp_path / "other")["config"]["throws"] == 50


def test_what_is_only_asked_is_written(app: typer.Typer, tmp_path: Path) -> None:
    (tmp_path / "c.toml").write_text("[output]\nplots = false\nreport = false\n", encoding="utf-8")
    assert run(app, str(tmp_path / "c.toml"), "-o", str(tmp_path / "out"))[0] == 0
    assert set(summary(tmp_path / "out")["files"]) == {"coins.txt", "configuration.toml", "sheets/shares.csv"}


@pytest.mark.parametrize(
    ("text", "words", "sentence"),
    [
        ("[coin]\nhead = 0.5\n", (), "coin.head = 0.5 is an unknown key; did you mean heads?"),
        ("[coin]\nheads = 1.5\n", (), "coin.heads is 1.5; it must be from 0 to 1"),
        ("[coin]\nside = 'edge'\n", (), "coin.side is 'edge'; a coin has heads and tails"),
        ("", ("--throws", "3"), "--throws is '3'; it must be a whole number from 10 to 10000"),
        ("", ("--throws", "many"), "--throws is 'many'; it must be a whole number from 10 to 10000"),
    ],
)
def test_a_refusal_is_one_sentence_and_leaves_nothing(
    app: typer.Typer, tmp_path: Path, text: str, words: tuple[str, ...], sentence: str
) -> None:
    (tmp_path / "c.toml").write_text(text, encoding="utf-8")
    with pytest.raises((InputError, PlantError)) as caught:
        run(app, str(tmp_path / "c.toml"), "-o", str(tmp_path / "out"), *words)
    assert str(caught.value).endswith(sentence)
    assert not (tmp_path / "out").exists()


def test_no_medium_tells_of_what_is_not_a_number() -> None:
    column = Column("rms", "rms")
    table = Table("cases", "Cases", (column,), [{"rms": math.nan}, {"rms": None}])
    assert {column.text(row) for row in table.rows} == {ABSENT}
    assert to_csv(table).splitlines()[1:] == to_csv(Table("cases", "Cases", (column,), [{}, {}])).splitlines()[1:]
    assert plain(rows_of(table)) == [{"rms": None}] * 2


@pytest.mark.parametrize("number", [2**53, 2**53 + 1, -(2**53) - 1, 10**40])
def test_a_whole_number_is_exact_in_json(number: int) -> None:
    told = json.loads(canonical_json(plain({"seed": number})))["seed"]
    assert (int(told), isinstance(told, int)) == (number, number == 2**53)


@given(value=st.floats(0.1, 2.0), below=st.floats(0.0, 1.0), above=st.floats(0.0, 1.0))
def test_a_brief_interval_reaches_as_far_as_the_whole_one(value: float, below: float, above: float) -> None:
    assume(max(below, above) > 0.001)
    assume(value > max(below, above))  # else ± would tell of numbers below zero
    told = brief_value(Interval(value, value - below, value + above, 9), "{:.3f}".format)
    assert float(told.partition(" ±")[2]) == pytest.approx(max(below, above), abs=0.00051)


def test_what_never_comes_has_no_half_width() -> None:
    never = "{:.0f}".format
    assert brief_value(Interval(math.inf, math.inf, math.inf, 9), never) == "inf"
    assert brief_value(Interval(2.0, 1.0, math.inf, 9), never) == "2 [1, inf]"


@pytest.mark.parametrize(
    ("value", "low", "high", "told"),
    [
        (0.01, 0.0013, 0.0344, "0.01 [0.0013, 0.0344]"),  # a share: ± would reach below 0
        (-0.01, -0.0344, -0.0013, "-0.01 [-0.0344, -0.0013]"),
        (0.01, -0.002, 0.0344, "0.01 ±0.0244"),  # a difference, whose sign is not decided
        (1.7, 1.7 - 7e-16, 1.7, "1.7 [1.7, 1.7]"),  # a mean of equal speeds
    ],
)
def test_half_an_interval_tells_no_more_than_all_of_it(value: float, low: float, high: float, told: str) -> None:
    assert brief_value(Interval(value, low, high, 9), "{:.3g}".format) == told


@pytest.mark.parametrize(
    ("value", "low", "high", "told"),
    [
        (2_970_355.0, -19.2e6, 19.9e6, 3e6),
        (933_211.0, -461e3, 2.43e6, 9e5),
        (1.2345, 1.2, 1.25, 1.234),
        (7.0, 7.0, 7.0, 7.0),
    ],
)
def test_an_amount_has_no_more_figures_than_it_is_known_to(value: float, low: float, high: float, told: float) -> None:
    assert as_known(value, low, high) == pytest.approx(told, rel=1e-12)


def test_what_is_missed_is_told_before_what_is_not_decided() -> None:
    verdict = Verdict((Limit("kept", True), Limit("open", None), Limit("missed", False)))
    assert (verdict.kept, verdict.sentence) == (False, "missed; open")


def test_what_is_for_programs_is_not_shown_to_people() -> None:
    table = Table("cuts", "Cuts", (Column("title", "of"), Column("name", "code", code=True)), [{"title": 1, "name": 2}])
    assert [column.key for column in table.seen] == ["title"]
    assert to_csv(table).splitlines()[-1] == b"1,2"


def test_a_rate_is_told_where_there_is_one() -> None:
    assert pace(0.2, 1, 0.0, "cases") == "0.2 s"
    assert pace(219.0, 1, 3066.0, "cases") == "219 s, 0.27 cases a minute, about 3066 s left"


def test_a_long_table_is_named_on_the_page_and_not_shown() -> None:
    table = Table(
        "passes", "Every pass", (Column("cut", "cut", words=True),), [{"cut": "A-1"}, {"cut": "A-2"}], long=True
    )
    page = shown(table, {})
    assert f"2 rows in {table.file}." in page
    assert "A-1" not in page


def test_the_help_tells_what_is_declared(app: typer.Typer) -> None:
    told = CliRunner().invoke(app, ["coins", "--help"]).stdout
    assert "Throw coins." in told
    assert "--throws N" in " ".join(told.split())
    assert "Throws of each player; as configured unless given." in " ".join(told.split())


def test_a_table_without_rows_is_a_word_on_the_page() -> None:
    assert "None." in shown(Table("shares", "Shares", (Column("share", "share"),), ()), {})


def test_two_exhibits_of_one_name_are_a_fault_of_the_command() -> None:
    table = Table("shares", "Shares", (Column("share", "share"),), ())
    head = COMMAND.head(COMMAND.resolve(asked_of(COMMAND, CoinOptions(), "init")))
    with pytest.raises(ValueError, match="'coins' shows twice: table shares"):
        Told("coins", head, "", Verdict(()), (Chapter("One", (table,)), Chapter("Two", (table,))), ())
