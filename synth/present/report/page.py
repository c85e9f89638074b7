"""The page: verdict first, then the numbers, the pictures, the origin of everything, and the limits."""

from __future__ import annotations

from collections.abc import Iterator

from synth.frame.page.document import Stamp, document, file_table, picture_sections
from synth.frame.page.markup import Markup, element, joined
from synth.frame.page.parameter_table import parameter_section
from synth.present.report.book_report import BookReport
from synth.present.report.case_table import case_table
from synth.present.report.checks_section import checks_section
from synth.present.report.criterion_section import criterion_section
from synth.present.report.honesty_section import honesty_section
from synth.present.report.limits_of_use import limits_of_use
from synth.present.report.off_nominal_section import off_nominal_section
from synth.present.report.pareto_section import pareto_section
from synth.present.report.permissions_section import permissions_section
from synth.present.report.verdict import verdict

HOW_TO_READ = (
    "rms: root mean square of exit speed − target; a cut that stops in the position counts with exit speed 0. "
    "Friction known: a controller of the table's kind that is told the friction of each cut, with lines polished for "
    "it; regret: rms of the table / rms of that controller, which is a reference and no lower bound; none where a "
    "controller that is not told it does "
    "better. Feasible: the limit is not below the rms that no controller of the position avoids, which is that of what "
    "cuts leave too fast by under the hardest braking, and too slow by without any. "
    "Over-speed: more than 0.3 m/s above the target. Out of brake: leaves that fast even where every decision raises "
    "the stage, so that no table can hold it. Brackets: 95 % intervals, from passes in strata of the friction; the "
    "chance of these passes is all that they cover. All controllers see the same passes, and may act from the same "
    "place."
)


def report_page(book: BookReport) -> str:
    """One HTML document that loads nothing: style and pictures are inside."""
    stamp = Stamp(book.title, book.created, book.tool_version, book.config_sha256)
    return document(stamp, verdict(book), tuple(page_sections(book)))


def page_sections(book: BookReport) -> Iterator[tuple[str, str, Markup]]:
    """(anchor, heading, content) in the order of the page."""
    told = (element("p", book.permissions_line),) if book.permissions_line else ()
    how = element("p", HOW_TO_READ, class_="meta")
    yield "results", "Results", joined((case_table(book), how, off_nominal_section(book), *told))
    if book.permissions is not None:
        yield "permissions", "Permissions of the hardware", permissions_section(book.permissions)
    if book.fronts:
        yield "pareto", "Accuracy against time", pareto_section(book.fronts)
    yield "criterion", "Criterion", criterion_section(book)
    yield "honesty", "Predicted against simulated", honesty_section(book)
    yield "checks", "Limit cycles and escaped probability", checks_section(book)
    if book.pictures:
        yield "pictures", "Pictures", picture_sections(book.pictures)
    yield "parameters", "Parameters", parameter_section(book.parameters)
    yield "limits", "Limits of use", limits_of_use(book)
    yield "files", "Files", file_table(book.file_hashes)
