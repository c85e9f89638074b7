"""The report of a tune for point sensors: one page, the verdict first, then figures, pictures, origins and limits."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from importlib.metadata import version

from synth.book.acceptance import Verdict
from synth.book.comparison.measured import honesty_of
from synth.book.sensors.sensor_case import SensorCase
from synth.book.sensors.sensor_tune import SensorBook
from synth.frame.page.document import Stamp, document, file_table, picture_sections
from synth.frame.page.markup import Cell, Markup, element, head_row, joined, table
from synth.frame.page.parameter_table import parameter_section
from synth.frame.picture.picture import Picture
from synth.frame.printed_numbers import in_ten_thousand, interval, quotient, quotient_interval, speed
from synth.present.report.case_table import HONEST, failed_row, share_cell, time_cell, within_power

COLUMNS = (
    "case", "mass, t", "target, m/s", "verdict", "rms, m/s", "95 % interval", "predicted", "predicted / simulated",
    "95 of 100 within ±, m/s", "99 of 100 within ±, m/s", "unavoidable, m/s", "in 10 000 out of brake",
    "rms of all others, m/s", "over-speed, % [95 %]", "stopped inside, % [95 %]", "switchings a pass",
    "time, s [95 %]",
)  # fmt: skip

HOW_TO_READ = (
    "rms: root mean square of exit speed − target; a cut that stops in the position counts with exit speed 0. "
    "Unavoidable: rms of what cuts leave too fast by under the harder braking of the table and of a regulator that "
    "goes to the highest stage at every passage, and too slow by if never braked; where that alone is above the limit, "
    "the case is infeasible and outside the verdict. Over-speed: more than 0.3 m/s above the target. Out of brake: "
    "leaves that fast even at the highest stage from every passage on. Brackets: 95 % intervals, from passes in strata "
    "of the friction; the chance of these passes is all that they cover."
)

HEARD_COLUMNS = (
    "case",
    "passage",
    "axle",
    "sensor",
    "path, m",
    "change unfinished, % [95 %]",
    "pulses mistaken, % [95 %]",
)

LIMITS = (
    "All errors are those of a model with the parameters listed here, not of a retarder. Assumed parameters are "
    "guesses; calibrate them, then tune again.",
    "Intervals (95 %) cover the chance of the simulated passes only, neither the parameters nor the model.",
    "A table holds for its cut class, target speed and sensors, for the entry speeds named in the parameters and for a "
    "regulator that gives no new command until the change of the last one has ended.",
    "Sensors are simulated in order. A dead, late or spurious one costs accuracy; the table's tracker leaves pulses "
    "that no cut can have made out of account.",
    "The regulator acts from the first sensor on. The cut ahead must have left the position by then: this interlock is "
    "the yard's.",
    "The tool is not certified and claims no safety integrity. Before a table drives a retarder, check it with an "
    "independent program against the hashes below, and on the track.",
)


@dataclass(frozen=True)
class SensorReport:
    """A book with its verdict, the SHA-256 of the files by name, and the pictures in the order of the page."""

    book: SensorBook
    verdict: Verdict
    file_hashes: Mapping[str, str]
    pictures: tuple[Picture, ...]


def sensor_page(report: SensorReport) -> str:
    """One HTML document that loads nothing. The same report gives the same text."""
    config = report.book.config
    stamp = Stamp(config.title, report.book.created, version("retarder-synth"), config.sha256)
    return document(stamp, verdict_box(report), tuple(sections(report)))


def verdict_box(report: SensorReport) -> Markup:
    """Accepted or not, and why."""
    accepted = report.verdict.accepted
    sentence = element(
        "p", element("strong", "Accepted" if accepted else "Not accepted"), f" — {report.verdict.sentence}."
    )
    return element("section", sentence, class_=f"verdict {'accepted' if accepted else 'refused'}", id="verdict")


def sections(report: SensorReport) -> Iterator[tuple[str, str, Markup]]:
    """(anchor, heading, content) in the order of the page."""
    yield "results", "Results", joined((case_table(report), element("p", HOW_TO_READ, class_="meta")))
    yield "passages", "Sensors and passages", joined((sensor_words(report.book), heard_table(report.book)))
    if report.pictures:
        yield "pictures", "Pictures", picture_sections(report.pictures)
    yield "parameters", "Parameters", parameter_section(report.book.config.parameters)
    yield "limits", "Limits of use", element("ul", *(element("li", sentence) for sentence in LIMITS))
    yield "files", "Files", file_table(report.file_hashes)


def case_table(report: SensorReport) -> Markup:
    """All cases; infeasible ones are marked, not left out."""
    limit = report.book.config.acceptance.rms_m_s
    rows = [
        (case_row(case, verdict.word, limit), "" if verdict.feasible else "infeasible")
        for case, verdict in zip(report.book.cases, report.verdict.cases, strict=True)
    ]
    rows += [(failed_row(case, len(COLUMNS)), "infeasible") for case in report.book.failed]
    return table("Results by case", (head_row(*COLUMNS),), rows, kind="cases")


def case_row(case: SensorCase, verdict: str, limit_m_s: float) -> list[str | Cell]:
    """The cells of one case."""
    found, power, predicted = case.statistics, case.brake_power, case.table.predicted
    ratio, (low, high) = honesty_of(predicted.rms_m_s, predicted.passes, found)
    feasible, honest = verdict != "infeasible", low <= HONEST[1] and high >= HONEST[0]
    over = "bad" if feasible and found.rms_ci95_m_s[0] > limit_m_s else "key"
    return [
        case.label,
        f"{case.plant.cut.mass_t:g}",
        f"{case.target_speed_m_s:g}",
        Cell(verdict, kind="words"),
        Cell(speed(found.rms_m_s), f"{found.passes} passes, bias {found.bias_m_s:+.3f} m/s", over),
        interval(found.rms_ci95_m_s),
        speed(predicted.rms_m_s),
        Cell(f"{quotient(ratio, 3)} {quotient_interval((low, high), 3)}", kind="" if honest or not feasible else "bad"),
        f"{speed(found.p95_m_s)} {interval(found.p95_ci95_m_s)}",
        f"{speed(found.p99_m_s)} {interval(found.p99_ci95_m_s)}",
        f"{speed(case.unavoidable.rms_m_s)} {interval(case.unavoidable.rms_ci95_m_s)}",
        in_ten_thousand(power.out_of_brake, power.out_of_brake_ci95),
        within_power(power),
        share_cell(found.overspeed, found.overspeed_ci95),
        share_cell(found.stalled, found.stalled_ci95),
        f"{found.switchings:.1f}",
        time_cell(found),
    ]


def sensor_words(book: SensorBook) -> Markup:
    """Where the sensors stand, and whose passages decide."""
    sensors = book.sensors.sensors
    places = ", ".join(f"{place:g}" for place in sensors.path_m)
    axles = {"first_axle": "its first axle passes", "every_axle": "each of its axles passes"}[book.sensors.decides_on]
    return element(
        "p",
        f"{len(sensors.path_m)} sensors {book.sensors.type} stand at {places} m from the entrance. The regulator "
        f"decides on a cut when {axles} one, if the change of stage before has ended.",
    )


def heard_table(book: SensorBook) -> Markup:
    """The passages at which something came between, of all at which is decided."""
    rows = [
        (
            [case.name, str(number), str(row.axle + 1), str(row.sensor + 1), f"{row.path_m:g}",
             share_cell(*unfinished), share_cell(*mistaken)],
            "",
        )
        for case in book.cases
        for number, (row, unfinished, mistaken) in enumerate(
            zip(case.table.passages, case.heard.unfinished, case.heard.mistaken, strict=True), start=1
        )
        if unfinished[0] > 0.0 or mistaken[0] > 0.0
    ]  # fmt: skip
    if not rows:
        return element(
            "p",
            "No simulated cut found a change of stage unfinished, and no pulses were taken for no passage or another.",
        )
    words = (
        "Passages at which a simulated cut found a change of stage unfinished, or its pulses were taken for no passage "
        "or another: shares of the cuts that come there. Axles and sensors are counted from 1 here, in files from 0."
    )
    return joined((element("p", words), table("Passages", (head_row(*HEARD_COLUMNS),), rows, kind="cases")))
