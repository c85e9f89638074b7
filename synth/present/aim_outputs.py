"""What an aim leaves in its directory: tables in every form, pictures, report, and last of all the summary."""

from __future__ import annotations

from collections.abc import Callable

from synth.book.forms.aim_forms import aim_c_form, aim_csv_form, aim_json_form, aim_st_form
from synth.book.summary import Document
from synth.frame.picture.picture import Picture, picture_files
from synth.frame.results_directory import ResultsDirectory
from synth.present.report.aim_report import AimReport, aim_page
from synth.yard.aim.aim_acceptance import AimBookVerdict
from synth.yard.aim.aim_book import AimBook, order_of
from synth.yard.aim.aim_curves import aim_curves, runners
from synth.yard.aim.aim_summary import aim_summary
from synth.yard.aim.aimed_position import position_of
from tuning_tables.canonical import canonical_json

Say = Callable[[str], None]


def write_aim(book: AimBook, verdict: AimBookVerdict, directory: ResultsDirectory, say: Say) -> Document:
    """Write everything; the summary as written. Raises `OSError`."""
    output, tables = book.config.output, [made.table for made in book.tables]
    forms = (
        ("tables", aim_json_form(tables)), ("tables", aim_csv_form(tables)), ("c", aim_c_form(tables)),
        ("st", aim_st_form(tables)),
    )  # fmt: skip
    for folder, contents in forms:
        directory.write_all({f"{folder}/{name}": content for name, content in contents.items()})
    pictures: tuple[Picture, ...] = ()
    if output.plots or output.report:
        pictures = drawn(book)
        say(f"{len(pictures)} pictures drawn")
    if output.plots:
        directory.write_all(picture_files(pictures, "plots"))
    if output.report:
        page = aim_page(AimReport(book, verdict, directory.written, pictures))
        directory.write("report.html", page.encode())
    summary = aim_summary(book, verdict, directory.written)
    directory.finish(canonical_json(summary) + b"\n")
    return summary


def drawn(book: AimBook) -> tuple[Picture, ...]:
    """All pictures, with the curves that they show."""
    from synth.present.plots.aim.aim_pictures import aim_pictures  # matplotlib only where it is needed

    config = book.config
    position, cars = position_of(config), config.cars[0]
    curves = [aim_curves(config.scene, order_of(config, member, position), cars) for member in config.members]
    ends = dict.fromkeys((config.members[0], config.members[-1]))
    rolled = [runners(config.scene, member, config.simulation.seed) for member in ends]
    return tuple(aim_pictures(book, curves, rolled))
