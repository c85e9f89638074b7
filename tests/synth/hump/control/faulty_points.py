"""The points of a reference track with the faults of their machines."""

from __future__ import annotations

from collections.abc import Sequence

from plant_models.hump.switch import Switch
from synth.hump.control.track_points import TrackPoints
from tests.synth.hump.control.reference_faults import Fault, LateSwitch, StuckSwitch


class FaultyPoints(TrackPoints):
    """Points of which some come late, or do not move at all."""

    def __init__(self, switches: Sequence[Switch], faults: Sequence[Fault]) -> None:
        super().__init__(switches)
        self._stuck = [fault for fault in faults if isinstance(fault, StuckSwitch)]
        for fault in faults:
            if isinstance(fault, LateSwitch):
                self.throws_s[fault.switch] += fault.extra_s

    def throw(self, switch: int, position: int, now_s: float) -> bool:
        """Nothing where they are stuck."""
        if any(each.switch == switch and each.from_s <= now_s <= each.to_s for each in self._stuck):
            return False
        return super().throw(switch, position, now_s)

    def is_moving(self, switch: int, time_s: float) -> bool:
        """Whether they are on their way."""
        return switch in self._moving and not self._has_moved(switch, time_s)
