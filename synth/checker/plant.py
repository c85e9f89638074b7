"""The plant of a tune, read from the resolved configuration in its summary.json."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Final

from synth.checker.content import canonical_form
from synth.checker.drawn_cuts import Entry, entry_of
from synth.checker.finding import shown

GRAVITY_M_S2: Final = 9.81
WHEELSET_T: Final = 0.42
"""Equivalent mass of a rotating wheel set."""


class UnusableConfigError(Exception):
    """The configuration describes no plant; the message is one sentence."""


@dataclass(frozen=True)
class Drive:
    """Pneumatics of the position; pressures kPa gauge, times s."""

    supply_kpa: float
    exhaust_kpa: float
    brake_delay_s: float
    touch_delay_s: float
    release_delay_s: float
    fill_s: float
    exhaust_s: float
    band_kpa: float
    closing_delay_s: float
    touch_kpa: float


@dataclass(frozen=True)
class Plant:
    """A cut in a position, and what is random about it.

    `slope_kn_per_kpa[N − 1]`: force of one wheel pair per kPa over the touch pressure, N of them braked.
    `grades`: (start in m, permille, downhill positive), the first also before its start. The regulator acts from
    `approach_m` before the entrance on, finds the brake at rest in `initial_stage`, and commands no stage above
    `entrance_stage` there; 0 m: from the entrance on.
    """

    zones_m: tuple[tuple[float, float], ...]
    stages_kpa: tuple[float, ...]
    slope_kn_per_kpa: tuple[float, ...]
    drive: Drive
    grades: tuple[tuple[float, float], ...]
    mass_t: float
    axle_offsets_m: tuple[float, ...]
    resistance_n_kn: tuple[float, float]
    friction_cv: float
    axle_cv: float
    mean_cv: float
    friction_floor: float
    path_std: float
    correlation_m: float
    noise_m_s: float
    resolution_m_s: float
    period_s: float
    computing_s: float
    missed_share: float
    missed_burst_s: float
    entry: Entry
    approach_m: float
    initial_stage: int
    entrance_stage: int

    @property
    def exit_m(self) -> float:
        """Path of the first axle when the last one leaves the last zone."""
        return self.zones_m[-1][1] + self.axle_offsets_m[-1]

    @property
    def inertia_t(self) -> float:
        """Mass with the rotating wheel sets."""
        return self.mass_t + WHEELSET_T * len(self.axle_offsets_m)

    def braked(self, s_m: float) -> int:
        """Wheel pairs inside any zone while the first axle stands at `s_m`."""
        places = [s_m - x for x in self.axle_offsets_m]
        return sum(begin <= place < end for place in places for begin, end in self.zones_m)

    def grade_work(self, begin_m: float, end_m: float) -> float:
        """Integral of the mean grade under the axles, permille times m, exact piece by piece."""
        places = {start + x for start, _ in self.grades for x in self.axle_offsets_m}
        edges = [begin_m, *sorted(s for s in places if begin_m < s < end_m), end_m]
        return math.fsum(self.grade_permille(0.5 * (a + b)) * (b - a) for a, b in pairwise(edges))

    def grade_permille(self, s_m: float) -> float:
        """Mean grade under the axles."""
        places = [s_m - x for x in self.axle_offsets_m]
        found = [max((g for g in self.grades if g[0] <= place), default=self.grades[0])[1] for place in places]
        return math.fsum(found) / len(found)


@dataclass(frozen=True)
class Reader:
    """Numbers of a configuration by dotted key, each within limits; `UnusableConfigError` names what is wrong."""

    config: Mapping[str, Any]

    def value(self, key: str) -> Any:
        """Whatever stands at `key`."""
        found: Any = self.config
        for part in key.split("."):
            if not isinstance(found, dict) or part not in found:
                raise UnusableConfigError(f"its configuration has no {key}")
            found = found[part]
        return found

    def number(self, key: str, low: float = 0.0, high: float = 1e4) -> float:
        """The number at `key`."""
        return checked(self.value(key), key, low, high)

    def stage(self, key: str, absent: int, highest: int) -> int:
        """The number of a stage at `key`, `absent` where there is no such key."""
        section, _, name = key.rpartition(".")
        there = self.value(section) if section else self.config
        if not isinstance(there, dict) or name not in there:
            return absent
        found = self.number(key, 0, highest)
        if found != int(found):
            raise UnusableConfigError(f"{key} of its configuration is {found:g}, no stage")
        return int(found)

    def numbers(self, key: str, low: float = 0.0, high: float = 1e4) -> tuple[float, ...]:
        """The list of numbers at `key`."""
        return tuple(checked(x, key, low, high) for x in a_list(self.value(key), key))

    def pairs(self, key: str, low: float = 0.0, high: float = 1e4) -> tuple[tuple[float, float], ...]:
        """The list of pairs of numbers at `key`."""
        found = [tuple(checked(x, key, low, high) for x in a_list(item, key)) for item in a_list(self.value(key), key)]
        if any(len(item) != 2 for item in found):
            raise UnusableConfigError(f"{key} of its configuration holds something else than pairs")
        return tuple((item[0], item[1]) for item in found)


def checked(value: Any, key: str, low: float, high: float) -> float:
    """`value` as a number within its limits."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not low <= value <= high:
        raise UnusableConfigError(f"{key} of its configuration is {shown(value)}, no number from {low:g} to {high:g}")
    return float(value)


