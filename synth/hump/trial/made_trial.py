"""From a hump trial configuration to the trial: sources, position models, planner, control; and what positions aim
with, exported aim tables where some are named, else speeds that are chosen for the trial.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from plant_models import PlantError
from plant_models.frozen_arrays import Ints
from plant_models.library import load_position
from plant_models.library.position_entry import PositionEntry
from synth.aim.knowledge import ByCategory, Requirement
from synth.aim.position_models import NormalPosition
from synth.frame.faults import InputError
from synth.hump.planning.aim_control import HumpAim, joined_aims, no_aim
from synth.hump.planning.aim_design import AimDesign, MeasuredAhead, hump_aim
from synth.hump.planning.speed_rules import HumpSpeedLimits, SpeedMethod, pair_by_pair, whole_train
from synth.hump.planning.train_plan import Planner
from synth.hump.rolling.hump_position import HumpPosition, LibraryBrake, NormalHumpPosition
from synth.hump.rolling.list_trains import TrainSource
from synth.hump.rolling.route_rolling import route_ways
from synth.hump.rolling.table_hump_position import ClassChoice, TableHumpPosition
from synth.hump.trial.position_choice import PositionChoice
from synth.hump.trial.resolved_trial import ResolvedTrial
from synth.hump.trial.table_aim import table_aim
from synth.hump.trial.trial import Control, HumpTrial, Sensing
from synth.hump.trial.trial_parameters import aim_range_m_s
from synth.retarder.forms.tables_at import tables_at
from synth.retarder.table_class import TableClass, book_classes


def trial_aim(config: ResolvedTrial, threads: int) -> HumpAim:
    """The exit speeds of the position that aims on each route; `threads` choose them."""
    parts: list[tuple[Ints, HumpAim]] = []
    for choice in config.aims:
        design = design_of(config, threads, config.positions[-1])
        parts.append((np.array(choice.rows), table_aim(choice, config.routes, config.kinds, design)))
    for number in np.unique(config.routes.positions_of[list(config.designed_rows)]):
        rows = np.array([row for row in config.designed_rows if config.routes.positions_of[row] == number])
        design = design_of(config, threads, config.positions[number - 1])
        parts.append((rows, hump_aim(config.routes, design, rows)))
    if not parts:
        return no_aim(len(config.routes.routes), len(config.categories.members), config.settings.aim.lowest_m_s)
    return joined_aims(parts, len(config.routes.routes))


def design_of(config: ResolvedTrial, threads: int, last: PositionChoice) -> AimDesign:
    """How the exit speeds of the position `last` are chosen: for the error of its controller."""
    aim = config.settings.aim
    measured = aim.knowledge == "measured"
    return AimDesign(
        population=config.people,
        position=NormalPosition(stated_exit_std_m_s(last)),
        requirement=Requirement(aim.p_overspeed, aim_range_m_s(aim, last)),
        knowledge=MeasuredAhead(config.settings.sensors.speed_std_m_s) if measured else ByCategory(),
        design_cuts=aim.design_cuts,
        seed=config.settings.trains.seed,
        threads=threads,
        coupling_speed_m_s=config.settings.couplings.allowed_m_s,
    )


def stated_exit_std_m_s(choice: PositionChoice) -> float:
    """What an aim takes for the error of a position: of a book, the root mean square of what its tables predict."""
    if choice.book is None:
        return choice.exit_std_m_s or 0.0
    tables = tables_at(choice.book).only_lines("a position of a trial")
    return float(np.sqrt(np.mean([table.predicted.rms_m_s**2 for table in tables])))


METHODS: dict[str, SpeedMethod] = {"whole-train": whole_train, "pair-by-pair": pair_by_pair}


def made_trial(config: ResolvedTrial, threads: int = 0) -> HumpTrial:
    """The trial; `threads` roll cuts and choose aims, 0: one a processor, and change no result.

    `InputError` for a book of tables that does not fit, `TableError` for a damaged one.
    """
    brakes = tuple(brake_of(each, config) for each in config.positions)
    positions = tuple(position_of(each, brake, config) for each, brake in zip(config.positions, brakes, strict=True))
    usable, trains = config.settings.exit_speeds.usable_share, config.settings.trains
    return HumpTrial(
        source=TrainSource(
            config.trains, config.people, config.routes.routes, trains.seed, trains.cuts, trains.one_wind_a_train
        ),
        routes=config.routes,
        ways=route_ways(config.people, config.routes.routes),
        positions=positions,
        planner=planner_of(config),
        control=control_of(config),
        aim=trial_aim(config, threads),
        usable_heads_m=tuple(replace(brake, share=usable * brake.share).head_m for brake in brakes),
        full_heads_m=tuple(brake.head_m for brake in brakes),
        threads=threads,
        couplings=config.settings.couplings,
        tracks=config.settings.tracks,
    )


def site_of(choice: PositionChoice, config: ResolvedTrial) -> PositionEntry:
    """The position of the library that stands there."""
    try:
        return load_position(choice.site, config.library)
    except PlantError as fault:
        raise InputError(
            f"{config.place}: position {choice.number}: {fault}; a position of your own comes from a folder of library"
        ) from None


def brake_of(choice: PositionChoice, config: ResolvedTrial) -> LibraryBrake:
    """The full brake of a position; axles stand as in the most frequent car of the mix."""
    share = 0.0 if choice.out_of_service else choice.supply_share
    usual = max(config.people.mix.cars, key=lambda each: each.share)
    return LibraryBrake(site_of(choice, config).position, config.categories, usual.car, share)


def position_of(choice: PositionChoice, brake: LibraryBrake, config: ResolvedTrial) -> HumpPosition:
    """The model of a position: of one with a book, the closed loops of its tables."""
    if choice.book is None or choice.out_of_service:
        return NormalHumpPosition(choice.exit_std_m_s or 0.0, brake)
    return TableHumpPosition(ClassChoice(classes_of(choice, config), config.categories))


def classes_of(choice: PositionChoice, config: ResolvedTrial) -> tuple[TableClass, ...]:
    """The classes of the book of a position; `InputError` for one that does not fit, `TableError` if damaged."""
    assert choice.book is not None
    named = f"{config.place}: position {choice.number}"
    return book_classes(named, choice.book, choice.tuned_with, choice.site, "what stands there")


def planner_of(config: ResolvedTrial) -> Planner:
    """How trains are planned."""
    speed = config.settings.hump_speed
    return Planner(
        routes=config.routes,
        limits=HumpSpeedLimits(steps_m_s(config), speed.acceleration_m_s2),
        roles=config.roles,
        least_s=speed.least_s,
        early_s=speed.early_s,
        worst_pair=speed.worst_pair,
        method=METHODS[speed.method],
    )


def steps_m_s(config: ResolvedTrial) -> tuple[float, ...]:
    """The steps of the hump signal that uncoupling allows."""
    speed = config.settings.hump_speed
    if speed.constant_m_s is not None:
        return (speed.constant_m_s,)
    highest = min(speed.highest_m_s, speed.uncoupling_m_s)
    count = int(np.floor((highest - speed.lowest_m_s) / speed.step_m_s + 1e-9)) + 1
    return tuple(round(speed.lowest_m_s + place * speed.step_m_s, 6) for place in range(count))


def control_of(config: ResolvedTrial) -> Control:
    """How exit speeds are found while a train is humped."""
    exits, aim = config.settings.exit_speeds, config.settings.aim
    for_intervals, for_aim = exits.knowledge == "measured", aim.knowledge == "measured"
    sensing = None
    if for_intervals or for_aim:
        sensing = Sensing(config.settings.sensors.speed_std_m_s, for_aim, for_intervals)
    return Control(exits.feedback, sensing, config.settings.hump_speed.slow_down_s)
