"""What a control computer leaves in its directory: pictures, report, and last of all the summary."""

from __future__ import annotations

from collections.abc import Callable

from synth.book.summary import Document
from synth.frame.results_directory import ResultsDirectory
from synth.present.plots.picture import Picture, picture_files
from synth.present.report.computer_report import ComputerReport, computer_page
from synth.yard.control_computer.computer_acceptance import ComputerVerdict
from synth.yard.control_computer.computer_results import ComputerResults
from synth.yard.control_computer.computer_summary import computer_summary
from tuning_tables.canonical import canonical_json

Say = Callable[[str], None]


def write_computer(
    results: ComputerResults, verdict: ComputerVerdict, created: str, directory: ResultsDirectory, say: Say
) -> Document:
    """Write everything; the summary as written. Raises `OSError`."""
    output = results.config.settings.output
    pictures: tuple[Picture, ...] = ()
    if output.plots or output.report:
        from synth.present.plots.computer.computer_pictures import computer_pictures  # matplotlib

        pictures = tuple(computer_pictures(results))
        say(f"{len(pictures)} pictures drawn")
    if output.plots:
        directory.write_all(picture_files(pictures, "plots"))
    if output.report:
        page = computer_page(ComputerReport(results, verdict, created, directory.written, pictures))
        directory.write("report.html", page.encode())
    summary = computer_summary(results, verdict, created, directory.written)
    directory.finish(canonical_json(summary) + b"\n")
    return summary
