"""What a tune for point sensors leaves in its directory: tables, code, pictures, report, at last the summary."""

from __future__ import annotations

from collections.abc import Callable

from synth.book.acceptance import Verdict
from synth.book.sensors.sensor_summary import sensor_summary
from synth.book.sensors.sensor_tune import SensorBook
from synth.book.summary import Document
from synth.frame.picture.picture import Picture, picture_files
from synth.frame.results_directory import ResultsDirectory
from synth.present.report.sensor_report import SensorReport, sensor_page
from tuning_tables import InvalidTable
from tuning_tables.canonical import canonical_json
from tuning_tables.passages.c_source import passage_c_files
from tuning_tables.passages.csv_file import to_passage_csv
from tuning_tables.passages.json_file import read_passage_json, to_passage_json
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.st_source import passage_st_files

Say = Callable[[str], None]


def store_passages(table: PassageTable, directory: ResultsDirectory) -> PassageTable:
    """Write `table` as JSON; the table as a controller will load it."""
    return read_passage_json(directory.write(f"tables/{table.id}.json", to_passage_json(table)))


def write_sensors(book: SensorBook, verdict: Verdict, directory: ResultsDirectory, say: Say) -> Document:
    """Write everything but the JSON tables, which are in `directory` already; the summary as written.

    Raises `OSError`, and `InvalidTable` where the tables make no book.
    """
    config = book.config
    if config.output.csv:
        tables = [case.table for case in book.cases]
        directory.write_all({f"tables/{table.id}.csv": to_passage_csv(table) for table in tables})
    directory.write_all(code_files(book, say))
    pictures: tuple[Picture, ...] = ()
    if config.output.plots or config.output.report:
        from synth.present.plots.sensors.sensor_pictures import sensor_pictures  # matplotlib

        pictures = tuple(sensor_pictures(book.cases))
        say(f"{len(pictures)} pictures drawn")
    if config.output.plots:
        directory.write_all(picture_files(pictures, "plots"))
    if config.output.report:
        page = sensor_page(SensorReport(book, verdict, directory.written, pictures))
        directory.write("report.html", page.encode())
    summary = sensor_summary(book, verdict, directory.written)
    directory.finish(canonical_json(summary) + b"\n")
    return summary


def code_files(book: SensorBook, say: Say) -> dict[str, bytes]:
    """The tables as C99 and as Structured Text; more tables than 16 bits count are no Structured Text."""
    bound = PassageBook(tuple(case.table for case in book.cases))
    contents = {f"c/{name}": content for name, content in passage_c_files(bound).items()}
    try:
        contents |= {f"st/{name}": content for name, content in passage_st_files(bound).items()}
    except InvalidTable as fault:
        say(f"no Structured Text is written: {fault}")
    return contents
