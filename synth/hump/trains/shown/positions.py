"""How exactly cuts left each position, and which aim tables commanded the last ones."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Final

import numpy as np

from plant_models.frozen_arrays import Floats
from synth.frame.exhibits import Column, Exhibit, Row, Sentence, Table
from synth.frame.interval import Interval
from synth.frame.printed_numbers import decimals, ranges
from synth.hump.planning.position_roles import Fixed
from synth.hump.rolling.hump_routes import HumpRoutes
from synth.hump.trains.humped_trial import HumpedTrial
from synth.hump.trains.shown.figures import in_hundred
from synth.hump.trains.train_figures import MOST_SHORT, interval_of, ratio, share, shift_sums, strengths, weak
from synth.hump.trial.made_trial import stated_exit_std_m_s
from synth.hump.trial.position_choice import PositionChoice
from synth.hump.trial.resolved_trial import ResolvedTrial
from synth.hump.trial.table_aim import AimChoice

POSITIONS: Final = (
    Column("number", "position"),
    Column("site", "is", words=True),
    Column("role", "role", words=True),
    Column("aims_on_tracks", "aims on tracks", words=True, detail=True),
    Column("passes", "passes", spare=4),
    Column("short", "left too fast for want of brake", "%", in_hundred),
    Column("rms_of_exit_less_command_m_s", "rms of exit less command", "m/s", decimals(3)),
    Column("stated_exit_std_m_s", "stated", "m/s", decimals(3), spare=1),
    Column("at_lowest", "commanded its lowest speed", "%", in_hundred, spare=2),
    Column("strokes_per_pass", "commands to valves a pass", spare=3),
)
HOW_TO_READ: Final = (
    "For want of brake: the full brake, at mean friction, leaves these cuts faster than commanded. Stated: the "
    f"standard deviation of the exit speed that the hump file, the configuration or the book has. Above "
    f"{100 * MOST_SHORT:g} % the position is too weak for these cuts: its figures are not those of its regulator."
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
    short = strengths(result.found)
    rows = [position_row(result, choice, place) for place, choice in enumerate(result.config.positions)]
    rows = [{**row, "short": each.told} for row, each in zip(rows, short, strict=True)]
    yield Table("positions", "Positions", POSITIONS, rows, brief=True, bad=lambda row: weak(short[row["number"] - 1]))
    for number, each in enumerate(short, start=1):
        if weak(each):
            yield Sentence(
                f"Warning: the brake of position {number} is too weak for these cuts: {100.0 * each.value:.3g} % "
                "left faster than commanded with all of it.",
                brief=True,
            )
    yield Sentence(HOW_TO_READ)
    if result.config.aims:
        yield Sentence(AIMED)
        labels = {member.number: member.label for member in result.config.categories.members}
        aims = [row for choice in result.config.aims for row in aim_rows(result.config.routes, choice, labels)]
        yield Table("aim-tables", "Aim tables", AIMS, aims)


def position_row(result: HumpedTrial, choice: PositionChoice, place: int) -> Row:
    """The tracks on whose routes the position is the last one, so that it aims; its passes, how exactly cuts left it,
    and commands to its valves, none where none are modelled."""
    found = result.found
    passes, strokes, lowest, error2 = (
        shift_sums(found, each[:, place]) for each in (found.passes, found.strokes, found.at_lowest, found.error2_m2_s2)
    )
    exits = result.config.roles.exits[place]
    rms, low, high = (root(each) for each in ratio(error2, passes))
    return {
        "number": choice.number,
        "site": choice.site,
        "role": role_words(result.config, place),
        "aims_on_tracks": aimed_tracks(result.config, place),
        "passes": int(passes.sum()),
        "rms_of_exit_less_command_m_s": interval_of(rms, low, high, len(passes)),
        "stated_exit_std_m_s": stated_exit_std_m_s(choice),
        "at_lowest": None if isinstance(exits, Fixed) else share_of(lowest, passes),
        "strokes_per_pass": interval_of(*ratio(strokes, passes), len(passes)) if strokes.any() else None,
    }


def root(square: float) -> float:
    """Of a mean square, whose interval may begin below 0."""
    return math.sqrt(max(square, 0.0)) if math.isfinite(square) else square


def share_of(hits: Floats, base: Floats) -> Interval | float:
    """A share of the passes."""
    value, low, high, _ = share(hits, base)
    return interval_of(value, low, high, int(base.sum()))


def role_words(config: ResolvedTrial, place: int) -> str:
    """What a position does with cuts."""
    aimed, roles = aimed_tracks(config, place), config.roles
    if config.positions[place].out_of_service:
        return "out of service"
    kept = "fixed speeds" if isinstance(roles.exits[place], Fixed) else "keeps apart"
    if place not in roles.not_of_all:
        return "aims"
    return f"{kept}; aims on tracks {ranges(aimed)}" if aimed else kept


def aimed_tracks(config: ResolvedTrial, place: int) -> tuple[int, ...]:
    """Tracks of the routes on which the position at `place` aims."""
    return tuple(int(track) for track in np.sort(config.routes.tracks[config.roles.aims[place]]))


def aim_rows(routes: HumpRoutes, choice: AimChoice, labels: Mapping[int, str]) -> Iterator[Row]:
    """The tables that command the last position, and on which tracks; `labels`: of weight categories, by number."""
    for table in choice.tables.tables:
        yield {
            "tracks": tuple(sorted(int(routes.tracks[row]) for row in choice.rows)),
            "retarders": choice.retarders,
            "id": table.id,
            "position": table.position.name,
            "category": labels.get(table.category.number, table.category.name),
            "knowledge": "measured" if table.is_measured else "category",
            "p_overspeed": table.required.p_overspeed,
            "coupling_speed_m_s": table.required.coupling_speed_m_s,
            "created": table.created,
            "config_sha256": table.generator.config_sha256,
        }
