"""What a control computer leaves in its directory: pictures, report, and last of all the summary."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from synth.book.output_directory import COMPUTER_PICTURES, SUMMARY, remove_stale
from synth.book.summary import Document
from synth.present.outputs import file_hashes
from synth.present.plots.picture import Picture, save_picture
from synth.present.report.computer_report import ComputerReport, computer_page
from synth.yard.control_computer.computer_acceptance import ComputerVerdict
from synth.yard.control_computer.computer_results import ComputerResults
from synth.yard.control_computer.computer_summary import computer_summary
from tuning_tables import write_atomically
from tuning_tables.canonical import canonical_json

Say = Callable[[str], None]


def write_computer(
    results: ComputerResults, verdict: ComputerVerdict, created: str, directory: Path, say: Say
) -> Document:
    """Write everything; the summary as written. Raises `OSError`."""
    output = results.config.settings.output
    pictures: tuple[Picture, ...] = ()
    files: list[Path] = []
    if output.plots or output.report:
        from synth.present.plots.computer.computer_pictures import computer_pictures  # matplotlib

        pictures = tuple(computer_pictures(results))
        say(f"{len(pictures)} pictures drawn")
    if output.plots:
        for picture in pictures:
            files += save_picture(picture, directory / "plots")
    hashes = file_hashes(directory, files)
    if output.report:
        page = directory / "report.html"
        write_atomically(page, computer_page(ComputerReport(results, verdict, created, hashes, pictures)).encode())
        hashes |= file_hashes(directory, [page])
    remove_stale(directory, set(hashes), pictures=COMPUTER_PICTURES)
    summary = computer_summary(results, verdict, created, hashes)
    write_atomically(directory / SUMMARY, canonical_json(summary) + b"\n")
    return summary
