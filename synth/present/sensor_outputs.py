"""What a tune for point sensors leaves in its directory: tables, code, pictures, report, at last the summary."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from synth.book.acceptance import Verdict
from synth.book.output_directory import PASSAGE_PICTURES, SUMMARY, remove_stale
from synth.book.sensors.sensor_summary import sensor_summary
from synth.book.sensors.sensor_tune import SensorBook
from synth.book.summary import Document
from synth.present.outputs import file_hashes
from synth.present.plots.picture import Picture, save_picture
from synth.present.report.sensor_report import SensorReport, sensor_page
from tuning_tables import InvalidTable, write_atomically
from tuning_tables.canonical import canonical_json
from tuning_tables.passages.c_source import passage_c_files
from tuning_tables.passages.csv_file import write_passage_csv
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.passages.st_source import passage_st_files

Say = Callable[[str], None]


def write_sensors(book: SensorBook, verdict: Verdict, directory: Path, say: Say) -> Document:
    """Write everything but the JSON tables, which are in `directory`/tables already; the summary as written.

    Raises `OSError`, and `InvalidTable` where the tables make no book.
    """
    config = book.config
    files = [*write_tables(book, directory), *write_code(book, directory, say)]
    pictures: tuple[Picture, ...] = ()
    if config.output.plots or config.output.report:
        from synth.present.plots.sensors.sensor_pictures import sensor_pictures  # matplotlib

        pictures = tuple(sensor_pictures(book.cases))
        say(f"{len(pictures)} pictures drawn")
    if config.output.plots:
        for picture in pictures:
            files += save_picture(picture, directory / "plots")
    hashes = file_hashes(directory, files)
    if config.output.report:
        page = directory / "report.html"
        write_atomically(page, sensor_page(SensorReport(book, verdict, hashes, pictures)).encode())
        hashes |= file_hashes(directory, [page])
    for name in remove_stale(directory, set(hashes), pictures=PASSAGE_PICTURES):
        say(f"{name} was there before; it is no readable table of this tool and was left alone")
    summary = sensor_summary(book, verdict, hashes)
    write_atomically(directory / SUMMARY, canonical_json(summary) + b"\n")
    return summary


def write_tables(book: SensorBook, directory: Path) -> list[Path]:
    """CSV files, if asked for; the JSON files, which are there already, are among those that are returned."""
    tables = [case.table for case in book.cases]
    files = [directory / "tables" / f"{table.id}.json" for table in tables]
    if book.config.output.csv:
        for table in tables:
            files.append(directory / "tables" / f"{table.id}.csv")
            write_passage_csv(table, files[-1])
    return files


def write_code(book: SensorBook, directory: Path, say: Say) -> list[Path]:
    """The tables as C99 and as Structured Text; more tables than 16 bits count are no Structured Text."""
    bound = PassageBook(tuple(case.table for case in book.cases))
    contents = {f"c/{name}": content for name, content in passage_c_files(bound).items()}
    try:
        contents |= {f"st/{name}": content for name, content in passage_st_files(bound).items()}
    except InvalidTable as fault:
        say(f"no Structured Text is written: {fault}")
    for name, content in contents.items():
        write_atomically(directory / name, content)
    return [directory / name for name in contents]
