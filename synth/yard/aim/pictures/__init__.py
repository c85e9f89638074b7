"""The pictures of an aim: what exit speeds give on the track, and what tables command."""

from synth.yard.aim.pictures.chances import chances
from synth.yard.aim.pictures.commands import commands_by_cars, commands_by_resistance
from synth.yard.aim.pictures.gaps import gaps
from synth.yard.aim.pictures.track import track

__all__ = ["chances", "commands_by_cars", "commands_by_resistance", "gaps", "track"]