def a_list(value: Any, key: str) -> list[Any]:
    """`value` as a list that is not empty, and not too long."""
    if not isinstance(value, list) or not 1 <= len(value) <= 1000:
        raise UnusableConfigError(f"{key} of its configuration is {shown(value)}, but it must be a list")
    return value


def plant_of(config: Mapping[str, Any], cut: Mapping[str, Any]) -> Plant:
    """The plant of one entry of the configuration's `cut`; `UnusableConfigError` where it describes none."""
    at, of = Reader(config), Reader(cut)
    mass_t, offsets = of.number("mass_t", 1.0, 1e5), of.numbers("axle_offsets_m")
    factors = at.numbers("retarder.force.slope_factor_by_axles", 1e-3, 100.0)
    weighed = at.value("retarder.law") == "weight"
    key = "retarder.force.slope_kn_per_kpa" + ("_per_t" if weighed else "")
    slope = at.number(key) * (mass_t / len(offsets) if weighed else 1.0)
    grade = at.value("track.grade_permille")
    pieces = at.pairs("track.grade_permille", -1e5, 1e5) if isinstance(grade, list) else None
    return Plant(
        zones_m=at.pairs("retarder.zones_m", 0.0, 1000.0),
        stages_kpa=at.numbers("retarder.stage_pressures_kpa"),
        slope_kn_per_kpa=tuple(slope * factors[min(n, len(factors) - 1)] for n in range(len(offsets))),
        drive=drive_of(at),
        grades=pieces or ((0.0, at.number("track.grade_permille", -100.0, 100.0)),),
        mass_t=mass_t,
        axle_offsets_m=offsets,
        resistance_n_kn=(
            of.number("rolling_resistance.mean_n_per_kn", 1e-3, 100.0),
            of.number("rolling_resistance.std_n_per_kn", 0.0, 100.0),
        ),
        friction_cv=at.number("friction.common_cv", 0.0, 1.0),
        axle_cv=at.number("friction.axle_cv", 0.0, 1.0),
        # Older configurations took the mean friction as known.
        mean_cv=at.number("friction.mean_cv", 0.0, 1.0) if "mean_cv" in at.value("friction") else 0.0,
        friction_floor=at.number("friction.floor", 0.0, 1.0),
        path_std=at.number("friction.path_std", 0.0, 1.0),
        correlation_m=at.number("friction.correlation_length_m", 1e-3),
        noise_m_s=at.number("sensor.noise_m_s", 0.0, 10.0),
        resolution_m_s=at.number("sensor.resolution_m_s", 0.0, 10.0),
        period_s=at.number("sensor.sample_period_s", 1e-3, 10.0),
        computing_s=at.number("sensor.computing_delay_s", 0.0, 10.0),
        missed_share=at.number("sensor.missed_share", 0.0, 0.5),
        missed_burst_s=at.number("sensor.missed_burst_s", 0.0, 100.0),
        entry=entry_speeds(of if "entry" in cut else at),
        **approach_of(at, of),
    )


def approach_of(at: Reader, of: Reader) -> dict[str, Any]:
    """What the keys of a configuration and of one of its cuts say of the approach; without them there is none."""
    regulator = at.config.get("regulator")
    top = len(at.numbers("retarder.stage_pressures_kpa")) - 1
    entrance_stage = of.stage("entrance_stage", top, top)
    known = regulator if isinstance(regulator, dict) else {}
    return {
        "approach_m": at.number("regulator.approach_m", 0.0, 100.0) if "approach_m" in known else 0.0,
        "initial_stage": at.stage("regulator.initial_stage", 0, entrance_stage) if "initial_stage" in known else 0,
        "entrance_stage": entrance_stage,
    }


def entry_speeds(of: Reader) -> Entry:
    """The law of the entry speeds of a class that has its own, or of the configuration."""
    table = of.value("entry")
    keys = set(table) if isinstance(table, dict) else set()
    found = entry_of(
        keys,
        lambda key, low, high: of.number(f"entry.{key}", low, high),
        lambda key, low, high: of.numbers(f"entry.{key}", low, high),
    )
    if found is None:
        raise UnusableConfigError(f"entry of its configuration is {shown(table)}, no law of entry speeds")
    return found


def drive_of(at: Reader) -> Drive:
    """The pneumatics of a configuration."""

    def of(name: str, low: float = 0.0) -> float:
        return at.number(f"retarder.pneumatics.{name}", low)

    return Drive(
        supply_kpa=of("supply_pressure_kpa"),
        exhaust_kpa=of("exhaust_pressure_kpa"),
        brake_delay_s=of("brake_delay_s"),
        touch_delay_s=of("touch_delay_s"),
        release_delay_s=of("release_delay_s"),
        fill_s=of("fill_time_constant_s", 1e-3),
        exhaust_s=of("exhaust_time_constant_s", 1e-3),
        band_kpa=of("dead_band_kpa", 1e-3),
        closing_delay_s=of("closing_delay_s"),
        touch_kpa=at.number("retarder.force.touch_pressure_kpa"),
    )


def config_sha256(config: Mapping[str, Any]) -> str:
    """The hash of a resolved configuration in its canonical form."""
    return hashlib.sha256(canonical_form(config).encode("utf-8")).hexdigest()
