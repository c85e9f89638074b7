"""Pneumatic drive: relay pressure regulator, valve delays, first-order filling and exhausting (zhukovitsky-2012).

The pressure after a command is known in advance, because the regulator is deterministic: it is worked
out here once, as pieces of exponentials, for the solver and the simulator alike.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from plant_models.errors import PlantError, require, require_between
from plant_models.frozen_arrays import Floats, frozen_arrays
from plant_models.pressure_regulator import connected, converted_kpa, flowed_kpa, flowing_time_s, mismatch_kpa, relay
from plant_models.valve_drive import ValveDrive, wait_after_command

MAX_SWITCHINGS = 40
"""After so many valve openings within one command the regulator is said to hunt."""


@dataclass(frozen=True)
class Pneumatics:
    """The drive of a retarder, with the symbols of [zhukovitsky-2012] in brackets.

    Parameters
    ----------
    supply_pressure_kpa
        [P_max], kPa gauge.
    exhaust_pressure_kpa
        [P_min], kPa gauge.
    brake_delay_s
        [tZ2], delay of the supply valve, s.
    touch_delay_s
        [t00], extra dead time while the pads do not touch (P ≤ P0), s.
    release_delay_s
        [tZ0], delay of the exhaust valve, s.
    fill_time_constant_s
        Time constant while connected to the supply, s.
    exhaust_time_constant_s
        Time constant while connected to the exhaust, s.
    dead_band_kpa
        [ε], half dead band of the regulator of the pressure, kPa.
    closing_delay_s
        For so long a valve stays open after the pressure has reached the band, s.
    day_spread
        Standard deviation of the logarithm of all delays and time constants from day to day, by cold, long pipes, wear.

    Raises
    ------
    PlantError
        A number out of range.

    Examples
    --------
    >>> from plant_models import Pneumatics
    >>> drive = Pneumatics(
    ...     supply_pressure_kpa=700.0,
    ...     exhaust_pressure_kpa=0.0,
    ...     brake_delay_s=0.1,
    ...     touch_delay_s=0.2,
    ...     release_delay_s=0.1,
    ...     fill_time_constant_s=0.3,
    ...     exhaust_time_constant_s=0.3,
    ...     dead_band_kpa=15.0,
    ... )
    >>> history = drive.respond(start_kpa=0.0, target_kpa=300.0, touch_kpa=50.0)
    >>> round(history.duration_s, 3), history.end_kpa
    (0.457, 285.0)
    """

    supply_pressure_kpa: float
    exhaust_pressure_kpa: float
    brake_delay_s: float
    touch_delay_s: float
    release_delay_s: float
    fill_time_constant_s: float
    exhaust_time_constant_s: float
    dead_band_kpa: float
    closing_delay_s: float = 0.0
    day_spread: float = 0.0

    def __post_init__(self) -> None:
        require_between("pneumatics: supply_pressure_kpa", self.supply_pressure_kpa, 1.0, 2000.0)
        require_between(
            "pneumatics: exhaust_pressure_kpa", self.exhaust_pressure_kpa, 0.0, self.supply_pressure_kpa - 1.0
        )
        for name in ("brake_delay_s", "touch_delay_s", "release_delay_s", "closing_delay_s"):
            require_between(f"pneumatics: {name}", getattr(self, name), 0.0, 5.0)
        for name in ("fill_time_constant_s", "exhaust_time_constant_s"):
            require_between(f"pneumatics: {name}", getattr(self, name), 1e-3, 10.0)
        require_between("pneumatics: dead_band_kpa", self.dead_band_kpa, 0.1, 200.0)
        require_between("pneumatics: day_spread", self.day_spread, 0.0, 1.0)

    def on_day(self, z: float) -> Pneumatics:
        """The drive of a day that is `z` standard deviations slower than usual; on that day nothing is uncertain."""
        factor = math.exp(self.day_spread * z)
        return replace(
            self,
            brake_delay_s=factor * self.brake_delay_s,
            touch_delay_s=factor * self.touch_delay_s,
            release_delay_s=factor * self.release_delay_s,
            fill_time_constant_s=factor * self.fill_time_constant_s,
            exhaust_time_constant_s=factor * self.exhaust_time_constant_s,
            closing_delay_s=factor * self.closing_delay_s,
            day_spread=0.0,
        )

    def require_reachable(self, stage_pressures_kpa: tuple[float, ...]) -> None:
        """Raise unless every stage pressure can be reached and the dead bands do not overlap."""
        band = self.dead_band_kpa
        require(
            stage_pressures_kpa[-1] - band < self.supply_pressure_kpa,
            f"retarder: stage_pressures_kpa ends at {stage_pressures_kpa[-1]:g}; the supply of "
            f"{self.supply_pressure_kpa:g} kPa cannot reach it: raise supply_pressure_kpa or lower the stage",
        )
        require(
            stage_pressures_kpa[0] + band > self.exhaust_pressure_kpa,
            f"retarder: stage_pressures_kpa starts at {stage_pressures_kpa[0]:g}, which exhausting to "
            f"{self.exhaust_pressure_kpa:g} kPa cannot reach",
        )
        for low, high in pairwise(stage_pressures_kpa):
            require(
                high - low > 2 * band,
                f"pneumatics: dead_band_kpa is {band:g}; the bands of the stages at {low:g} and {high:g} kPa overlap: "
                "make it less than half their distance",
            )

    def valves(self, touch_kpa: float) -> ValveDrive:
        """The constants as plain numbers, with the pressure at which the pads touch."""
        return ValveDrive(
            self.supply_pressure_kpa, self.exhaust_pressure_kpa,
            self.brake_delay_s, self.touch_delay_s, self.release_delay_s,
            self.fill_time_constant_s, self.exhaust_time_constant_s, self.dead_band_kpa, touch_kpa,
        )  # fmt: skip

    def valves_shutting_at_once(self, touch_kpa: float) -> ValveDrive:
        """The same for commands during a transient; raises `PlantError` for a closing delay, not modelled there."""
        require(
            self.closing_delay_s == 0.0,
            f"pneumatics: closing_delay_s is {self.closing_delay_s:g}; commands during a transient are modelled for "
            "valves that close at once: set it to 0",
        )
        return self.valves(touch_kpa)

    def respond(self, start_kpa: float, target_kpa: float, touch_kpa: float) -> PressureHistory:
        """Pressure after a command that is given at t = 0, while the pressure rests.

        Parameters
        ----------
        start_kpa
            The pressure before, kPa gauge.
        target_kpa
            The pressure that is commanded, kPa gauge.
        touch_kpa
            The pressure at which the pads touch the wheels, kPa gauge.

        Returns
        -------
        PressureHistory
            P(t), in closed form.

        Raises
        ------
        PlantError
            The regulator hunts: the closing delay is too long for the dead band.
        """
        pieces: list[tuple[float, float, float, float]] = []
        time, pressure, drive = 0.0, start_kpa, self.valves(touch_kpa)
        for _ in range(MAX_SWITCHINGS):
            sign = relay(mismatch_kpa(target_kpa, converted_kpa(pressure)), drive.band_kpa)
            pieces.append((time, pressure, *connected(0, pressure, drive)))
            if sign == 0:
                return PressureHistory(*(np.array(column) for column in zip(*pieces, strict=True)))
            delay = wait_after_command(pressure, 0.0, pressure, target_kpa, drive)
            link, edge = connected(sign, pressure, drive), target_kpa - sign * drive.band_kpa
            pieces.append((time + delay, pressure, *link))
            open_s = flowing_time_s(pressure, link, edge) + self.closing_delay_s
            time += delay + open_s
            # Exact where the valve shuts at once, so that equal commands end at equal pressures.
            pressure = edge if self.closing_delay_s == 0.0 else flowed_kpa(pressure, link, open_s)
        raise PlantError(
            f"pneumatics: closing_delay_s is {self.closing_delay_s:g}; with a dead band of ±{self.dead_band_kpa:g} kPa "
            f"the stage regulator hunts around {target_kpa:g} kPa: shorten the delay or widen the band"
        )


@frozen_arrays
class PressureHistory:
    """Pressure after one command, as n pieces P∞ + (P_start − P∞)·exp(−(t − t_start)/T).

    The last piece is constant and lasts for ever.

    Parameters
    ----------
    starts_s
        Beginning of each piece, s after the command, (n,).
    pressures_kpa
        Pressure there, kPa gauge, (n,).
    asymptotes_kpa
        P∞ of each piece, kPa gauge, (n,).
    time_constants_s
        T of each piece, s, (n,).

    Examples
    --------
    >>> import numpy as np
    >>> from plant_models.library import load_position
    >>> drive = load_position("knp-5-bunch").position.pneumatics
    >>> history = drive.respond(start_kpa=0.0, target_kpa=300.0, touch_kpa=50.0)
    >>> history.pressure_kpa(np.array([0.0, 10.0]))
    array([  0., 285.])
    """

    starts_s: Floats
    pressures_kpa: Floats
    asymptotes_kpa: Floats
    time_constants_s: Floats

    @property
    def duration_s(self) -> float:
        """Time from the command until the pressure rests, D."""
        return float(self.starts_s[-1])

    @property
    def end_kpa(self) -> float:
        """Pressure that is held in the end."""
        return float(self.pressures_kpa[-1])

    def pressure_kpa(self, t_s: Floats) -> Floats:
        """Pressure at some times.

        Parameters
        ----------
        t_s
            Times since the command, s, 0 or more, of any shape.

        Returns
        -------
        ndarray
            kPa gauge, of that shape.
        """
        piece = np.clip(np.searchsorted(self.starts_s, t_s, side="right") - 1, 0, None)
        decay = np.exp(-(t_s - self.starts_s[piece]) / self.time_constants_s[piece])
        asymptote = self.asymptotes_kpa[piece]
        return asymptote + (self.pressures_kpa[piece] - asymptote) * decay

    def overpressure_integral(self, t_s: Floats, touch_kpa: float) -> Floats:
        """∫₀ᵗ max(0, P − touch) dt, in closed form piece by piece.

        Parameters
        ----------
        t_s
            Times since the command, s, 0 or more, (n,).
        touch_kpa
            The pressure at which the pads touch the wheels, kPa gauge.

        Returns
        -------
        ndarray
            kPa·s, (n,).
        """
        total = np.zeros_like(t_s)
        ends = np.append(self.starts_s[1:], np.inf)
        for start, end, pressure, asymptote, constant in zip(
            self.starts_s, ends, self.pressures_kpa, self.asymptotes_kpa, self.time_constants_s, strict=True
        ):
            x = np.clip(np.minimum(t_s, end) - start, 0.0, None)
            total += exponential_overpressure(x, pressure - touch_kpa, asymptote - touch_kpa, constant)
        return total


def exponential_overpressure(x_s: Floats, start_kpa: float, asymptote_kpa: float, constant_s: float) -> Floats:
    """∫₀ˣ max(0, a + (b − a)·e^(−t/T)) dt for b = `start_kpa`, a = `asymptote_kpa`, T = `constant_s`."""

    def free(x: Floats) -> Floats:
        return asymptote_kpa * x - (start_kpa - asymptote_kpa) * constant_s * np.expm1(-x / constant_s)

    if start_kpa >= 0 and asymptote_kpa >= 0:
        return free(x_s)
    if start_kpa <= 0 and asymptote_kpa <= 0:
        return np.zeros_like(x_s)
    crossing = np.array(constant_s * np.log((asymptote_kpa - start_kpa) / asymptote_kpa))
    if start_kpa > 0:
        return free(np.minimum(x_s, crossing))
    return free(np.maximum(x_s, crossing)) - free(crossing)
