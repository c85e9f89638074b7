"""Results and options of studies, times taken in turns, and studies small enough to be known."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pytest

from scripts.studies import study as study_module
from scripts.studies.cases import class_cases, named_cases, of_masses, side_by_side
from scripts.studies.criteria import criteria
from scripts.studies.result import Result, read_result, run_study
from scripts.studies.study import Findings, MarkdownTable, Method, Study, option, options_from, parser_of, table
from scripts.studies.timing import Ratio, Times, in_turns, speed_against, timed
from synth.frame.faults import InputError
from synth.problem.criterion import SQUARED_ERROR_CRITERION
from synth.retarder.configuration.config_file import load_config


@dataclass(frozen=True)
class Options:
    """Of a study that counts."""

    passes: int = option(10, "how many")


@dataclass(frozen=True)
class Row:
    """A case, an interval, something that may be absent."""

    case: str
    ends: tuple[float, float]
    ratio: float | None


@dataclass(frozen=True)
class Counted(Findings):
    """What counting finds."""

    rows: tuple[Row, ...]
    shares: dict[str, float]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """One row a case."""
        return {"rows": table("rows", ("case", "low"), ((row.case, f"{row.ends[0]:g}") for row in self.rows))}


FOUND = Counted((Row("a [b, c] ü", (0.1, 1e-17), None), Row("d", (-1.0, 2.0), 0.5)), {"rms": 1.0 / 3.0})
METHOD = Method(Options, Options(1), Counted, lambda options, tell: FOUND)


@pytest.fixture
def study(monkeypatch: pytest.MonkeyPatch) -> Study:
    monkeypatch.setattr(study_module, "import_module", lambda name: __import__("types").SimpleNamespace(METHOD=METHOD))
    return Study("counted", "How many?", 1.0, "", "nowhere")


def left(study: Study, path: Path, changes: dict[str, Any]) -> Path:
    document = json.loads(run_study(study).json()) | changes
    (path / "counted.json").write_text(json.dumps(document), encoding="utf-8")
    return path / "counted.json"


def test_a_result_is_read_back_with_every_bit_and_type(study: Study, tmp_path: Path) -> None:
    result = run_study(study, Options(7))
    (tmp_path / "counted.json").write_text(result.json(), encoding="utf-8")
    again = read_result(study, tmp_path / "counted.json")
    assert again == result
    assert again.options == Options(7)
    assert isinstance(again.findings, Counted)
    assert again.findings.rows[0].ends == (0.1, 1e-17)
    assert again.markdown() == result.markdown()


def test_numbers_of_a_list_stand_in_one_line(study: Study) -> None:
    assert '"ends": [0.1, 1e-17],\n' in run_study(study).json()
    assert '"case": "a [b, c] ü",\n' in run_study(study).json()


@pytest.mark.parametrize(
    "changes",
    [
        {"study": "other"},
        {"version": 2},
        {"findings": {"rows": [], "shares": {}, "more": 1}},
        {"findings": {"rows": [{"case": "a", "ends": [1.0], "ratio": None}], "shares": {}}},
        {"findings": {"rows": [{"case": "a", "ends": ["x", 1.0], "ratio": None}], "shares": {}}},
        {"options": {"passes": 10, "more": 1}},
        {"options": {}},
    ],
)
def test_what_no_run_left_is_refused(study: Study, tmp_path: Path, changes: dict[str, Any]) -> None:
    path = left(study, tmp_path, changes)
    with pytest.raises(InputError, match=r"counted\.json: .*study counted' again"):
        read_result(study, path)


def test_a_missing_or_broken_file_is_told(study: Study, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="there is no such file; 'retarder-synth study counted' makes it"):
        read_result(study, tmp_path / "counted.json")
    (tmp_path / "counted.json").write_text("{", encoding="utf-8")
    with pytest.raises(InputError, match="Expecting property name"):
        read_result(study, tmp_path / "counted.json")


def test_a_number_that_is_not_finite_is_no_result(study: Study) -> None:
    broken = replace(FOUND, shares={"rms": math.nan})
    with pytest.raises(ValueError, match="Out of range float"):
        Result(study, "1", Options(), broken).json()


@dataclass(frozen=True)
class Typed:
    """One of each kind."""

    config: Path | None = option(None, "a file")
    passes: int = option(20_000, "how many", (200, 10**6))
    step_m_s: float = option(0.5, "how far, in % of nothing", (0.1, 5.0))
    cases: tuple[str, ...] = option(("22:2",), "which")
    spreads: tuple[float, ...] = option((), "how wide", (0.0, 1.0))
    as_tuned: bool = option(False, "whether")


def test_words_become_values_of_their_types() -> None:
    words = "--config a.toml --passes 300 --step-m-s=0.25 --cases 52:3 85:4 --spreads 0.1 1 --as-tuned"
    assert options_from(words.split(), Typed, "s") == Typed(
        Path("a.toml"), 300, 0.25, ("52:3", "85:4"), (0.1, 1.0), True
    )
    assert options_from([], Typed, "s") == Typed()


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ("--passes 199", "study s: --passes: it is '199'; give a whole number from 200 to 1000000"),
        ("--passes 1e3", "study s: --passes: it is '1e3'; give a whole number from 200 to 1000000"),
        ("--passes nan", "study s: --passes: it is 'nan'; give a whole number from 200 to 1000000"),
        ("--step-m-s nan", "study s: --step-m-s: it is 'nan'; give a number from 0.1 to 5"),
        ("--spreads 0.1 2", "study s: --spreads: it is '2'; give a number from 0 to 1"),
        ("--pass 300", "study s: there is no option --pass; did you mean --passes?"),
        ("--passes", "study s: --passes: expected one argument"),
        ("--cases", "study s: --cases: expected at least one argument"),
        ("300", "study s: there is no option 300; known: "),
    ],
)
def test_other_words_are_refused_in_one_sentence(words: str, sentence: str) -> None:
    with pytest.raises(InputError) as fault:
        options_from(words.split(), Typed, "s")
    assert str(fault.value).startswith(sentence)


def test_the_help_tells_every_option_with_its_default() -> None:
    told = parser_of(Typed, "s").format_help()
    for word in ("--config FILE", "how many (20000)", "how far, in % of nothing (0.5)", "which (22:2)", "--as-tuned"):
        assert word in told


def test_calls_take_turns_after_one_round_that_counts_for_nothing() -> None:
    order: list[str] = []
    times = in_turns({"a": lambda: order.append("a"), "b": lambda: order.append("b")}, 3, {"b": 1})
    assert order == ["a", "b", "a", "b", "a", "a"]
    assert len(times["a"].wall_s) == len(times["a"].processor_s) == 3
    assert len(times["b"].wall_s) == 1


def test_a_call_that_waits_takes_wall_time_and_no_processor_time() -> None:
    wall, processor = timed(lambda: time.sleep(0.05))
    assert wall >= 0.05
    assert processor < 0.5 * wall


def test_ratios_are_of_one_round() -> None:
    """The machine is four times as slow in the second round; the ratio does not see it."""
    base, other = Times((2.0, 8.0, 3.0), (0.0,) * 3), Times((1.0, 4.0), (0.0,) * 2)
    assert speed_against(base, other) == Ratio(2.0, 2.0, 2.0, 2)
    assert Ratio(17.46, 15.8, 123.4, 15).cell == "17.5 (15.8 to 123, n = 15)"


def test_cases_are_found_by_mass_and_target() -> None:
    config = load_config(None)
    (light, heavy) = named_cases(config, ("22:2", "85:3.5"))
    assert (light.name, heavy.name) == ("22 t to 2 m/s", "85 t to 3.5 m/s")
    assert light.plant.cut.mass_t == 22.0
    assert [case.name for case in class_cases(config, (52.0,), ())] == [f"52 t to {v} m/s" for v in (2, 3, 4)]
    assert len(class_cases(config, (), (1.5,))) == 5


@pytest.mark.parametrize("word", ["22", "22:", ":2", "23:2", "22:2:2", "a:b"])
def test_a_wrong_case_is_told_with_the_masses_known(word: str) -> None:
    with pytest.raises(InputError, match=r"give MASS:TARGET as in 22:2, the mass one of 22, 36, 52, 66, 85 t"):
        named_cases(load_config(None), (word,))
    with pytest.raises(InputError, match=r"no cut of the configuration has 23 t; its masses are 22, 36, 52, 66, 85 t"):
        of_masses(load_config(None), (22.0, 23.0))


def test_work_side_by_side_keeps_its_order() -> None:
    assert side_by_side(lambda x: x * x, range(20), threads=3) == tuple(x * x for x in range(20))


def test_every_criterion_differs_from_the_default_in_one_thing() -> None:
    asked = criteria(SQUARED_ERROR_CRITERION)
    assert asked["default"] is SQUARED_ERROR_CRITERION
    for name, each in asked.items():
        changed = [key for key in vars(each) if getattr(each, key) != getattr(SQUARED_ERROR_CRITERION, key)]
        assert changed == {"default": [], "over-speed ×4": ["terminal"]}.get(name, ["requirement"])
