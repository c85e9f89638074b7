"""What an aim leaves in its directory: tables in every form, pictures, report, and last of all the summary."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from synth.book.forms.aim_file import is_aim_table
from synth.book.forms.aim_forms import aim_c_form, aim_csv_form, aim_json_form, aim_st_form
from synth.book.output_directory import AIM_PICTURES, SUMMARY, remove_stale
from synth.book.summary import Document
from synth.present.outputs import file_hashes
from synth.present.plots.picture import Picture, save_picture
from synth.present.report.aim_report import AimReport, aim_page
from synth.yard.aim.aim_acceptance import AimBookVerdict
from synth.yard.aim.aim_book import AimBook, order_of
from synth.yard.aim.aim_curves import aim_curves, runners
from synth.yard.aim.aim_summary import aim_summary
from synth.yard.aim.aimed_position import position_of
from tuning_tables import write_atomically
from tuning_tables.aim.json_file import read_aim_json
from tuning_tables.canonical import canonical_json

Say = Callable[[str], None]


def write_aim(book: AimBook, verdict: AimBookVerdict, directory: Path, say: Say) -> Document:
    """Write everything; the summary as written.

    Files of an earlier aim that are not written anew are removed when all new ones are whole, and before the summary
    is written: so a summary lists files that belong together. Raises `OSError`.
    """
    output, tables = book.config.output, [made.table for made in book.tables]
    forms = {"tables": aim_json_form(tables), "c": aim_c_form(tables), "st": aim_st_form(tables)}
    files = [file for folder, contents in forms.items() for file in written(directory / folder, contents)]
    files += written(directory / "tables", aim_csv_form(tables))
    pictures: tuple[Picture, ...] = ()
    if output.plots or output.report:
        pictures = drawn(book)
        say(f"{len(pictures)} pictures drawn")
    if output.plots:
        for picture in pictures:
            files += save_picture(picture, directory / "plots")
    hashes = file_hashes(directory, files)
    if output.report:
        report = directory / "report.html"
        write_atomically(report, aim_page(AimReport(book, verdict, hashes, pictures)).encode())
        hashes |= file_hashes(directory, [report])
    for name in remove_stale(directory, set(hashes), maker_of_aim_table, AIM_PICTURES):
        say(f"{name} was there before; it is no readable aim table and was left alone")
    summary = aim_summary(book, verdict, hashes)
    write_atomically(directory / SUMMARY, canonical_json(summary) + b"\n")
    return summary


def written(folder: Path, contents: Mapping[str, bytes]) -> list[Path]:
    """Write `contents` by name into `folder`."""
    for name, content in contents.items():
        write_atomically(folder / name, content)
    return [folder / name for name in contents]


def drawn(book: AimBook) -> tuple[Picture, ...]:
    """All pictures, with the curves that they show."""
    from synth.present.plots.aim.aim_pictures import aim_pictures  # matplotlib only where it is needed

    config = book.config
    position, cars = position_of(config), config.cars[0]
    curves = [aim_curves(config.scene, order_of(config, member, position), cars) for member in config.members]
    ends = dict.fromkeys((config.members[0], config.members[-1]))
    rolled = [runners(config.scene, member, config.simulation.seed) for member in ends]
    return tuple(aim_pictures(book, curves, rolled))


def maker_of_aim_table(file: Path) -> str:
    """Name of the program that made an aim table, none for what is something else; `TableError` or `OSError`."""
    return read_aim_json(file).generator.name if is_aim_table(file) else ""
