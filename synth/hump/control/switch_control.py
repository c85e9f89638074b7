"""Which way points are to lie, and when they are thrown: as in [kozachenko-control], [hump-computer-1970s]."""

from __future__ import annotations

from synth.hump.control.axle_counters import AxleCounters
from synth.hump.control.event import Block, Kind
from synth.hump.control.hump_state import MOVING
from synth.hump.control.journal import Journal
from synth.hump.control.models import TrackGeometry
from synth.hump.control.practice_rules import PracticeRules
from synth.hump.control.route_store import RouteStore


class SwitchControl:
    """Sets every switch for the next cut whose route has it, as soon as it may be thrown."""

    def __init__(
        self, store: RouteStore, counters: AxleCounters, track: TrackGeometry, rules: PracticeRules, journal: Journal
    ) -> None:
        self._store, self._counters, self._track, self._rules, self._journal = store, counters, track, rules, journal
        self._passed: dict[int, int] = {}
        self._wanted: dict[int, tuple[int, int]] = {}
        self._told: set[tuple[int, int]] = set()

    def passes(self, switch: int, cut: int) -> None:
        """`cut` is on the switch: it and those before it are no longer awaited there."""
        self._passed[switch] = max(self._passed.get(switch, -1), self._store.place[cut])

    def aim(self, switch: int) -> None:
        """Look for the next cut over `switch`, and remember the position that it needs."""
        behind = self._passed.get(switch, -1)
        counted = self._counters.latest.get(switch)
        if self._rules.counters and counted is not None:
            behind = max(behind, self._store.place[counted])
        cut = self._store.next_over(switch, behind)
        self._wanted.pop(switch, None)
        if cut is not None:
            position, lies = self._store.position(switch, cut), self._journal.state.position(switch)
            if lies == MOVING:
                lies = self._journal.state.commanded.get(switch, MOVING)
            if lies != position:
                self._wanted[switch] = position, cut

    def throw_waiting(self) -> None:
        """Throw the points that may be thrown."""
        for switch, (position, cut) in tuple(self._wanted.items()):
            block = self.block(switch)
            if block is None:
                del self._wanted[switch]
                self._command(switch, position, cut)
            elif (switch, cut) not in self._told:
                self._told.add((switch, cut))
                self._journal.tell(Kind.BLOCKED, switch, cut, block)

    def block(self, switch: int) -> Block | None:
        """Why the points may not be thrown now; None where they may."""
        if not self._journal.state.is_automatic(switch):
            return Block.BY_HAND
        return self.danger(switch)

    def danger(self, switch: int) -> Block | None:
        """What is in the way of a throw, by hand too."""
        if self._journal.state.occupant(switch):
            return Block.OCCUPIED
        if self._rules.counters and not self._counters.is_clear(switch):
            return Block.COUNTERS
        if self._rules.fouling_m_s is not None and self._track.is_fouled(switch, self._rules.fouling_m_s):
            return Block.FOULED
        return None

    def set_automatic(self, switch: int, automatic: bool) -> None:
        """Take the switch over by hand, or give it back."""
        self._journal.tell(Kind.MODE, switch, value=float(automatic))
        if automatic:
            self.aim(switch)

    def throw_by_hand(self, switch: int, position: int) -> bool:
        """Throw points that are controlled by hand; False where something is in the way."""
        if self._journal.state.is_automatic(switch) or self.danger(switch) is not None:
            return False
        self._command(switch, position, 0)
        return True

    def _command(self, switch: int, position: int, cut: int) -> None:
        self._journal.tell(Kind.COMMANDED, switch, cut, position)
        self._track.throw(switch, position)
