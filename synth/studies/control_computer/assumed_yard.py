"""The yard that the benefit is told for: every number is assumed, none was chosen to give a result."""

from __future__ import annotations

from synth.yard.control_computer.economics.prices import Prices
from synth.yard.control_computer.economics.regulator_benefit import Yard
from synth.yard.control_computer.economics.traffic import Handling, Traffic

YARD = Yard(
    traffic=Traffic(
        cars_per_day=4000.0,
        cars_per_train=72.0,
        cars_per_train_std=12.0,
        cars_per_cut=1.8,
        arrival_scv=1.0,
        loaded_share=0.6,
        load_t=50.0,
    ),
    handling=Handling(
        between_trains_h=0.1,
        between_trains_std_h=0.03,
        locomotive_h_per_gap_m=1e-4,
        locomotive_h_per_misrouted_cut=0.25,
        blocked_share=0.3,
    ),
    prices=Prices(
        currency="EUR",
        per_locomotive_h=200.0,
        per_car_h=0.5,
        per_car=40_000.0,
        per_cargo_t=600.0,
        per_over_speed_to_1_5=2.0,
        per_over_speed_to_2=20.0,
        per_over_speed_above_2=300.0,
        per_catch_up=50.0,
        per_misrouted_cut=30.0,
        per_gap_m=0.01,
    ),
)
"""One lead, trains that come at random; 40 cuts of 1.8 cars a train, as the trains of the trials have."""
