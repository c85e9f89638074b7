"""Pictures of a control computer."""

from synth.computer.pictures.pay_back_over_traffic import pay_back_over_traffic
from synth.computer.pictures.tornado_bars import tornado_bars
from synth.computer.pictures.upkeep_interval import upkeep_interval
from synth.computer.pictures.waits import waits

__all__ = ["pay_back_over_traffic", "tornado_bars", "upkeep_interval", "waits"]
