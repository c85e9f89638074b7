"""The report of a control computer: one page, the verdict first, then figures, pictures, origins and limits."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from importlib.metadata import version

from synth.present.plots.picture import Picture
from synth.present.report.computer_tables import economics_tables, reliability_table, sizing_tables
from synth.present.report.document import Stamp, document, file_table, picture_sections
from synth.present.report.markup import Markup, element
from synth.present.report.parameter_table import parameter_section
from synth.yard.control_computer.computer_acceptance import ComputerVerdict
from synth.yard.control_computer.computer_results import ComputerResults

LIMITS = (
    "Prices, traffic, failure rates and their ranges are inputs. Where they are assumed, so is every amount here.",
    "Uncertain inputs are independent of each other; intervals cover the chance of the draws, not of the model.",
    "Waits of trains are those of a steady queue. Near full load a hump needs weeks to come there.",
    "Controllers carry retarder positions only: no switch control, no communication. Their speeds are assumed.",
    "Failures are those of the computer. Nothing here proves a safety integrity level.",
)


@dataclass(frozen=True)
class ComputerReport:
    """Results with their verdict, the SHA-256 of the files by name, and the pictures."""

    results: ComputerResults
    verdict: ComputerVerdict
    created: str
    file_hashes: Mapping[str, str]
    pictures: tuple[Picture, ...]


def computer_page(report: ComputerReport) -> str:
    """One HTML document that loads nothing. The same report gives the same text."""
    config = report.results.config
    stamp = Stamp(config.title, report.created, version("retarder-synth"), config.sha256)
    return document(stamp, verdict_box(report), tuple(sections(report)))


def verdict_box(report: ComputerReport) -> Markup:
    """Accepted or not, limit by limit."""
    accepted = report.verdict.accepted
    words = {True: "kept", False: "missed", None: "not decidable with these draws"}
    items = (element("li", f"{words[limit.kept]}: {limit.sentence}") for limit in report.verdict.limits)
    head = element("p", element("strong", "Accepted" if accepted else "Not accepted"))
    return element(
        "section", head, element("ul", *items), class_=f"verdict {'accepted' if accepted else 'refused'}", id="verdict"
    )


def sections(report: ComputerReport) -> Iterator[tuple[str, str, Markup]]:
    """(anchor, heading, content) in the order of the page."""
    results = report.results
    yield "sizing", "How fast", sizing_tables(results)
    yield "reliability", "How reliable", reliability_table(results)
    yield "economics", "What it pays", economics_tables(results)
    if report.pictures:
        yield "pictures", "Pictures", picture_sections(report.pictures)
    yield "parameters", "Parameters", parameter_section(results.config.parameters)
    yield "limits", "Limits of use", element("ul", *(element("li", sentence) for sentence in LIMITS))
    yield "files", "Files", file_table(report.file_hashes)
