"""What is shown of a plan of point sensors: what to do first, layouts, what they give case by case, pictures, files."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

from plant_models import every_axle
from synth.frame.exhibits import Chapter, Chart, Column, File, Row, Sentence, Table, Tile, Tiles
from synth.frame.interval import Interval
from synth.frame.printed_numbers import decimals
from synth.retarder.sensors.layout_plan import CHOOSING_PASSES, JudgedLayout
from synth.retarder.sensors.layout_results import LayoutResults

RULE_FILE = "sensors-by-rule.toml"
LAYOUTS = (
    Column("layout", "layout", words=True),
    Column("sensors", "sensors"),
    Column("rms_m_s", "rms", "m/s", decimals(4)),
    Column("of_radar", "in parts of the radar's", form=decimals(3), spare=2),
    Column("reached", "as wanted", spare=3, words=True),
    Column("path_m", "sensors at", "m", "{:g}".format, spare=1, words=True),
    Column("file", "file", detail=True, words=True),
)
CASES = (
    Column("layout", "layout", words=True, once=True),
    Column("sensors", "sensors", once=True),
    Column("case", "case", words=True),
    Column("target_m_s", "target", "m/s"),
    Column("rms_m_s", "rms", "m/s", decimals(4)),
)
REACHED = {True: "yes", False: "no", None: "not decidable"}


def chapters(found: LayoutResults) -> Iterator[Chapter]:
    """All of it, in the order of the page."""
    yield Chapter("Configurations", (tiles(found), first(found), *links(found)))
    yield Chapter("Layouts", (Table("layouts", "Layouts", LAYOUTS, list(layout_rows(found)), brief=True), how(found)))
    yield Chapter("Pictures", tuple(charts(found)))
    yield Chapter("Case by case", (Table("cases", "Case by case", CASES, list(case_rows(found))),))


def first(found: LayoutResults) -> Sentence:
    """What to do with the plan."""
    shown = found.shown
    name, number = file_of(shown), shown.deciding + 1
    text = f"Make tables for {number} sensors, in this directory: retarder-synth tune {name}."
    if found.chosen is None:
        text = (
            f"Of these numbers {number} sensors have an rms of {shown.errors.rms.value:.4f} m/s, which is more than is "
            f"wanted. Ask for more sensors (--sensors), decide on every axle ([sensors] decides_on), or allow more "
            f"(--rms). Their places stand in {name}."
        )
    return Sentence(text, {"chosen_sensors": None if found.chosen is None else number}, brief=True, to_do=True)


def tiles(found: LayoutResults) -> Tiles:
    """How many sensors, what they give, and what a radar gives."""
    shown, of_radar = found.shown, found.shown.errors.over(found.radar)
    number = Tile(
        f"{shown.deciding + 1} sensors",
        f"are the fewest planned for an rms of {found.wanted_rms_m_s:.4f} m/s"
        if found.chosen is not None
        else f"are the most that were asked for; an rms of {found.wanted_rms_m_s:.4f} m/s is wanted",
    )
    rms = Tile(f"{shown.errors.rms.value:.3f} m/s", "is their rms error at the exit", found.is_reached(shown))
    radar = Tile(f"{of_radar.value:.2f} times", f"the rms of the radar, {found.radar.rms.value:.3f} m/s")
    return Tiles((number, rms, radar))


def how(found: LayoutResults) -> Sentence:
    """How the figures came about."""
    axles = "every_axle" if found.asked.problem.sensors.axles is every_axle else "first_axle"
    return Sentence(
        f"Root of the mean square error at the exit over all classes and targets, simulated: {found.radar.rms.n} "
        "passes of every table, the same for all layouts, with 95 % intervals. Places and number were chosen on "
        f"{CHOOSING_PASSES} other passes. The tables are polished less far than those of 'tune', whose rms "
        f"is lower as a rule. Sensors decide on: {axles.replace('_', ' ')}.",
        {"decides_on": axles, "wanted_rms_m_s": found.wanted_rms_m_s, "choosing_passes": CHOOSING_PASSES},
    )


def layouts(found: LayoutResults) -> Iterator[tuple[str, JudgedLayout, str]]:
    """Every layout of point sensors: what it is, and the name of its file."""
    for each in found.plans:
        yield "planned", each, file_of(each)
    yield "by the rule", found.rule, RULE_FILE


def file_of(layout: JudgedLayout) -> str:
    """The name of the file of a planned layout."""
    return f"sensors-{layout.deciding + 1}.toml"


def layout_rows(found: LayoutResults) -> Iterator[Row]:
    """The layouts, and the radar."""
    for name, layout, file in layouts(found):
        places = found.places_of(layout)
        yield {
            "layout": name,
            "sensors": len(places),
            "rms_m_s": layout.errors.rms,
            "of_radar": layout.errors.over(found.radar),
            "reached": REACHED[found.is_reached(layout)],
            "path_m": places,
            "file": file,
        }
    yield {"layout": "radar", "rms_m_s": found.radar.rms}


def case_rows(found: LayoutResults) -> Iterator[Row]:
    """What they give in each case."""
    for name, layout, _ in layouts(found):
        yield from rms_rows(found, {"layout": name, "sensors": layout.deciding + 1}, layout.errors.by_table)
    yield from rms_rows(found, {"layout": "radar"}, found.radar.by_table)


def rms_rows(found: LayoutResults, head: Row, rms_m_s: Sequence[Interval]) -> Iterator[Row]:
    """A row a case, in the order of the problem."""
    cases = zip(found.asked.labels, found.asked.problem.cases, strict=True)
    each = [(label, aim.target_speed_m_s) for label, case in cases for aim in case.aims]
    for (label, target_m_s), value in zip(each, rms_m_s, strict=True):
        yield {**head, "case": label, "target_m_s": target_m_s, "rms_m_s": value}


def links(found: LayoutResults) -> Iterator[File]:
    """The configuration with each of the layouts, and the own types that it names, each file once.

    The page links to what is shown; the table names all.
    """
    files: dict[str, tuple[bytes, str]] = {}
    for name, layout, file in layouts(found):
        number, told = layout.deciding + 1, layout.errors.rms
        place = (
            f"{number} sensors, {name}, of retarder-synth sensors: rms {told.value:.4f} m/s, 95 % interval "
            f"{told.low95:.4f} to {told.high95:.4f}"
        )
        sensors = {**found.asked.source.tree.get("sensors", {}), "path_m": list(found.places_of(layout))}
        source = replace(found.asked.source, place=place, tree={**found.asked.source.tree, "sensors": sensors})
        for path, content in source.files(file).items():
            files[path] = content, f"The configuration with {number} sensors" if layout is found.shown else ""
    for path, (content, title) in files.items():
        yield File(path, content, title)


def charts(found: LayoutResults) -> Iterator[Chart]:
    """What sensors and places give, where they stand, and what they decide."""
    yield Chart(
        "sensors-rms",
        "Rms over the number of sensors",
        "Root of the mean square error at the exit over all cut classes and targets; upright lines are 95 % intervals.",
        lambda: _pictures().rms_over_number(found),
    )
    yield Chart(
        "sensors-places",
        "Where the sensors stand",
        "A row for each number of sensors; grey: the retarders. The last sensor stands behind the exit and logs.",
        lambda: _pictures().places_by_number(found),
    )
    yield Chart(
        "sensors-map",
        "Sensors over the best command",
        "Colours: what a regulator would command that could decide anywhere. Upright lines: where this plan decides, "
        "with the speeds at which it goes one stage up and down; it may also pass over stages.",
        lambda: _pictures().shown_plan(found),
    )


def _pictures() -> Any:
    from synth.retarder.sensors import plan_pictures  # matplotlib

    return plan_pictures
