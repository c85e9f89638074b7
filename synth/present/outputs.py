"""What a tune leaves in its directory: book, tables, controller code, pictures, report, and last of all the summary."""

from __future__ import annotations

from collections.abc import Callable
from importlib.metadata import version

from synth.book.acceptance import Verdict
from synth.book.forms.table_forms import c_form
from synth.book.summary import Document, summary_of
from synth.book.tune import Book
from synth.frame.picture.picture import Picture, picture_files
from synth.frame.results_directory import ResultsDirectory
from synth.present.draw_pictures import Studio
from synth.present.report import BookReport, report_page
from tuning_tables import ControllerTable, read_json, to_csv, to_json, write_book
from tuning_tables.canonical import canonical_json

Say = Callable[[str], None]


def store_table(table: ControllerTable, directory: ResultsDirectory) -> ControllerTable:
    """Write `table` as JSON; the table as a controller will load it."""
    return read_json(directory.write(f"tables/{table.id}.json", to_json(table)))


def write_outputs(book: Book, verdict: Verdict, directory: ResultsDirectory, studio: Studio, say: Say) -> Document:
    """Write everything but the JSON tables, which are in `directory` already; the summary as written.

    Raises `OSError`, and `InvalidTable` where the tables make no C code.
    """
    config, tables = book.config, [case.table for case in book.cases]
    with directory.writing("book.h5") as part:
        write_book(tables, part)
    if config.output.csv:
        directory.write_all({f"tables/{table.id}.csv": to_csv(table) for table in tables})
    directory.write_all({f"c/{name}": content for name, content in c_form(tables).items()})
    pictures: tuple[Picture, ...] = ()
    if config.output.plots or config.output.report:
        pictures = studio.book(book.cases, config.acceptance.rms_m_s)
        say(f"{len(pictures)} pictures drawn")
    if config.output.plots:
        directory.write_all(picture_files(pictures, "plots"))
    if config.output.report:
        page = report_page(report_of(book, verdict, directory.written, pictures))
        directory.write("report.html", page.encode())
    summary = summary_of(book, verdict, directory.written)
    directory.finish(canonical_json(summary) + b"\n")
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
        parameters=config.parameters,
        accepted=verdict.accepted,
        verdict=f"{verdict.sentence}.",
        acceptance_rms_m_s=config.acceptance.rms_m_s,
        permissions_line=book.permissions_line,
        file_hashes=hashes,
        pictures=pictures,
    )
