"""Pictures of humped trains: time and speed over path, hump speeds, catch-ups on the plan, couplings and gaps."""

from synth.hump.trains.pictures.catch_ups import catch_ups
from synth.hump.trains.pictures.couplings import couplings
from synth.hump.trains.pictures.hump_speed_program import PushedTrain, hump_speed_program
from synth.hump.trains.pictures.speed_path import speed_path
from synth.hump.trains.pictures.time_path import time_path

__all__ = [
    "PushedTrain",
    "catch_ups",
    "couplings",
    "hump_speed_program",
    "speed_path",
    "time_path",
]
