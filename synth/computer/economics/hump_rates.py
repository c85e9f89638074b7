"""The figures of a hump as plain numbers, and how they change."""

from __future__ import annotations

from typing import Final

from synth.computer.origins import STUDY
from synth.frame.settings.changed import changed
from synth.frame.settings.section import Section, needed, setting

SHARES: Final = ("catch_ups", "misrouted", "on_track", "over_speeds_to_1_5", "over_speeds_to_2", "over_speeds_above_2")


class HumpRates(Section):
    """What a hump does with its cars."""

    cars_per_h: float = needed("1/h", 1e-6, 1e5, "cars an hour while a train is humped", STUDY)
    catch_ups: float = needed("1", 0.0, 1.0, "of all cuts: misrouted, or in contact ahead of the last position", STUDY)
    misrouted: float = needed("1", 0.0, 1.0, "of all cuts: on a wrong track", STUDY)
    on_track: float = needed("1", 0.0, 1.0, "of all cuts: those that reached their track alone", STUDY)
    over_speeds_to_1_5: float = needed("1", 0.0, 1.0, "of these: couplings at 1.39 to 1.5 m/s", STUDY)
    over_speeds_to_2: float = needed("1", 0.0, 1.0, "of these: couplings at 1.5 to 2 m/s", STUDY)
    over_speeds_above_2: float = needed("1", 0.0, 1.0, "of these: couplings above 2 m/s", STUDY)
    gap_m: float = needed("m", 0.0, 1e4, "free metres that a cut on its track leaves ahead of it", STUDY)


class HumpChange(Section):
    """By how much each figure is larger with the new control; 0 where it is not told."""

    cars_per_h: float = setting(0.0, "1/h", -1e5, 1e5, "cars an hour while a train is humped", STUDY)
    catch_ups: float = setting(0.0, "1", -1.0, 1.0, "of all cuts", STUDY)
    misrouted: float = setting(0.0, "1", -1.0, 1.0, "of all cuts", STUDY)
    on_track: float = setting(0.0, "1", -1.0, 1.0, "of all cuts", STUDY)
    over_speeds_to_1_5: float = setting(0.0, "1", -1.0, 1.0, "of the cuts on their track", STUDY)
    over_speeds_to_2: float = setting(0.0, "1", -1.0, 1.0, "of the cuts on their track", STUDY)
    over_speeds_above_2: float = setting(0.0, "1", -1.0, 1.0, "of the cuts on their track", STUDY)
    gap_m: float = setting(0.0, "m", -1e4, 1e4, "free metres a cut", STUDY)


RATES: Final = tuple(HumpRates.model_fields)
"""The names of the figures, in their order."""


def rates_after(today: HumpRates, change: HumpChange) -> HumpRates:
    """`today` plus `change`; `PlantError` where no car an hour is left.

    Shares stay within 0 and 1 and gaps at 0 or more: a change that is drawn from its interval can take a rare share
    below nothing.
    """
    made = {name: getattr(today, name) + getattr(change, name) for name in RATES}
    for name in SHARES:
        made[name] = min(max(made[name], 0.0), 1.0)
    made["gap_m"] = max(made["gap_m"], 0.0)
    return changed(today, **made)
