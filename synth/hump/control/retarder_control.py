"""What retarders do with the cuts on them: the brake module of the published model."""

from __future__ import annotations

from collections.abc import Mapping

from plant_models.hump.retarder import Retarder
from synth.hump.control.brake_task import BrakeTask, LeastInterval
from synth.hump.control.event import Kind
from synth.hump.control.journal import Journal
from synth.hump.control.models import Braking, ExitSpeed, TrackGeometry
from synth.hump.control.route_store import RouteStore
from synth.hump.control.route_table import RouteTable
from synth.hump.control.strobe import Strobe

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
