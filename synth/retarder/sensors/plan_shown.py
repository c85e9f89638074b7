"""What is shown of a plan of point sensors: layouts, what they give case by case, pictures, the chosen section."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, Final

from plant_models import every_axle
from synth.frame.exhibits import Chart, Column, Exhibit, File, Row, Sentence, Table
from synth.frame.printed_numbers import decimals
from synth.retarder.sensors.layout_plan import JudgedLayout
from synth.retarder.sensors.layout_results import LayoutResults

CHOSEN: Final = "sensors.toml"
METHOD: Final = (
    "predicted rms by exact density on the check grid (path and speed steps halved); the search compares costs of "
    "unpolished solutions on a coarse grid"
)
LAYOUTS = (
    Column("layout", "layout", words=True),
    Column("sensors", "sensors"),
    Column("rms_m_s", "rms", "m/s", decimals(4)),
    Column("path_m", "sensors at", "m", "{:g}".format, spare=1, words=True),
)
CASES = (
    Column("layout", "layout", words=True, once=True),
    Column("sensors", "sensors", once=True),
    Column("case", "case", words=True),
    Column("target_m_s", "target", "m/s"),
    Column("rms_m_s", "rms", "m/s", decimals(4)),
)


def plan(found: LayoutResults) -> Iterator[Exhibit]:
    """The layouts of each number of sensors, and what stands beside them."""
    yield Table("layouts", "Layouts", LAYOUTS, list(layout_rows(found)), brief=True)
    axles = "every_axle" if found.problem.sensors.axles is every_axle else "first_axle"
    yield Sentence(
        f"Root of the mean square error over all classes and targets: {METHOD}. Sensors decide on: "
        f"{axles.replace('_', ' ')}.",
        {
            "method": METHOD,
            "decides_on": axles,
            "wanted_rms_m_s": found.wanted_rms_m_s,
            "chosen_sensors": None if found.chosen is None else found.chosen.deciding + 1,
        },
    )
    yield from charts(found)
    yield Table("cases", "Case by case", CASES, list(case_rows(found)))
    if found.chosen is not None:
        yield File(CHOSEN, section_of(found, found.chosen.best).encode())


def layouts(found: LayoutResults) -> Iterator[tuple[str, JudgedLayout]]:
    """Every layout of point sensors by what it is."""
    for each in found.plans:
        yield "planned", each.best
        yield "equal sections", each.equal
    yield "by the rule", found.rule


def layout_rows(found: LayoutResults) -> Iterator[Row]:
    """The layouts, and the radar."""
    for name, layout in layouts(found):
        places = found.places_of(layout)
        yield {"layout": name, "sensors": len(places), "rms_m_s": layout.rms_m_s, "path_m": places}
    yield {"layout": "radar", "rms_m_s": found.radar_mean_rms_m_s}


def case_rows(found: LayoutResults) -> Iterator[Row]:
    """What they give in each case."""
    for name, layout in layouts(found):
        rms = [[each.rms_m_s for each in case] for case in layout.tuned]
        yield from rms_rows(found, {"layout": name, "sensors": len(layout.deciding_m) + 1}, rms)
    yield from rms_rows(found, {"layout": "radar"}, found.radar_rms_m_s)


def rms_rows(found: LayoutResults, head: Row, rms_m_s: Sequence[Sequence[float]]) -> Iterator[Row]:
    """A row a case, in the order of the problem."""
    for label, case, by_aim in zip(found.labels, found.problem.cases, rms_m_s, strict=True):
        for aim, value in zip(case.aims, by_aim, strict=True):
            yield {**head, "case": label, "target_m_s": aim.target_speed_m_s, "rms_m_s": value}


def section_of(found: LayoutResults, layout: JudgedLayout) -> str:
    """A layout as lines for the section [sensors] of a configuration."""
    places = ", ".join(f"{place:g}" for place in found.places_of(layout))
    head = f"# made by retarder-synth sensors plan: predicted rms {layout.rms_m_s:.4f} m/s"
    return f"{head}\n[sensors]\npath_m = [{places}]\n"


def charts(found: LayoutResults) -> Iterator[Exhibit]:
    """What sensors and places give, where they stand, and what they decide."""
    yield Chart(
        "sensors-rms",
        "Predicted rms over the number of sensors",
        "Root of the mean square error at the exit over all cut classes and targets, predicted by the exact density.",
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
