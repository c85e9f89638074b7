"""The run of a command: what a user asks; refuse what can be refused, compute, judge, write, tell; the only
skeleton of that.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from synth.frame.command import Asked, Command, Head, O, P, R, S, Unfinished, Verdict, Work
from synth.frame.exhibits import Chapter, Chart, File, Table
from synth.frame.picture.picture import Picture, picture_files
from synth.frame.printed_numbers import counted
from synth.frame.results_directory import SUMMARY, ResultsDirectory, results_directory
from synth.frame.settings.settings_file import BUILT_IN
from synth.frame.settings.toml_file import read_text
from synth.frame.terminal.interrupt import interruptible
from synth.frame.terminal.manner import Manner
from synth.frame.terminal.telling import LIMITS_MISSED, OK, say
from synth.frame.told import Told
from synth.frame.version import creation_time, require_date

if TYPE_CHECKING:
    from synth.frame.picture.studio import Studio


def asked_of(command: Command[S, O, P, R], options: O, init: str) -> Asked[S, O]:
    """The `options` that were typed, with the settings of their configuration, the defaults without one; `InputError`.

    `init`: the command that prints such a file.
    """
    path = options.config
    text, place = ("", BUILT_IN) if path is None else (command.text(path, init), str(path))
    return Asked(command.read(text, place), options, place, Path(place).parent, text)


PAGE, WORKBOOK = "report.html", "sheets.xlsx"


def perform(command: Command[S, O, P, R], asked: Asked[S, O], output: Path, manner: Manner) -> int:
    """Run `command` as `asked`, into the directory `output`; the exit code.

    Raises `InputError` and `PlantError` before anything is written, `OSError` where the disk does.
    """
    require_date()
    problem = command.resolve(asked)
    head = command.head(problem)
    manner.step(f"read and found possible: {head.title}")
    reads = (*asked.options.reads, *head.reads)
    with results_directory(output, command.name, reads, inputs=command.inputs) as directory:
        for warning in head.warnings:
            manner.warn(f"warning: {warning}")
        try:
            told = finished(command, asked, problem, head, directory, manner)
        except Unfinished as fault:
            say(f"{fault}; what was done before is kept in {output}, and the same command goes on from it")
            return LIMITS_MISSED
        names = (*directory.written,)
    if manner.as_json:
        sys.stdout.write((output / SUMMARY).read_text(encoding="utf-8"))
    else:
        from synth.frame.told import page_of_run

        manner.give(dict, lambda: page_of_run(told, output, names))
    return OK if told.verdict.accepted else LIMITS_MISSED


def finished(
    command: Command[S, O, P, R],
    asked: Asked[S, O],
    problem: P,
    head: Head,
    directory: ResultsDirectory,
    manner: Manner,
) -> Told:
    """Compute, judge and write; what a chapter holds is on the disk before the next one is made."""
    from synth.frame.picture.studio import Studio
    from synth.frame.terminal.progress import Progress  # rich: a refusal needs none

    created, steps = creation_time(), command.steps(problem)
    processes = command.drawing(problem) if head.output.plots or head.output.report else 1
    with (
        interruptible(directory, "summary"),
        Progress(steps.count, steps.word, steps.noun, manner) as progress,
        Studio(processes) as studio,
    ):
        result = command.compute(problem, Work(progress, directory, studio.begin))
        progress.step("computed")
        verdict = Verdict(tuple(command.limits(result)))
        if asked.options.config is not None and command.text is read_text:
            directory.keep_configuration(asked.options.config, asked.text)
        chapters = []
        for chapter in command.show(result):
            write_data(chapter, directory)
            chapters.append(chapter)
            progress.step(f"chapter made: {chapter.heading}")
        if head.output.workbook:
            directory.write(WORKBOOK, workbook_of(chapters))
        told = Told(command.name, head, created, verdict, tuple(chapters), command.limits_of_use)
        write_shown(told, directory, studio, progress.note)
        progress.note(f"all files written after {time.monotonic() - manner.began_s:.1f} s")
    return told


def write_data(chapter: Chapter, directory: ResultsDirectory) -> None:
    """Write the files and tables of a chapter."""
    from synth.frame.sheet import to_csv

    for each in chapter.exhibits:
        if isinstance(each, File):
            directory.write(each.name, each.content)
        elif isinstance(each, Table):
            directory.write(each.file, to_csv(each))


def workbook_of(chapters: Sequence[Chapter]) -> bytes:
    """All tables, a sheet each."""
    from synth.frame.sheet import sheet_rows, to_workbook

    tables = [each for chapter in chapters for each in chapter.exhibits if isinstance(each, Table)]
    return to_workbook({each.name: sheet_rows(each) for each in tables})


def write_shown(told: Told, directory: ResultsDirectory, studio: Studio, tell: Callable[[str], None]) -> None:
    """Write pictures and page, and last of all the summary."""
    from synth.frame.told import summary_of

    output = told.head.output
    pictures = drawn(told, studio, tell) if output.plots or output.report else {}
    if output.plots:
        directory.write_all(picture_files(pictures.values(), "plots"))
    if output.report:
        from synth.frame.page.told_page import page_of

        directory.write(PAGE, page_of(told, pictures, directory.written).encode())
    directory.finish(summary_of(told, directory.written))


def drawn(told: Told, studio: Studio, tell: Callable[[str], None]) -> dict[str, Picture]:
    """The charts by name, drawn."""
    charts = [
        (chapter.heading, each) for chapter in told.chapters for each in chapter.exhibits if isinstance(each, Chart)
    ]
    drawings = [studio.drawing(each) for _, each in charts]
    found = {
        each.name: Picture(each.name, heading, each.title, each.caption, drawing.result())
        for (heading, each), drawing in zip(charts, drawings, strict=True)
    }
    if found:
        tell(f"{counted(len(found), 'picture')} drawn")
    return found
