"""From a hump trial configuration to the trial: sources, position models, planner, control, aim."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from plant_models import PlantError
from plant_models.library import load_position
from plant_models.library.position_entry import PositionEntry
from synth.frame.input_error import InputError
from synth.hump.trains.class_choice import ClassChoice
from synth.hump.trains.hump_position import HumpPosition
from synth.hump.trains.hump_speed import HumpSpeedLimits, SpeedMethod, pair_by_pair, whole_train
from synth.hump.trains.normal_hump_position import LibraryBrake, NormalHumpPosition
from synth.hump.trains.position_choice import PositionChoice
from synth.hump.trains.resolved_trial import ResolvedTrial
from synth.hump.trains.route_ways import route_ways
from synth.hump.trains.table_hump_position import TableHumpPosition
from synth.hump.trains.train_plan import Planner
from synth.hump.trains.train_source import TrainSource
from synth.hump.trains.trial import Control, HumpTrial, Sensing
from synth.hump.trains.trial_aim import trial_aim
from synth.retarder.book_classes import book_classes
from synth.retarder.table_class import TableClass

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
