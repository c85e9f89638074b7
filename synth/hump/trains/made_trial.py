"""From a hump trial configuration to the trial: sources, position models, planner, control, aim."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from plant_models import PlantError
from plant_models.cut import Car
from plant_models.library import load_position
from plant_models.library.position_entry import PositionEntry
from synth.frame.input_error import InputError
from synth.hump.control.sorting_list import SortingList
from synth.hump.trains.class_choice import ClassChoice
from synth.hump.trains.free_tracks import AsInFile, DrawnFree, FreeTracks
from synth.hump.trains.hump_position import HumpPosition
from synth.hump.trains.hump_speed import HumpSpeedLimits, PairByPair, SpeedMethod, WholeTrain
from synth.hump.trains.normal_hump_position import LibraryBrake, NormalHumpPosition
from synth.hump.trains.position_choice import PositionChoice
from synth.hump.trains.resolved_trial import ResolvedTrial
from synth.hump.trains.route_ways import route_ways
from synth.hump.trains.skates import Skates
from synth.hump.trains.table_hump_position import TableHumpPosition
from synth.hump.trains.tracks_between import Shift
from synth.hump.trains.train_plan import Planner
from synth.hump.trains.train_source import DrawnSource, ListSource, TrainSource
from synth.hump.trains.trial import ConstantSpeed, Control, HumpTrial, Program, Sensing, SimulatedPairs
from synth.hump.trains.trial_aim import trial_aim
from synth.retarder.book_classes import book_classes
from synth.retarder.table_class import TableClass

METHODS: dict[str, SpeedMethod] = {"whole-train": WholeTrain(), "pair-by-pair": PairByPair()}


def made_trial(config: ResolvedTrial, threads: int = 0) -> HumpTrial:
    """The trial; `threads` roll cuts and choose aims, 0: one a processor, and change no result.

    `InputError` for a book of tables that does not fit, `TableError` for a damaged one.
    """
    brakes = tuple(brake_of(each, config) for each in config.positions)
    positions = tuple(position_of(each, brake, config) for each, brake in zip(config.positions, brakes, strict=True))
    usable = config.settings.exit_speeds.usable_share
    return HumpTrial(
        source=source_of(config),
        routes=config.routes,
        ways=route_ways(config.people, config.routes.routes),
        positions=positions,
        planner=planner_of(config),
        program=program_of(config),
        control=control_of(config),
        aim=trial_aim(config, threads),
        usable_heads_m=tuple(replace(brake, share=usable * brake.share).head_m for brake in brakes),
        full_heads_m=tuple(brake.head_m for brake in brakes),
        free=free_of(config),
        threads=threads,
        couplings=config.settings.couplings,
        skates=skates_of(config),
        shift=shift_of(config),
    )


def source_of(config: ResolvedTrial) -> TrainSource:
    """Where trains come from."""
    trains, routes = config.settings.trains, config.routes.routes
    if isinstance(config.trains, SortingList):
        return ListSource(config.trains, config.people, routes, trains.seed, trains.one_wind_a_train)
    return DrawnSource(config.trains, config.people, routes, trains.seed, trains.cuts, trains.one_wind_a_train)


def usual_car(config: ResolvedTrial) -> Car:
    """The most frequent car of the mix: axles stand as in it."""
    return max(config.people.mix.cars, key=lambda each: each.share).car


def site_of(choice: PositionChoice, config: ResolvedTrial) -> PositionEntry:
    """The position of the library that stands there."""
    try:
        return load_position(choice.site, config.library)
    except PlantError as fault:
        raise InputError(
            f"{config.place}: position {choice.number}: {fault}; a position of your own comes from a folder of library"
        ) from None


def brake_of(choice: PositionChoice, config: ResolvedTrial) -> LibraryBrake:
    """The full brake of a position."""
    share = 0.0 if choice.out_of_service else choice.supply_share
    return LibraryBrake(site_of(choice, config).position, config.categories, usual_car(config), share)


def position_of(choice: PositionChoice, brake: LibraryBrake, config: ResolvedTrial) -> HumpPosition:
    """The model of a position."""
    if choice.book is None or choice.out_of_service:
        return NormalHumpPosition(choice.exit_std_m_s or 0.0, brake)
    return table_model(choice, config)


def classes_of(choice: PositionChoice, config: ResolvedTrial) -> tuple[TableClass, ...]:
    """The classes of the book of a position; `InputError` for one that does not fit, `TableError` if damaged."""
    assert choice.book is not None
    named = f"{config.place}: position {choice.number}"
    return book_classes(named, choice.book, choice.tuned_with, choice.site, "what stands there")


def table_model(choice: PositionChoice, config: ResolvedTrial) -> HumpPosition:
    """The closed loops of the tables in the book of a position."""
    return TableHumpPosition(ClassChoice(classes_of(choice, config), config.categories))


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


def program_of(config: ResolvedTrial) -> Program:
    """How hump speeds are found."""
    constant = config.settings.hump_speed.constant_m_s
    return SimulatedPairs() if constant is None else ConstantSpeed(constant)


def control_of(config: ResolvedTrial) -> Control:
    """How exit speeds are found while a train is humped."""
    exits, aim = config.settings.exit_speeds, config.settings.aim
    for_intervals, for_aim = exits.knowledge == "measured", aim.knowledge == "measured"
    sensing = None
    if for_intervals or for_aim:
        sensing = Sensing(config.settings.sensors.speed_std_m_s, for_aim, for_intervals)
    return Control(exits.feedback, sensing, config.settings.hump_speed.slow_down_s)


def skates_of(config: ResolvedTrial) -> Skates:
    """Skates on the tracks on which no position aims."""
    rows = np.flatnonzero(~config.roles.aims.any(axis=0))
    return Skates(config.settings.tracks.skates_share, tuple(rows.tolist()))


def shift_of(config: ResolvedTrial) -> Shift:
    """Which trains come to the same tracks."""
    tracks = config.settings.tracks
    return Shift(tracks.shift_trains, tracks.pulled_from_share)


def free_of(config: ResolvedTrial) -> FreeTracks:
    """Where cars stand before each train."""
    tracks = config.settings.tracks
    return AsInFile() if tracks.standing == "file" else DrawnFree(tracks.free_low, tracks.free_high)
