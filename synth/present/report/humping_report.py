"""The report of humped trains: one page, the outcome first, then figures, pictures, origins and limits."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from importlib.metadata import version

from plant_models.library import SourcedValue
from synth.frame.page.document import Stamp, document, file_table, picture_sections
from synth.frame.page.markup import Markup, element, joined
from synth.frame.page.parameter_table import parameter_section
from synth.frame.picture.picture import Picture
from synth.present.report.aim_source import aim_section
from synth.present.report.figure_table import figure_table
from synth.yard.humping.aim_choice import AimChoice
from synth.yard.humping.train_figures import TrainFigure

HOW_TO_READ = (
    "Misrouted: the cut came to a switch before it could be thrown behind the cut ahead, and followed that one. In "
    "contact: it ran into the cut ahead. Catch-up: one of both, but not in the last position alone. Over-speed: of the "
    "cuts that reached a track undisturbed, those that couple faster than 5 km/h. Gap: what such cuts leave free, 0 "
    "for those that couple. Brackets: 95 % intervals; a train is what is drawn, and cuts of one train are not "
    "independent. The last column tells how many cuts would give the share within what was asked."
)

LIMITS = (
    "All figures are those of a model with the parameters listed here, not of a hump. Assumed parameters are guesses.",
    "Intervals cover the chance of these trains only, neither the parameters nor the model.",
    "A figure of 0 does not mean never: the upper end of its interval is what these trains show.",
    "Cuts that were misrouted, in contact, or stopped count as such; their couplings and gaps are not counted.",
    "The tool claims no safety integrity: no figure here proves that a hump is safe.",
)


@dataclass(frozen=True)
class HumpingReport:
    """What a run of humped trains leaves: `verdict` in a sentence, `accepted` None where nothing was asked.

    `parameters`: all inputs with their origins; `aims`: aim tables that commanded the last position, `tracks` (routes,)
    being the tracks of their routes; `player`: name of the file beside the report that plays a train, ''
    for none; `log`: name of that with the log of the hump control for the same train, and `otherwise`, over how many
    switches cuts went otherwise than its points lay; `file_hashes`: SHA-256 of the files by name.
    """

    title: str
    created: str
    config_sha256: str
    verdict: str
    accepted: bool | None
    figures: tuple[TrainFigure, ...]
    pictures: tuple[Picture, ...]
    parameters: tuple[SourcedValue, ...]
    aims: tuple[AimChoice, ...]
    tracks: tuple[int, ...]
    player: str
    log: str
    otherwise: int
    file_hashes: Mapping[str, str]


def humping_page(report: HumpingReport) -> str:
    """One HTML document that loads nothing. The same report gives the same text."""
    stamp = Stamp(report.title, report.created, version("retarder-synth"), report.config_sha256)
    return document(stamp, verdict_box(report), tuple(sections(report)))


def verdict_box(report: HumpingReport) -> Markup:
    """The box at the head of the page, and the ways to the page that plays a train and to its log."""
    style = "" if report.accepted is None else " accepted" if report.accepted else " refused"
    parts = [element("p", report.verdict)]
    if report.player:
        parts.append(element("p", element("a", "Play a train on the plan", href=report.player)))
    lay = f"; its points lay otherwise than cuts went {report.otherwise} times" if report.otherwise else ""
    log = element("a", "Event log of the hump control for the first train", href=report.log)
    parts.append(element("p", log, lay))
    return element("div", *parts, class_=f"verdict{style}")


def sections(report: HumpingReport) -> Iterator[tuple[str, str, Markup]]:
    """(anchor, heading, content) in the order of the page."""
    yield "figures", "Figures", joined((figure_table(report.figures), element("p", HOW_TO_READ, class_="meta")))
    if report.pictures:
        yield "pictures", "Pictures", picture_sections(report.pictures)
    if report.aims:
        yield "aim", "Aim tables", aim_section(report.aims, report.tracks)
    yield "parameters", "Parameters", parameter_section(report.parameters)
    yield "limits", "Limits of use", element("ul", *(element("li", sentence) for sentence in LIMITS))
    yield "files", "Files", file_table(report.file_hashes)
