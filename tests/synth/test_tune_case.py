"""A tune of one case, what it leaves, and what makes no book.

One small case through the whole chain, and the pieces that only it has: bound, map, feasibility.
Pieces of what a tune leaves: drawing in processes, names of files, the summary beside tables.
What every command that tunes does around its tune.
The book that a file names: refused in one sentence where it is of another position or fits no class.
"""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any, NoReturn

import pytest

from synth.frame.exhibits import Chart
from synth.frame.faults import InputError
from synth.frame.picture.studio import Studio, draw_chart
from synth.frame.workers.engine import Teller
from synth.retarder.asked_tune import AskedTune, RadarEpochs, tuned
from synth.retarder.case_result import CaseResult
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.estimation.estimated_lines import estimate_chain
from synth.retarder.failed_case import FailedCase
from synth.retarder.forms.tables_at import file_stem, is_infeasible
from synth.retarder.shown.pictures import case_chart, feasibility
from synth.retarder.table_class import book_classes
from synth.retarder.tune import Book, no_notice, tune
from synth.simulation.controllers import TableController
from synth.solver.backward_induction import policy_map, share_of_ties, solve
from tests.synth.case_factory import make_case
from tests.synth.hump.trains.coarse_book import PARK, coarse_classes
from tuning_tables import ControllerTable, InvalidTable, read_json, write_book, write_json

SMALL = """
[[cut]]
car = "gondola-4"
mass_t = 52.0
[targets]
exit_speeds_m_s = [3.0, 4.0]
[grid]
path_step_m = 0.5
speed_step_m_s = 0.05
friction_scenarios = 4
resistance_scenarios = 3
[validation]
passes = 4000
"""


def stored(table: ControllerTable, directory: Path) -> ControllerTable:
    """The table as it is read back from a file in `directory`."""
    write_json(table, directory / f"{table.id}.json")
    return read_json(directory / f"{table.id}.json")


@pytest.fixture(scope="module")
def directory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("tables")


@pytest.fixture(scope="module")
def book(directory: Path) -> Book[CaseResult]:
    said: list[str] = []
    store = partial(stored, directory=directory)
    result = tune(parse_config(SMALL, "small.toml"), RadarEpochs(), store, Teller(said.append), workers=2)
    assert any("to 4 m/s" in sentence for sentence in said)
    return result


@pytest.fixture
def case(book: Book[CaseResult]) -> CaseResult:
    return book.cases[0]


@pytest.mark.requirement("PRED-06")
def test_the_table_on_disk_is_the_one_that_was_validated(book: Book[CaseResult], directory: Path) -> None:
    assert sorted(p.name for p in directory.iterdir()) == sorted(f"{c.table.id}.json" for c in book.cases)
    for case in book.cases:
        assert read_json(directory / f"{case.table.id}.json") == case.table
        assert case.table.validated is not None
        assert case.table.validated.rms_m_s == case.statistics.rms_m_s
        assert json.loads((directory / f"{case.table.id}.json").read_bytes())["generator"]["name"] == "retarder-synth"


def test_the_map_agrees_with_the_lines_and_marks_indifference(case: CaseResult) -> None:
    """Far above its line a stage goes up, far below down, wherever that counts."""
    config = parse_config(SMALL, "small.toml")
    chain = estimate_chain(case.plant, config.resolution_of(case.plant), config.lowest_target_m_s)
    solution = solve(chain, config.aims_of(case.label)[0])
    chart, lines = policy_map(solution, 1e-4), solution.lines
    assert chart.command.shape == chart.indifferent.shape == (5, len(chart.path_m), len(chart.speed_m_s))
    assert not (chart.command[0] == -1).any()
    assert not (chart.command[-1] == 1).any()
    upper, lower = (each[:, : len(chart.path_m), None] for each in (lines.upper_m_s, lines.lower_m_s))
    above = (chart.speed_m_s > upper + 0.1) & (chart.speed_m_s < upper + 0.5)
    below = (chart.speed_m_s < lower - 0.1) & (chart.speed_m_s > lower - 0.5)
    for near, command in ((above, 1), (below, -1)):
        counts = near & ~chart.indifferent
        assert counts.sum() > 0.1 * near.sum() > 100
        assert (chart.command[counts] == command).all()
        assert (chart.command[near] == command).mean() > 0.8
    assert 0.0 < chart.indifferent.mean() < 1.0
    assert 0.0 < share_of_ties(solution) < chart.indifferent.mean()


