"""Which way points are to lie, and when they are thrown ([kozachenko-control], [hump-computer-1970s]); and what
retarders do with the cuts on them, the brake module of the published model.
"""

from __future__ import annotations

from collections.abc import Mapping

from plant_models.hump.elements import Retarder
from synth.hump.control.axle_counters import AxleCounters
from synth.hump.control.brake_task import BrakeTask, LeastInterval, Strobe
from synth.hump.control.cut_routes import RouteStore, RouteTable
from synth.hump.control.events import MOVING, Block, Journal, Kind
from synth.hump.control.models import Braking, ExitSpeed, PracticeRules, TrackGeometry


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


Tasks = Mapping[tuple[int, int], BrakeTask]
"""The task of each (retarder, cut), set before the train is humped; a cut without one rolls through."""


class RetarderControl:
    """Asks, at every tick, for the braking of each occupied retarder; the first cut on it rules."""

    def __init__(
        self, table: RouteTable, store: RouteStore, track: TrackGeometry, tasks: Tasks, strobe: Strobe, journal: Journal
    ) -> None:
        self._table, self._store, self._track, self._journal = table, store, track, journal
        self._strobe = strobe
        self._tasks = dict(tasks)
        self._first: dict[int, int] = {}
        self._told: dict[int, Braking | None] = {}

    def task(self, retarder: int, cut: int) -> BrakeTask | None:
        """What the retarder is to do with the cut."""
        return self._tasks.get((retarder, cut))

    def set_task(self, retarder: int, cut: int, task: BrakeTask) -> None:
        """Another task, for a cut that is on its way."""
        self._tasks[retarder, cut] = task

    def occupied(self, retarder: int, objects: tuple[int, ...]) -> None:
        """These objects are on the retarder, the one ahead first."""
        if objects:
            self._first[retarder] = objects[0]
        else:
            self._first.pop(retarder, None)
            self._tell(retarder, 0, None)

    def brake(self) -> None:
        """Ask the task of the first cut on each occupied retarder."""
        for retarder, cut in self._first.items():
            task = self._tasks.get((retarder, cut))
            self._tell(retarder, cut, None if task is None else task.braking(self._track.place_m(cut)))

    def _tell(self, retarder: int, cut: int, braking: Braking | None) -> None:
        if self._told.get(retarder) == braking:
            return
        self._told[retarder] = braking
        possible = braking
        if isinstance(braking, ExitSpeed) and not self._strobe.holds(braking.m_s):
            self._journal.tell(Kind.STROBED, retarder, cut, braking.m_s)
            possible = ExitSpeed(self._strobe.bounded(braking.m_s))
        if possible is None:
            self._journal.tell(Kind.RELEASED, retarder, cut)
        else:
            self._journal.tell(Kind.BRAKED, retarder, cut, possible[0])
        self._track.brake(retarder, possible)

    def hold_back(self, cut: int, behind: int, law: LeastInterval) -> None:
        """Brake `cut`, which is on the element `behind`, for the least interval on the next retarder of its route."""
        record = self._store.record(cut)
        route = self._table.route(record.lead, self._store.track(cut))
        numbers = [element.number for element in route.elements]
        if behind not in numbers:
            return
        for element in route.elements[numbers.index(behind) + 1 :]:
            if isinstance(element.vertex, Retarder):
                zone_m = sum(end - begin for begin, end in element.vertex.zones_m)
                self.set_task(element.number, cut, law.task(self._track.speed_m_s(cut), zone_m))
                return
