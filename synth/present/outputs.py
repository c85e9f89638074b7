"""What a tune leaves in its directory: book, tables, controller code, pictures, report, and last of all the summary."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path

from synth.book.acceptance import Verdict
from synth.book.forms.table_forms import c_form
from synth.book.output_directory import SUMMARY, remove_stale
from synth.book.summary import Document, summary_of
from synth.book.tune import Book
from synth.present.draw_pictures import Studio
from synth.present.plots.picture import Picture, save_picture
from synth.present.report import BookReport, write_report
from tuning_tables import write_atomically, write_book, write_csv
from tuning_tables.canonical import canonical_json

Say = Callable[[str], None]


def write_outputs(book: Book, verdict: Verdict, directory: Path, studio: Studio, say: Say) -> Document:
    """Write everything but the JSON tables, which are in `directory`/tables already; the summary as written.

    Files of an earlier tune that are not written anew are removed when all new ones are whole, and before the summary
    is written: so a summary lists files that belong together. Raises `OSError`, and `InvalidTable` where the
    tables make no C code.
    """
    config, tables = book.config, [case.table for case in book.cases]
    files = [directory / "tables" / f"{table.id}.json" for table in tables]
    write_book(tables, directory / "book.h5")
    files.append(directory / "book.h5")
    if config.output.csv:
        for table in tables:
            files.append(directory / "tables" / f"{table.id}.csv")
            write_csv(table, files[-1])
    for name, content in c_form(tables).items():
        files.append(directory / "c" / name)
        write_atomically(files[-1], content)
    pictures: tuple[Picture, ...] = ()
    if config.output.plots or config.output.report:
        pictures = studio.book(book.cases, book.degree_studies, config.acceptance.rms_m_s)
        say(f"{len(pictures)} pictures drawn")
    if config.output.plots:
        for picture in pictures:
            files += save_picture(picture, directory / "plots")
    hashes = file_hashes(directory, files)
    if config.output.report:
        report = directory / "report.html"
        write_report(report, report_of(book, verdict, hashes, pictures))
        hashes |= file_hashes(directory, [report])
    for name in remove_stale(directory, set(hashes)):
        say(f"{name} was there before; it is no readable table of this tool and was left alone")
    summary = summary_of(book, verdict, hashes)
    write_atomically(directory / SUMMARY, canonical_json(summary) + b"\n")
    return summary


def report_of(book: Book, verdict: Verdict, hashes: dict[str, str], pictures: tuple[Picture, ...]) -> BookReport:
    """The report of `book`."""
    config = book.config
    return BookReport(
        title=config.title,
        tool_version=version("retarder-synth"),
        config_sha256=config.sha256,
        created=book.created,
        cases=book.cases,
        failed=book.failed,
        degree_studies=book.degree_studies,
        parameters=config.parameters,
        accepted=verdict.accepted,
        verdict=f"{verdict.sentence}.",
        acceptance_rms_m_s=config.acceptance.rms_m_s,
        permissions_line=book.permissions_line,
        file_hashes=hashes,
        pictures=pictures,
    )


def file_hashes(directory: Path, files: list[Path]) -> dict[str, str]:
    """SHA-256 by name relative to `directory`, with slashes."""
    return {f.relative_to(directory).as_posix(): hashlib.sha256(f.read_bytes()).hexdigest() for f in files}
