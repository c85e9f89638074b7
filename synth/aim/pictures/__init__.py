"""The pictures of an aim: what exit speeds give on the track, and what tables command."""

from synth.aim.pictures.chances import chances
from synth.aim.pictures.commands import commands_by_cars, commands_by_resistance
from synth.aim.pictures.gaps import gaps
from synth.aim.pictures.track import track

__all__ = ["chances", "commands_by_cars", "commands_by_resistance", "gaps", "track"]
