"""The yard that the benefit is told for: that of the built-in configuration of a control computer."""

from __future__ import annotations

from scripts.studies.control_computer.regulator_benefit import Yard
from synth.configuration.computer.money_settings import HandlingSettings, PriceSettings, TrafficSettings
from synth.yard.control_computer.economics.prices import Prices
from synth.yard.control_computer.economics.traffic import Handling, Traffic

YARD = Yard(
    traffic=Traffic(**TrafficSettings().model_dump()),
    handling=Handling(**HandlingSettings().model_dump()),
    prices=Prices(**PriceSettings().model_dump()),
)
"""Every number of it is assumed; none was chosen to give a result. 40 cuts of 1.8 cars a train, as in the trials."""