def test_feasibility_falls_with_entry_speed(case: CaseResult) -> None:
    found = case.feasibility
    assert not case.unavoidable.forbids(found.limit_m_s)
    assert found.served_m_s is not None
    assert found.served_m_s[0] < case.target_speed_m_s  # downhill a slower cut reaches it too
    assert found.entry_rms_m_s[-1] > found.entry_rms_m_s[len(found.entry_m_s) // 2]


def test_drawings_do_not_depend_on_the_number_of_processes() -> None:
    charts = [case_chart(make_case()), case_chart(make_case("heavy", 2.0))]
    with Studio(2) as studio:
        studio.begin(charts[1])
        assert [each.result() for each in map(studio.drawing, charts)] == [draw_chart(each) for each in charts]


def test_a_fault_in_a_drawing_process_is_raised_here() -> None:
    with Studio(2) as studio, pytest.raises(ValueError, match="left cannot be"):
        studio.drawing(Chart("none", "", "", partial(feasibility, ()))).result()


def test_an_id_is_no_path() -> None:
    from dataclasses import replace

    table = make_case().table
    ids = ("../../etc/x", "a b/ц", ".hidden", "///")
    assert [file_stem(replace(table, id=name)) for name in ids] == ["etc-x", "a-b-ц", "hidden", "table"]


def test_only_the_summary_of_the_same_configuration_counts() -> None:
    table = make_case().table

    def summary(sha256: str, name: str) -> dict[str, object]:
        cases = [{"id": name, "verdict": "infeasible"}]
        return {"generator": {"config_sha256": sha256}, "tables": {"cases": cases}}

    assert is_infeasible(table, summary(table.generator.config_sha256, table.id))
    assert not is_infeasible(table, summary("0", table.id))
    assert not is_infeasible(table, summary(table.generator.config_sha256, "other"))
    assert not is_infeasible(table, None)


CONFIG = parse_config("", "x.toml")
WORK: Any = SimpleNamespace(progress=SimpleNamespace(note=print), directory=None)


@pytest.mark.parametrize(("cases", "sentence"), [((make_case(),), "two tables are alike"), ((), "no table for")])
def test_what_makes_no_book_is_refused_in_a_sentence_about_the_file(
    cases: tuple[Any, ...], sentence: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    failed = () if cases else (FailedCase("a class", 2.0, "too coarse"),)
    book: Book[Any] = Book(CONFIG, "2026-11-20T22:46:00Z", cases, failed)
    monkeypatch.setattr("synth.retarder.tune.tune", lambda *_: book)
    monkeypatch.setattr("synth.retarder.first_run.first_time", lambda: False)

    def found(_: Book[Any]) -> NoReturn:
        raise InvalidTable("two tables are alike.")

    with pytest.raises(InputError, match=f"^x.toml: .*{sentence}"):
        tuned(AskedTune(CONFIG, "x.toml", RadarEpochs(), 1), WORK, no_notice, found)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two tables of one class, one alone, and the configuration of all."""
    made, (single, pair) = tmp_path_factory.mktemp("book"), coarse_classes()
    (made / "coarse.toml").write_text(PARK, encoding="utf-8")
    for name, of_class, count in (("two.h5", single, 2), ("one.h5", pair, 1)):
        tables = [c.table for c in of_class.controllers[:count] if isinstance(c, TableController)]
        write_book([table for table in tables if isinstance(table, ControllerTable)], made / name)
    return made


def test_a_book_is_read_with_its_configuration(folder: Path) -> None:
    (single,) = book_classes("h.toml: book", folder / "two.h5", folder / "coarse.toml", "rnz-2m-park")
    assert single.targets_m_s == (1.5, 2.0)
    assert single.plant.cut.mass_t == 25.0
    assert single.loops[0].plant is single.plant


def test_a_book_that_does_not_fit_is_refused(folder: Path) -> None:
    other = "two.h5, whose table .* is for the position rnz-2m-park, but position is knp-5-bunch; give a book of that"
    with pytest.raises(InputError, match=f"h.toml: retarder 401: book names .*{other}"):
        book_classes("h.toml: retarder 401: book", folder / "two.h5", folder / "coarse.toml", "knp-5-bunch", "position")
    with pytest.raises(InputError, match=r"h.toml: book names .*one.h5, which does not fit: .* 1 targets"):
        book_classes("h.toml: book", folder / "one.h5", folder / "coarse.toml", "rnz-2m-park")
    with pytest.raises(InputError, match="no cut class fits the table"):
        book_classes("h.toml: book", folder / "two.h5", None, "rnz-2m-park")
