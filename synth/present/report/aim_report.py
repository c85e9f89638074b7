"""The report of an aim: one page, the verdict first, then figures, pictures, origins and limits."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from importlib.metadata import version

from synth.frame.page.document import Stamp, document, file_table, picture_sections
from synth.frame.page.markup import Markup, element, joined
from synth.frame.page.parameter_table import parameter_section
from synth.frame.picture.picture import Picture
from synth.present.report.aim_limits import aim_limits
from synth.present.report.aim_tables import aim_tables
from synth.yard.aim.aim_acceptance import AimBookVerdict
from synth.yard.aim.aim_book import AimBook

HOW_TO_READ = (
    "Free distance: what the head of a cut has still to roll to the standing cars when its last axle leaves the "
    "position. Over-speed: the cut couples faster than allowed. Gap: what stays free where a cut stops before. All "
    "figures are of cuts that the speeds were not chosen on; brackets: 95 % intervals, of a share exact (Clopper and "
    "Pearson), of a mean normal; they cover the chance of these cuts only. A cut for whose reading no exit speed keeps "
    "what is asked is let go at the lowest speed and counts in its row; the last column tells how many these are."
)


@dataclass(frozen=True)
class AimReport:
    """Results of an aim with their verdict, the SHA-256 of its files by name, and its pictures."""

    book: AimBook
    verdict: AimBookVerdict
    file_hashes: Mapping[str, str]
    pictures: tuple[Picture, ...]


def aim_page(report: AimReport) -> str:
    """One HTML document that loads nothing. The same report gives the same text."""
    config = report.book.config
    stamp = Stamp(config.title, report.book.created, version("retarder-synth"), config.sha256)
    return document(stamp, verdict_box(report), tuple(sections(report)))


def sections(report: AimReport) -> Iterator[tuple[str, str, Markup]]:
    """(anchor, heading, content) in the order of the page."""
    yield "results", "Results", joined((aim_tables(report.book), element("p", HOW_TO_READ, class_="meta")))
    if report.pictures:
        yield "pictures", "Pictures", picture_sections(report.pictures)
    yield "parameters", "Parameters", parameter_section(report.book.config.parameters)
    yield "limits", "Limits of use", aim_limits(report.book)
    yield "files", "Files", file_table(report.file_hashes)


def verdict_box(report: AimReport) -> Markup:
    """The box at the head of the page: accepted or not, what is asked, what cannot be served and why."""
    config, accepted = report.book.config, report.verdict.accepted
    word = "Accepted" if accepted else "Not accepted"
    coupling = config.scene.coupling_speed_m_s
    parts = [
        element("p", element("strong", word), " — ", f"{report.verdict.sentence}."),
        element(
            "p",
            f"Asked: at most {100.0 * config.aim.p_overspeed:g} of 100 cuts couple faster than {coupling:g} m/s. "
            f"The position {config.position_name} lets a cut go {config.scene.exit_m:g} m from the crest; "
            f"{exactness(report)}.",
        ),
    ]
    without = [each for each in report.verdict.tables if each.without]
    if without:
        lead = (
            "No exit speed keeps that chance in some cells: where the track falls more than the cut resists, even one "
            "that is let go at the lowest speed arrives too fast. These cells are null in the tables, and a controller "
            "gets no answer there."
        )
        items = (element("li", f"{each.table}: {each.without} of {each.cells} cells") for each in without)
        parts += [element("p", lead), element("ul", *items)]
    return element("section", *parts, class_=f"verdict {'accepted' if accepted else 'refused'}", id="verdict")


def exactness(report: AimReport) -> str:
    """How exactly the position obeys."""
    config = report.book.config
    if config.book is not None:
        return f"its exit speeds are those of closed loops of the controller tables in {config.book[0].name}"
    return f"its exit speeds have a normal error of {config.exit_std_m_s:g} m/s"
