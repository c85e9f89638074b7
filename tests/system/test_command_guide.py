"""The guide to the command line leaves nothing out; `study` lists, runs and refuses."""

from __future__ import annotations

import json
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import typer.main

from scripts.studies.registry import STUDIES
from scripts.studies.result import read_result
from synth.cli import main
from synth.cli.commands import app
from synth.cli.guide import GUIDES
from synth.cli.study import laboratory
from synth.frame.command_line import PAGES, CommandGuide
from tests.frame.small_command import results_in

ROOT = Path(__file__).parents[2]


def group_of(guide: CommandGuide) -> Any:
    """The commands of a guide."""
    top: Any = typer.main.get_command(app)
    return top.commands[guide.words] if guide.words else top


@pytest.mark.parametrize("guide", GUIDES.values(), ids=lambda guide: guide.words or "top")
def test_every_command_has_its_section_and_its_example(guide: CommandGuide) -> None:
    listed = [name for names in guide.sections.values() for name in names]
    assert sorted(listed) == sorted(group_of(guide).commands)
    assert set(listed) - set(guide.shown) == (set(GUIDES) - {""} if guide.words == "" else set())
    for name, shown in guide.shown.items():
        assert shown.example.startswith(f"{guide.words} {name}".lstrip())
        assert (ROOT / PAGES / shown.page).is_file()


@pytest.mark.parametrize("example", [shown.example for guide in GUIDES.values() for shown in guide.shown.values()])
def test_an_example_can_be_typed(example: str) -> None:
    """Every word of it is a command, an option, or a value that an option takes; nothing is run."""
    command: Any = typer.main.get_command(app)
    words = shlex.split(example.partition(">")[0])
    while hasattr(command, "commands"):
        context = command.make_context("retarder-synth", words, resilient_parsing=True)
        _, command, words = command.resolve_command(context, words)
    context = command.make_context(example, words)
    assert not context.args


TOLD = re.compile(r"retarder-synth ((?:hump |sweep )?[a-z]+)(?= [A-Z-]|['`])")
"""A command that a sentence has somebody type: an argument, an option or a quotation mark is behind it."""


def test_every_command_that_sentences_tell_is_there() -> None:
    files = [*(ROOT / "synth").rglob("*.py"), *(ROOT / "docs").rglob("*.md"), ROOT / "README.md"]
    told = {words for file in files for words in TOLD.findall(file.read_text(encoding="utf-8"))}
    there = {" ".join(words) for words in leaves(typer.main.get_command(app))}
    assert told <= there | {"study", "hump", "sweep"}
    assert len(told) > 20


@pytest.mark.parametrize("width", [60, 80, 100, 140])
def test_help_is_not_cut_off(width: int) -> None:
    for guide in GUIDES.values():
        group = group_of(guide)
        context = group.make_context("retarder-synth", ["--help"], resilient_parsing=True, terminal_width=width)
        told = group.get_help(context)
        assert "..." not in told.replace("[ARGS]...", "")
        assert max(map(len, told.splitlines())) <= width


def leaves(command: Any, words: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    """Every command that can be typed, by its words."""
    inner = getattr(command, "commands", None)
    if inner is None:
        yield words
    for name, below in (inner or {}).items():
        yield from leaves(below, (*words, name))


@pytest.mark.parametrize("width", [60, 80, 100, 140])
def test_help_of_no_command_is_cut_off(width: int) -> None:
    top: Any = typer.main.get_command(app)
    for words in leaves(top):
        command, typed = top, list(words)
        while hasattr(command, "commands"):
            context = command.make_context("retarder-synth", list(typed), resilient_parsing=True)
            _, command, typed = command.resolve_command(context, typed)
        name = " ".join(("retarder-synth", *words))
        told = command.make_context(name, [], resilient_parsing=True, terminal_width=width).get_help()
        assert "..." not in re.sub(r"(?<=[]},R])\.\.\.", "", told), words  # several words may follow
        assert "…" not in told, words
        assert max(map(len, told.splitlines())) <= width, (words, max(told.splitlines(), key=len))


def test_the_list_names_question_and_time_of_every_study(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["study", "--list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == len(STUDIES)
    for line, study in zip(lines, STUDIES, strict=True):
        assert line.split()[0] == study.name
        assert line.endswith(study.question)
        assert study.duration in line
    assert main(["study", "--list", "--json"]) == 0
    assert [each["name"] for each in json.loads(capsys.readouterr().out)["studies"]] == [s.name for s in STUDIES]


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["study"], "study: which one?"),
        (["study", "interpolatoin"], "did you mean interpolation?"),
        (["study", "interpolation", "--passes", "1"], "--passes: it is '1'; give a whole number from 200 to"),
        (["study", "interpolation", "--masses-t", "23"], "no cut of the configuration has 23 t"),
        (["study", "interpolation", "--config", "nowhere.toml"], "nowhere.toml: there is no such file"),
        (["study", "interpolation", "--small", "--passes", "300"], "--small has options of its own"),
        (["study", "interpolation", "--check"], "leave the name of a study out"),
    ],
)
def test_a_wrong_word_is_told(words: list[str], sentence: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(words) == 2
    told = capsys.readouterr()
    assert sentence in told.err
    assert (told.out, told.err.count("\n")) == ("", 1)


def test_the_help_of_a_study_tells_its_options(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["study", "interpolation", "--help"]) == 0
    assert "--masses-t X [X ...]" in capsys.readouterr().out
    assert main(["study", "--help"]) == 0
    assert "Run a study" in capsys.readouterr().out


def test_a_run_leaves_its_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["study", "interpolation", "--masses-t", "22", "--passes", "200", "--parts", "2", "--step-m-s", "2"]
    assert main([*words, "-o", str(tmp_path), "--json"]) == 0
    study = next(each for each in STUDIES if each.name == "interpolation")
    result = read_result(study, tmp_path / "interpolation.json")
    assert capsys.readouterr().out == result.json()
    assert (tmp_path / "interpolation.md").read_text(encoding="utf-8") == result.markdown()
    assert {Path(name).suffix for name in results_in(tmp_path)} == {".json", ".md"}


def test_the_product_alone_says_where_studies_are(tmp_path: Path) -> None:
    """What a wheel holds, copied to a place of its own: -S keeps the checkout that is installed out of the path."""
    for package in ("plant_models", "synth", "tuning_tables"):
        shutil.copytree(ROOT / package, tmp_path / package, ignore=shutil.ignore_patterns("__pycache__"))
    elsewhere = [str(tmp_path), *(path for path in sys.path if path.endswith("site-packages"))]
    program = f"import sys; sys.path += {elsewhere!r}; from synth.cli import main; raise SystemExit(main(['study']))"
    run = subprocess.run(
        [sys.executable, "-S", "-P", "-c", program],
        cwd=tmp_path, env={}, capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert (run.returncode, run.stdout, run.stderr.count("\n")) == (2, "", 1)
    assert "studies come with a checkout of the source" in run.stderr


def test_a_study_that_lacks_a_library_is_not_taken_for_a_missing_checkout(monkeypatch: pytest.MonkeyPatch) -> None:
    def lacking(name: str) -> None:
        raise ModuleNotFoundError("No module named 'matplotlib'", name="matplotlib")

    monkeypatch.setattr("synth.cli.study.import_module", lacking)
    with pytest.raises(ModuleNotFoundError, match="matplotlib"):
        laboratory()
