"""What a bad day does: a position out of service, low supply, winter, wind, oiled wheels."""

from __future__ import annotations

from dataclasses import replace

from scripts.studies.humping.base_trial import Day, UnknownWind, braked_by
from scripts.studies.humping.day_figures import Pair
from scripts.studies.study import Tell
from synth.hump.trains.trial import HumpTrial

WEAKER, OILED = 0.6, 0.7
"""Shares of the full brake: low supply, and friction that is 30 % less."""

WIND_M_S = 6.0
COLD = "temperature_c = -20.0\nsnow_n_per_kn = {snow}\n"
SNOW_N_PER_KN = 0.3
"""Assumed."""

TB = '[resistance]\nlaw = "tb-10062"\n'
USUAL = "as planned"


def disturbance_pairs(day: Day, base: HumpTrial, tell: Tell) -> list[Pair]:
    """A pair a disturbance; what the control knows of it is in its name."""
    out = ("", "out_of_service = true\n", "")
    weak = (f"supply_share = {WEAKER}\n",) * 3
    wind = f"[weather]\nhead_wind_mean_m_s = {WIND_M_S}\n"
    cold = "[weather]\n" + COLD.format(snow=SNOW_N_PER_KN)
    pairs = [
        Pair(USUAL, base),
        Pair("position 2 out of service, known", replace(day, positions=out).trial()),
        Pair("position 2 out of service, not known", braked_by(base, 0.0, 1)),
        Pair(f"supply: {WEAKER:g} of the full brakes, known", replace(day, positions=weak).trial()),
        Pair(f"supply: {WEAKER:g} of the full brakes, not known", braked_by(base, WEAKER)),
        Pair("all wheels oiled: friction −30 %, not known", braked_by(base, OILED)),
        Pair("law TB 10062 at +10 °C", replace(day, more=TB).trial()),
        Pair("law TB 10062 at −20 °C, snow", replace(day, more=TB + cold).trial()),
        Pair(f"head wind {WIND_M_S:g} m/s, known", replace(day, more=wind).trial()),
        Pair(
            f"head wind {WIND_M_S:g} m/s, not known",
            replace(base, source=UnknownWind(**vars(base.source), more_m_s=WIND_M_S)),
        ),
    ]
    tell("trials of bad days made")
    return pairs
