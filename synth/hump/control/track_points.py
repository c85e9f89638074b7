"""The points of a track: where they lie, and how they move."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from plant_models.hump.switch import Switch
from synth.hump.control.hump_state import MOVING


class TrackPoints:
    """All points lie left at first; a throw takes the time of its relay and its machine."""

    def __init__(self, switches: Sequence[Switch]) -> None:
        self.throws_s = {switch.number: switch.relay_s + switch.throw_s for switch in switches}
        self._lies = dict.fromkeys(self.throws_s, 0)
        self._moving: dict[int, tuple[float, int]] = {}
        self._news: list[tuple[int, int]] = list(self._lies.items())

    def throw(self, switch: int, position: int, now_s: float) -> bool:
        """Command points; whether they begin to move."""
        self._settle(switch, now_s)
        if switch not in self._moving and self._lies[switch] == position:
            return False
        self._moving[switch] = now_s + self.throws_s[switch], position
        self._news.append((switch, MOVING))
        return True

    def lay(self, switch: int, position: int) -> None:
        """Points lie so at once, wherever they were."""
        if self._moving.pop(switch, None) is not None or self._lies[switch] != position:
            self._lies[switch] = position
            self._news.append((switch, position))

    def lies(self, switch: int, time_s: float) -> int:
        """Position at `time_s`; points on their way count as where they were."""
        return self._moving[switch][1] if self._has_moved(switch, time_s) else self._lies[switch]

    def news(self, now_s: float) -> Iterator[tuple[int, int]]:
        """Detected positions that changed since the last call."""
        for switch in tuple(self._moving):
            self._settle(switch, now_s)
        news, self._news = self._news, []
        yield from news

    def _has_moved(self, switch: int, time_s: float) -> bool:
        return switch in self._moving and self._moving[switch][0] <= time_s

    def _settle(self, switch: int, now_s: float) -> None:
        if self._has_moved(switch, now_s):
            self._lies[switch] = self._moving.pop(switch)[1]
            self._news.append((switch, self._lies[switch]))
