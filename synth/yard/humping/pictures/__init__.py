"""Pictures of humped trains: time and speed over path, hump speeds, catch-ups on the plan, couplings and gaps."""

from synth.yard.humping.pictures.catch_ups import catch_ups
from synth.yard.humping.pictures.couplings import couplings
from synth.yard.humping.pictures.hump_speed_program import hump_speed_program, planned_train, pushed_train
from synth.yard.humping.pictures.speed_path import speed_path
from synth.yard.humping.pictures.time_path import time_path

__all__ = [
    "catch_ups",
    "couplings",
    "hump_speed_program",
    "planned_train",
    "pushed_train",
    "speed_path",
    "time_path",
]
