"""The pneumatic drive as a relay: compare, wait for the valve, fill or exhaust until the dead band, rest.

A command may be given whatever the drive is doing. Until the regulator of the pressure hears of it, the drive goes on
as before. Then it compares anew. Who needs the valve that is open, or about to open, keeps it, and the flow only ends
elsewhere; the delay of a valve counts from the command that first asked for it. Who needs the other valve, or none, has
the present one shut at once, and pays the whole delay of the other one.
"""

from __future__ import annotations

import math
from enum import Enum, auto
from typing import Final

from synth.checker.plant import Drive

MOST_OPENINGS: Final = 40
"""A regulator whose valves open more often within one command hunts; it is then taken to rest."""
INSTANT_S: Final = 1e-9


class Phase(Enum):
    """What the valves are doing."""

    RESTING = auto()
    OPENING = auto()
    FLOWING = auto()
    CLOSING = auto()
    """The band is reached, the valve still open."""


class BrakeDrive:
    """The pressure of one pass as it moves on in time."""

    def __init__(self, drive: Drive, pressure_kpa: float) -> None:
        self.drive = drive
        self.pressure_kpa = pressure_kpa
        self._phase = Phase.RESTING
        self._goal_kpa = pressure_kpa
        self._wait_s = 0.0
        self._filling = False
        self._openings = 0
        self._heard_kpa: float | None = None  # a goal that is on its way
        self._heard_in_s = 0.0

    @property
    def resting(self) -> bool:
        """Whether no command is being carried out."""
        return self._phase is Phase.RESTING and self._heard_kpa is None

    @property
    def overpressure_kpa(self) -> float:
        """max(0, P − P0) now."""
        return max(0.0, self.pressure_kpa - self.drive.touch_kpa)

    def command(self, goal_kpa: float, after_s: float) -> None:
        """Go to `goal_kpa`; the regulator of the pressure hears of it after `after_s`, before the next command."""
        self._heard_kpa, self._heard_in_s = goal_kpa, after_s

    def overpressure(self, duration_s: float) -> float:
        """Move on by `duration_s`; mean of max(0, P − P0) over it, by trapezoids between the events."""
        left, area = duration_s, 0.0
        while left > INSTANT_S and not self.resting:
            before = self.overpressure_kpa
            used = self._move(left if self._heard_kpa is None else min(left, self._heard_in_s))
            area += 0.5 * (before + self.overpressure_kpa) * used
            left -= used
            if self._heard_kpa is not None:
                self._heard_in_s -= used
                if self._heard_in_s <= INSTANT_S:
                    self._obey(self._heard_kpa)
        return (area + self.overpressure_kpa * left) / duration_s if duration_s > 0.0 else self.overpressure_kpa

    def _move(self, longest_s: float) -> float:
        """Go on for at most `longest_s`, until the valves do something else; the time used."""
        if self._phase is Phase.RESTING:
            return longest_s
        return self._flow(longest_s) if self._phase is Phase.FLOWING else self._wait(longest_s)

    def _obey(self, goal_kpa: float) -> None:
        """The regulator of the pressure hears of a new goal."""
        self._heard_kpa, self._goal_kpa, self._openings = None, goal_kpa, 0
        if self._phase in (Phase.OPENING, Phase.FLOWING) and self._needed() == self._filling:
            return
        self._compare()

    def _needed(self) -> bool | None:
        """Whether the goal asks to fill or to exhaust; None: neither."""
        error = self._goal_kpa - self.pressure_kpa
        return None if abs(error) <= self.drive.band_kpa * (1.0 + 1e-12) else error > 0.0

    def _wait(self, longest_s: float) -> float:
        """Wait for at most `longest_s`; the time used."""
        used = min(self._wait_s, longest_s)
        self._wait_s -= used
        if self._phase is Phase.CLOSING:
            self._exchange(used)
        if self._wait_s <= INSTANT_S:
            if self._phase is Phase.OPENING:
                self._phase = Phase.FLOWING
            else:
                self._compare()
        return used

    def _flow(self, longest_s: float) -> float:
        """Fill or exhaust for at most `longest_s`, not beyond the edge of the band; the time used."""
        asymptote, constant = self._air()
        edge = self._goal_kpa + (-self.drive.band_kpa if self._filling else self.drive.band_kpa)
        needed = math.inf  # where the air cannot bring the pressure into the band
        if (asymptote - self.pressure_kpa) * (asymptote - edge) > 0.0:
            needed = constant * math.log((asymptote - self.pressure_kpa) / (asymptote - edge))
        if needed > longest_s:
            self._exchange(longest_s)
            return longest_s
        self.pressure_kpa = edge
        self._phase, self._wait_s = Phase.CLOSING, self.drive.closing_delay_s
        if self._wait_s <= INSTANT_S:
            self._compare()
        return max(0.0, needed)

    def _exchange(self, duration_s: float) -> None:
        """Let air through the open valve."""
        asymptote, constant = self._air()
        self.pressure_kpa = asymptote + (self.pressure_kpa - asymptote) * math.exp(-duration_s / constant)

    def _air(self) -> tuple[float, float]:
        """Pressure behind the open valve, and time constant."""
        d = self.drive
        return (d.supply_kpa, d.fill_s) if self._filling else (d.exhaust_kpa, d.exhaust_s)

    def _compare(self) -> None:
        """The regulator looks at the pressure: rest, or have a valve open."""
        d, needed = self.drive, self._needed()
        if needed is None or self._openings == MOST_OPENINGS:
            self._phase = Phase.RESTING
            return
        self._openings += 1
        self._phase, self._filling = Phase.OPENING, needed
        touching = self.pressure_kpa <= d.touch_kpa
        self._wait_s = d.brake_delay_s + (d.touch_delay_s if touching else 0.0) if needed else d.release_delay_s
