"""The report of shares of variance: one page, what to measure first on top, then figures, ranges and limits."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import version

from synth.book.sensitivity.document import METHOD
from synth.book.sensitivity.ranking import UNDECIDABLE, measure_first, percent
from synth.book.sensitivity.sensitivity import OutputShares, Sensitivity
from synth.book.sensitivity.shares import Share
from synth.book.sensitivity.varied import NEVER_VARIED
from synth.present.plots.picture import Picture
from synth.present.report.document import Stamp, document, file_table, picture_sections
from synth.present.report.markup import Cell, Markup, element, head_row, joined, table

LIMITS = (
    "Shares are told by the ranges of the library. A range that is too wide makes a number look important.",
    "Parameters are taken as independent, each uniform over its range.",
    "A share is of one number alone. What numbers do together stands in a row of its own; it can be large for the rms.",
    "Intervals cover the choice of the points, not that of the passes: these are the same at every point, and their "
    "part of the variance stands in the row of the noise.",
    "The table stays as it is. How much better a table for the measured number is, is not told here.",
)


@dataclass(frozen=True)
class SensitivityReport:
    """Shares, the SHA-256 of the files by name, and the pictures."""

    found: Sensitivity
    created: str
    file_hashes: Mapping[str, str]
    pictures: tuple[Picture, ...]


def sensitivity_page(report: SensitivityReport) -> str:
    """One HTML document that loads nothing. The same report gives the same text."""
    found = report.found
    stamp = Stamp(found.config.title, report.created, version("retarder-synth"), found.config.sha256)
    sentences = (element("li", measure_first(found.names, each)) for each in found.overall)
    head = element("section", element("p", element("strong", "What to measure first")), element("ul", *sentences),
                   class_="verdict accepted", id="verdict")  # fmt: skip
    return document(stamp, head, tuple(sections(report)))


def sections(report: SensitivityReport) -> Iterator[tuple[str, str, Markup]]:
    """(anchor, heading, content) in the order of the page."""
    found = report.found
    yield "shares", "Shares of variance", joined((method_line(found), share_table("All cases", found, found.overall)))
    if report.pictures:
        yield "pictures", "Pictures", picture_sections(report.pictures)
    cases = (
        share_table(f"{case.label} to {case.target_m_s:g} m/s", found, case.outputs) for case in found.cases
    )  # fmt: skip
    yield "cases", "Case by case", joined(cases)
    yield "ranges", "Ranges", joined((*(range_table(*each) for each in moved(found)), held_table(found)))
    yield "limits", "Limits of use", element("ul", *(element("li", sentence) for sentence in LIMITS))
    yield "files", "Files", file_table(report.file_hashes)


def method_line(found: Sensitivity) -> Markup:
    """How many, and by what."""
    trial = found.trial
    return element(
        "p",
        f"{trial.points} plants, {trial.passes} passes of every table on each, seed {trial.seed}: {METHOD}. 95 % "
        f"intervals in brackets; grey: {UNDECIDABLE}.",
    )


def share_table(name: str, found: Sensitivity, outputs: Sequence[OutputShares]) -> Markup:
    """A row a parameter, a column an output, the largest share of the first output on top."""
    order = sorted(range(len(found.keys)), key=lambda place: -outputs[0].shares[place].value)
    rows: list[tuple[list[str | Cell], str]] = [
        ([found.names[place], *(cell(each, each.shares[place]) for each in outputs)], "") for place in order
    ]
    rows.append((["parameters together", *(cell(each, each.together) for each in outputs)], ""))
    rows.append((["noise of the passes", *(cell(each, each.noise) for each in outputs)], ""))
    rows.append((["mean over the points", *(f"{each.mean:.3g}" for each in outputs)], ""))
    rows.append((["standard deviation", *(f"{each.std:.3g}" for each in outputs)], ""))
    return table(name, (head_row("parameter", *(each.output.title for each in outputs)),), rows, kind="cases")


def cell(found: OutputShares, share: Share) -> Cell:
    """A share with its interval; grey where it is not decided."""
    if not found.varies:
        return Cell("–", note="the same at every point")
    return Cell(percent(share)) if share.decided else Cell(percent(share), kind="meta", note=UNDECIDABLE)


def moved(found: Sensitivity) -> Iterator[tuple[str, list[tuple[list[str | Cell], str]]]]:
    """(label, rows) of the ranges of each class."""
    for label, varied in found.varied:
        yield label, [
            ([Cell(one.name, note=one.key), f"{one.nominal:.4g}", f"{one.low:.4g} to {one.high:.4g}",
              "assumed" if one.assumed else ""], "")
            for one in varied
            if one.key in found.keys
        ]  # fmt: skip


def range_table(label: str, rows: list[tuple[list[str | Cell], str]]) -> Markup:
    """The ranges of one class, in the units of the configuration; factors where the number is a list."""
    return table(label, (head_row("parameter", "value", "range", ""),), rows, kind="cases")


def held_table(found: Sensitivity) -> Markup:
    """What does not vary, and why."""
    held = {**dict.fromkeys(found.held, "set by the configuration"), **NEVER_VARIED}
    rows: list[tuple[list[str | Cell], str]] = [([Cell(key, kind="code"), why], "") for key, why in held.items()]
    return table("Held", (head_row("key", "why"),), rows, kind="cases")
