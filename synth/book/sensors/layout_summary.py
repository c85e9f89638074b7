"""summary.json of a plan of point sensors, and the chosen layout as a section of a configuration."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.metadata import version
from typing import Any, Final

from plant_models import every_axle
from synth.book.sensors.layout import with_layout
from synth.book.sensors.layout_plan import JudgedLayout, PlannedLayout
from synth.book.sensors.layout_results import LayoutResults
from synth.book.summary import Document

VERSION: Final = 1
DIGITS: Final = 5
"""Decimals of predicted rms in m/s: the error of the grid is greater."""

METHOD: Final = (
    "predicted rms by exact density on the check grid (path and speed steps halved); the search compares costs of "
    "unpolished solutions on a coarse grid"
)


def layout_summary(results: LayoutResults, config_sha256: str, created: str, files: Mapping[str, str]) -> Document:
    """All figures; rms in m/s, root of the mean square over all cut classes and targets unless told by case."""
    sensors = results.problem.sensors
    return {
        "format": "sensor-plan-summary",
        "version": VERSION,
        "created": created,
        "generator": {"name": "retarder-synth", "version": version("retarder-synth"), "config_sha256": config_sha256},
        "method": METHOD,
        "decides_on": "every_axle" if sensors.axles is every_axle else "first_axle",
        "cases": [
            {"label": label, "targets_m_s": [aim.target_speed_m_s for aim in case.aims]}
            for label, case in zip(results.labels, results.problem.cases, strict=True)
        ],
        "radar": {"rms_m_s": rounded(results.radar_mean_rms_m_s), "by_case_m_s": nested(results.radar_rms_m_s)},
        "rule": judged(results, results.rule),
        "plans": [
            {"planned": judged(results, plan.best), "equal_sections": judged(results, plan.equal)}
            for plan in results.plans
        ],
        "wanted_rms_m_s": rounded(results.wanted_rms_m_s),
        "chosen": None if results.chosen is None else judged(results, results.chosen.best),
        "files": dict(files),
    }


def judged(results: LayoutResults, layout: JudgedLayout) -> dict[str, Any]:
    """One layout with its places, the one behind the exit included, and what it gives."""
    return {
        "sensors": len(layout.deciding_m) + 1,
        "path_m": list(all_places(results, layout)),
        "rms_m_s": rounded(layout.rms_m_s),
        "by_case_m_s": nested(tuple(tuple(each.rms_m_s for each in case) for case in layout.tuned)),
    }


def all_places(results: LayoutResults, layout: JudgedLayout) -> tuple[float, ...]:
    """The places of all sensors, with the one behind the exit of the longest cut."""
    exit_m = max(case.plant.exit_m for case in results.problem.cases)
    return with_layout(results.problem.sensors, layout.deciding_m, exit_m).path_m


def layout_toml(results: LayoutResults, chosen: PlannedLayout) -> str:
    """The chosen layout as lines for the section [sensors] of a configuration."""
    places = ", ".join(f"{place:g}" for place in all_places(results, chosen.best))
    rms = f"{chosen.best.rms_m_s:.4f}"
    return f"# made by retarder-synth sensors plan: predicted rms {rms} m/s\n[sensors]\npath_m = [{places}]\n"


def rounded(value: float) -> float:
    """For printing."""
    return round(value, DIGITS)


def nested(values: tuple[tuple[float, ...], ...]) -> list[list[float]]:
    """By case and aim, for printing."""
    return [[rounded(value) for value in case] for case in values]
