"""What an aim leaves in its directory: tables in every form, pictures, report, and last of all the summary."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from synth.book.forms.aim_file import is_aim_table
from synth.book.forms.aim_forms import aim_c_form, aim_csv_form, aim_json_form, aim_st_form
from synth.book.output_directory import AIM_PICTURES, SUMMARY, is_own_csv
from synth.book.summary import Document
from synth.present.outputs import file_hashes
from synth.present.plots.picture import Picture, save_picture
from synth.present.report.aim_report import AimReport, aim_page
from synth.yard.aim_acceptance import AimBookVerdict
from synth.yard.aim_book import AimBook, order_of
from synth.yard.aim_curves import aim_curves, runners
from synth.yard.aim_summary import aim_summary
from synth.yard.aimed_position import position_of
from tuning_tables import TableError, write_atomically
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
    for name in remove_stale_aims(directory, set(hashes)):
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


def remove_stale_aims(path: Path, names: set[str]) -> tuple[str, ...]:
    """Remove aim tables, their CSV, pictures and the report of an earlier aim in `path` that are not in `names`; names
    of odd files that were left alone. Controller code always has the same names."""
    odd = []
    for file in sorted(path.glob("tables/*.json")):
        if f"tables/{file.name}" in names or not file.is_file():
            continue
        try:
            if is_aim_table(file) and read_aim_json(file).generator.name == "retarder-synth":
                file.unlink()
        except (OSError, TableError):
            odd.append(f"tables/{file.name}")
    for file in sorted(path.glob("tables/*.csv")):
        if f"tables/{file.name}" not in names and is_own_csv(file):
            file.unlink()
    for file in sorted(path.glob("plots/*")):
        if f"plots/{file.name}" not in names and AIM_PICTURES.fullmatch(file.name) and file.is_file():
            file.unlink()
    report = path / "report.html"
    if report.name not in names and report.is_file() and b"retarder-synth" in report.read_bytes():
        report.unlink()
    return tuple(odd)
