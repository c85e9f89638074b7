"""How exactly cuts left each position, and which aim tables commanded the last ones."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from synth.frame.exhibits import Column, Exhibit, Row, Sentence, Table
from synth.frame.printed_numbers import decimals
from synth.hump.trains.aim_choice import AimChoice
from synth.hump.trains.hump_routes import HumpRoutes
from synth.hump.trains.humped_trial import HumpedTrial
from synth.hump.trains.position_choice import PositionChoice
from synth.hump.trains.train_figures import interval_of, ratio

POSITIONS: Final = (
    Column("number", "position"),
    Column("site", "is", words=True),
    Column("aims_on_tracks", "aims on tracks", words=True),
    Column("passes", "passes"),
    Column("rms_of_exit_less_command_m_s", "rms of exit less command", "m/s", decimals(3)),
    Column("strokes_per_pass", "commands to valves a pass"),
)
AIMS: Final = (
    Column("tracks", "tracks", words=True, once=True),
    Column("retarders", "retarders", words=True, once=True),
    Column("id", "table", words=True),
    Column("position", "position", words=True),
    Column("category", "weight category", words=True),
    Column("knowledge", "by", words=True),
    Column("p_overspeed", "p"),
    Column("coupling_speed_m_s", "coupling speed", "m/s"),
    Column("created", "made", words=True),
    Column("config_sha256", "of the configuration", words=True),
)
AIMED: Final = (
    "Exit speeds of the last position of these tracks are the answers of these tables, by the rule of controllers. "
    "Where a table has no answer its lowest speed is commanded. On other tracks they were chosen for this trial."
)


def positions(result: HumpedTrial) -> Iterator[Exhibit]:
    """A row for each position, and for each aim table."""
    rows = [position_row(result, choice, place) for place, choice in enumerate(result.config.positions)]
    yield Table("positions", "Positions", POSITIONS, rows)
    if result.config.aims:
        yield Sentence(AIMED)
        aims = [row for choice in result.config.aims for row in aim_rows(result.config.routes, choice)]
        yield Table("aim-tables", "Aim tables", AIMS, aims)


def position_row(result: HumpedTrial, choice: PositionChoice, place: int) -> Row:
    """The tracks on whose routes the position is the last one, so that it aims; its passes, how exactly cuts left it,
    and commands to its valves, none where none are modelled."""
    found = result.found
    passes, strokes = found.passes[:, place].astype(float), found.strokes[:, place].astype(float)
    rms, low, high = (root(each) for each in ratio(found.error2_m2_s2[:, place], passes))
    return {
        "number": choice.number,
        "site": choice.site,
        "aims_on_tracks": aimed_tracks(result.config.routes, place + 1),
        "passes": int(passes.sum()),
        "rms_of_exit_less_command_m_s": interval_of(rms, low, high, len(found)),
        "strokes_per_pass": interval_of(*ratio(strokes, passes), len(found)) if strokes.any() else None,
    }


def root(square: float) -> float:
    """Of a mean square, whose interval may begin below 0."""
    return math.sqrt(max(square, 0.0)) if math.isfinite(square) else square


def aimed_tracks(routes: HumpRoutes, number: int) -> tuple[int, ...]:
    """Tracks of the routes that have `number` positions."""
    return tuple(int(track) for track in np.sort(routes.tracks[routes.positions_of == number]))


def aim_rows(routes: HumpRoutes, choice: AimChoice) -> Iterator[Row]:
    """The tables that command the last position, and on which tracks."""
    for table in choice.tables.tables:
        yield {
            "tracks": tuple(sorted(int(routes.tracks[row]) for row in choice.rows)),
            "retarders": choice.retarders,
            "id": table.id,
            "position": table.position.name,
            "category": table.category.name,
            "knowledge": "measured" if table.is_measured else "category",
            "p_overspeed": table.required.p_overspeed,
            "coupling_speed_m_s": table.required.coupling_speed_m_s,
            "created": table.created,
            "config_sha256": table.generator.config_sha256,
        }
