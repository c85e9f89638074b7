"""Behind `retarder-synth study`: list the studies, run one, fill the tables of the documentation."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from synth.cli.study import Wanted
from synth.frame.faults import InputError
from synth.frame.terminal.manner import Manner
from synth.frame.terminal.telling import LIMITS_MISSED, OK

if TYPE_CHECKING:
    from scripts.studies.result import Result
    from scripts.studies.study import Study


HELP = {"-h", "--help"}


def study_command(name: str | None, words: list[str], wanted: Wanted, general_help: Callable[[], str]) -> int:
    """Run the study `name` with the options in `words`, or tell what is asked; the exit code."""
    from scripts.studies.registry import STUDIES, study_named

    if wanted.show_list:
        print_list(STUDIES, wanted.manner)
        return OK
    if name is None or name in HELP:
        if name in HELP or HELP.intersection(words):
            print(general_help())
            return OK
        if wanted.check or wanted.document:
            return document_command(wanted.check)
        raise InputError("study: which one? 'retarder-synth study --list' tells all")
    study = study_named(name)
    if HELP.intersection(words):
        print(help_of(study))
        return OK
    if wanted.check:
        raise InputError("study: --check compares documents with kept results; leave the name of a study out")
    return run_command(study, words, wanted)


def print_list(studies: tuple[Study, ...], manner: Manner) -> None:
    """Name, time and question of every study."""
    rows = [{"name": s.name, "question": s.question, "seconds": s.seconds, "page": s.page} for s in studies]
    wide, long = max(len(s.name) for s in studies), max(len(s.duration) for s in studies)
    lines = [f"{s.name:<{wide}}  {s.duration:>{long}}  {s.question}" for s in studies]
    manner.give(lambda: {"studies": rows}, lambda: lines)


def help_of(study: Study) -> str:
    """The question of a study and its options."""
    from scripts.studies.study import parser_of

    parser = parser_of(study.method.options, study.name)
    parser.description = f"{study.question} Takes {study.duration} on two cores."
    return parser.format_help()


def run_command(study: Study, words: list[str], wanted: Wanted) -> int:
    """Run one study, write what it leaves, and tell it."""
    from scripts.studies.documents import documents, kept, written
    from scripts.studies.result import run_study
    from scripts.studies.study import options_from
    from synth.frame.results_directory import results_directory
    from synth.kernels.cache import guarded

    if wanted.document:
        list(documents(Path()))  # a checkout, or a fault before anything is computed
        if words or wanted.small:
            raise InputError("study: --document keeps the result of the study as it is; leave its other options out")
    method = study.method
    options = method.smallest if wanted.small else options_from(words, method.options, study.name)
    if wanted.small and words:
        raise InputError("study: --small has options of its own; leave the others out")
    with results_directory(wanted.output, "study") as directory:
        result = guarded(run_study, study, options, wanted.manner.note)
        files = directory.write_all(result_files(result))
    if wanted.manner.as_json or not wanted.manner.quiet:
        print(result.json() if wanted.manner.as_json else result.markdown(), end="")
    if wanted.document:
        kept(Path(), study.name).write_text(result.json(), encoding="utf-8")
        files += [kept(Path(), study.name), *written(Path())]
    wanted.manner.warn(f"written: {', '.join(map(str, files))}")
    return LIMITS_MISSED if result.findings.faults() else OK


def result_files(result: Result) -> dict[str, bytes]:
    """NAME.json, NAME.md and the pictures, by name."""
    from synth.frame.picture.house_style import figure_files

    texts = {f"{result.study.name}.json": result.json(), f"{result.study.name}.md": result.markdown()}
    files = {name: text.encode("utf-8") for name, text in texts.items()}
    for name, figure in result.figures().items():
        files |= figure_files(figure, name)
    return files


def document_command(check: bool) -> int:
    """Fill the tables of the documentation in this directory, or with `check` tell which are stale."""
    from scripts.studies.documents import stale, written

    if check:
        sentences = stale(Path())
        print("\n".join(sentences) if sentences else "every table is that of its study")
        return LIMITS_MISSED if sentences else OK
    changed = written(Path())
    print("\n".join(f"written: {path}" for path in changed) if changed else "every table is that of its study")
    return OK
