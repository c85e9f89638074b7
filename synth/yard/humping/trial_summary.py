"""summary.json and figures.csv of a hump trial: the figures for programs, and the hashes of the files beside them."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from typing import Any

import numpy as np

from synth.frame.summary import plain
from synth.yard.humping.aim_choice import AimChoice
from synth.yard.humping.hump_routes import HumpRoutes
from synth.yard.humping.outcomes import TrainOutcomes
from synth.yard.humping.resolved_trial import ResolvedTrial
from synth.yard.humping.train_figures import TrainFigure
from synth.yard.humping.trial_acceptance import TrialVerdict
from tuning_tables.sheet import sheet

VERSION = 1

Figures = Sequence[TrainFigure]


def trial_summary(
    config: ResolvedTrial, found: TrainOutcomes, figures: Figures, verdict: TrialVerdict, created: str,
    file_hashes: Mapping[str, str],
) -> dict[str, Any]:  # fmt: skip
    """The document; `file_hashes`: SHA-256 by file name, all files but summary.json itself."""
    document = {
        "format": "hump-trial-summary",
        "version": VERSION,
        "created": created,
        "generator": {"name": "retarder-synth", "version": version("retarder-synth"), "config_sha256": config.sha256},
        "title": config.title,
        "config": json.loads(config.canonical_json),
        "trains_sha256": config.trains_sha256,
        "warnings": config.warnings,
        "parameters_assumed": [value.key for value in config.parameters if value.assumed],
        "accepted": verdict.accepted,
        "verdict": verdict.sentence,
        "missed_limits": verdict.missed,
        "undecided_limits": verdict.undecided,
        "trains": len(found),
        "cuts": int(found.cuts.sum()),
        "cars": int(found.cars.sum()),
        "figures": {figure.name: figure_of(figure) for figure in figures},
        "elements": elements_of(config, found),
        "positions": positions_of(config, found),
        "aim_tables": [aim_of(config, choice) for choice in config.aims],
        "files": dict(file_hashes),
    }
    plain_document: dict[str, Any] = plain(document)
    return plain_document


def figure_of(figure: TrainFigure) -> dict[str, Any]:
    """A figure with its 95 % interval; `enough_n`: see `TrainFigure`."""
    return {
        "value": figure.value,
        "ci95": [figure.low95, figure.high95],
        "unit": figure.unit,
        "n": figure.n,
        "enough_n": figure.enough_n,
    }


def elements_of(config: ResolvedTrial, found: TrainOutcomes) -> dict[str, Any]:
    """Counts of cuts at each element where there was one at all, by its number."""
    counts = {
        name: getattr(found, name).sum(axis=0) for name in ("misrouted", "contact", "unseparated", "foul")
    }  # fmt: skip
    return {
        str(number): {name: int(each[column]) for name, each in counts.items()}
        for column, number in enumerate(config.routes.numbers)
        if any(each[column] for each in counts.values())
    }


def positions_of(config: ResolvedTrial, found: TrainOutcomes) -> list[dict[str, Any]]:
    """The tracks on whose routes each position is the last one, so that it aims; its passes, how exactly cuts left it,
    and commands to its valves, None where none are modelled."""
    passes, error2, strokes = (each.sum(axis=0) for each in (found.passes, found.error2_m2_s2, found.strokes))
    return [
        {
            "number": choice.number,
            "site": choice.site,
            "aims_on_tracks": aimed_tracks(config.routes, place + 1),
            "passes": int(passes[place]),
            "rms_of_exit_less_command_m_s": float((error2[place] / passes[place]) ** 0.5) if passes[place] else None,
            "strokes_per_pass": float(strokes[place] / passes[place]) if strokes[place] else None,
        }
        for place, choice in enumerate(config.positions)
    ]


def aim_of(config: ResolvedTrial, choice: AimChoice) -> dict[str, Any]:
    """Which aim tables command the last position, and on which tracks."""
    return {
        "tracks": sorted(int(config.routes.tracks[row]) for row in choice.rows),
        "retarders": choice.retarders,
        "tables": [
            {
                "id": table.id,
                "created": table.created,
                "config_sha256": table.generator.config_sha256,
                "category": table.category.name,
                "knowledge": "measured" if table.is_measured else "category",
                "p_overspeed": table.required.p_overspeed,
                "coupling_speed_m_s": table.required.coupling_speed_m_s,
            }
            for table in choice.tables.tables
        ],
    }


def aimed_tracks(routes: HumpRoutes, number: int) -> list[int]:
    """Tracks of the routes that have `number` positions."""
    return [int(track) for track in np.sort(routes.tracks[routes.positions_of == number])]


def figures_csv(figures: Figures) -> bytes:
    """The figures as CSV, a row each."""
    rows = [(f.name, f.unit, repr(float(f.value)), repr(float(f.low95)), repr(float(f.high95)), f.n) for f in figures]
    return sheet(("figure", "unit", "value", "low95", "high95", "n"), rows)
