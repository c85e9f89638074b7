"""The points of a reference track: where they lie, and how they move."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence

from plant_models.hump.switch import Switch
from synth.hump.control.hump_state import MOVING
from synth.hump.control.reference_faults import Fault, LateSwitch, StuckSwitch


class ReferencePoints:
    """All points lie left at first; a throw takes the time of its relay and its machine."""

    def __init__(self, switches: Sequence[Switch], faults: Sequence[Fault]) -> None:
        self._throws_s = {switch.number: switch.relay_s + switch.throw_s for switch in switches}
        self._stuck: dict[int, list[StuckSwitch]] = defaultdict(list)
        for fault in faults:
            if isinstance(fault, StuckSwitch):
                self._stuck[fault.switch].append(fault)
            elif isinstance(fault, LateSwitch):
                self._throws_s[fault.switch] += fault.extra_s
        self._lies = dict.fromkeys(self._throws_s, 0)
        self._moving: dict[int, tuple[float, int]] = {}
        self._news: list[tuple[int, int]] = list(self._lies.items())

    def throw(self, switch: int, position: int, now_s: float) -> bool:
        """Command points; whether they begin to move."""
        if any(stuck.from_s <= now_s <= stuck.to_s for stuck in self._stuck[switch]):
            return False
        self._settle(switch, now_s)
        if switch not in self._moving and self._lies[switch] == position:
            return False
        self._moving[switch] = now_s + self._throws_s[switch], position
        self._news.append((switch, MOVING))
        return True

    def lay(self, switch: int, position: int) -> None:
        """Points lie so at once, wherever they were."""
        if self._moving.pop(switch, None) is not None or self._lies[switch] != position:
            self._lies[switch] = position
            self._news.append((switch, position))

    def lies(self, switch: int, time_s: float) -> int:
        """Position at `time_s`; points on their way count as where they were."""
        moving = self._moving.get(switch)
        return self._lies[switch] if moving is None or time_s < moving[0] else moving[1]

    def is_moving(self, switch: int, time_s: float) -> bool:
        """Whether they are on their way."""
        moving = self._moving.get(switch)
        return moving is not None and time_s < moving[0]

    def news(self, now_s: float) -> Iterator[tuple[int, int]]:
        """Detected positions that changed since the last call."""
        for switch in tuple(self._moving):
            self._settle(switch, now_s)
        news, self._news = self._news, []
        yield from news

    def _settle(self, switch: int, now_s: float) -> None:
        moving = self._moving.get(switch)
        if moving is not None and moving[0] <= now_s:
            del self._moving[switch]
            self._lies[switch] = moving[1]
            self._news.append((switch, moving[1]))
