"""The runners that a hump is designed for, and what the design test asks of it."""

from __future__ import annotations

from typing import Final

from plant_models.library.sourced_value import JUDGEMENT
from synth.frame.settings.section import Section, setting

NO_TABLE: Final = f"{JUDGEMENT}: no table of the runners that humps are designed for was found"


class DesignSettings(Section):
    """The design test: single cars, a bad runner ahead of a good one ahead of a bad one, and a very good one that the
    brakes must hold."""

    hump_speed_m_s: float = setting(
        1.7, "m/s", 0.3, 4.0, "speed at which the cars are pushed over the crest",
        f"{JUDGEMENT}: 0.8 of a small hump to 1.7 of a very large one are usual",
    )  # fmt: skip
    bad_mass_t: float = setting(22.0, "t", 10.0, 100.0, "mass of the bad runner", NO_TABLE)
    bad_n_per_kn: float = setting(4.0, "N/kN", 0.2, 15.0, "its resistance at standstill on straight track", NO_TABLE)
    bad_head_wind_m_s: float = setting(2.0, "m/s", -15.0, 15.0, "wind against it", NO_TABLE)
    good_mass_t: float = setting(70.0, "t", 10.0, 100.0, "mass of the good runner", NO_TABLE)
    good_n_per_kn: float = setting(0.8, "N/kN", 0.2, 15.0, "its resistance", NO_TABLE)
    good_head_wind_m_s: float = setting(0.0, "m/s", -15.0, 15.0, "wind against it; below 0: from behind", NO_TABLE)
    very_good_mass_t: float = setting(
        85.0, "t", 10.0, 100.0, "mass of the very good runner, which the brakes must hold",
        "[runner-types]: a gondola of 85 t",
    )  # fmt: skip
    very_good_n_per_kn: float = setting(
        0.5, "N/kN", 0.2, 15.0, "its resistance; wind as against the good one", NO_TABLE
    )
    into_track_m: float = setting(
        50.0, "m", 0.0, 500.0, "how far into its track the bad runner must roll", "[hump-height]: 50 to 100 m"
    )
