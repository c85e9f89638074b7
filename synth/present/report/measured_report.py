"""The report of what measured passes tell: one page, the verdict first, then figures, pictures, limits and files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import version

from synth.frame.page.document import Stamp, document, file_table, picture_sections
from synth.frame.page.markup import Markup, element, head_row, joined, table
from synth.frame.picture.picture import Picture


@dataclass(frozen=True)
class Figures:
    """A table of the page: its caption, head, and rows of text."""

    caption: str
    head: tuple[str, ...]
    rows: Sequence[Sequence[str]]


@dataclass(frozen=True)
class MeasuredReport:
    """`sentences`: what was found, the first of them in bold; `good`: nothing is to be done about it."""

    title: str
    created: str
    config_sha256: str
    good: bool
    sentences: tuple[str, ...]
    figures: tuple[Figures, ...]
    pictures: tuple[Picture, ...]
    limits: tuple[str, ...]
    file_hashes: Mapping[str, str]


def measured_page(report: MeasuredReport) -> str:
    """One HTML document that loads nothing. The same report gives the same text."""
    head, *rest = report.sentences
    verdict = element(
        "section", element("p", element("strong", head)), element("ul", *(element("li", each) for each in rest)),
        class_=f"verdict {'accepted' if report.good else 'refused'}", id="verdict",
    )  # fmt: skip
    sections: list[tuple[str, str, Markup]] = [("figures", "Figures", joined(map(figures_table, report.figures)))]
    if report.pictures:
        sections.append(("pictures", "Pictures", picture_sections(report.pictures)))
    sections.append(("limits", "Limits of use", element("ul", *(element("li", each) for each in report.limits))))
    sections.append(("files", "Files", file_table(report.file_hashes)))
    stamp = Stamp(report.title, report.created, version("retarder-synth"), report.config_sha256)
    return document(stamp, verdict, tuple(sections))


def figures_table(figures: Figures) -> Markup:
    """One table."""
    return table(figures.caption, (head_row(*figures.head),), [(list(row), "") for row in figures.rows], kind="cases")
