"""The control of a hump of a train, one tick after the other ([kozachenko-control], [hump-computer-1970s])."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from plant_models.errors import require
from synth.hump.control.axle_counters import AxleCounters
from synth.hump.control.brake_task import BrakeTask, LeastInterval, Strobe
from synth.hump.control.cut_record import SortingList
from synth.hump.control.cut_routes import Misrouting, RouteStore, RouteTable
from synth.hump.control.element_control import RetarderControl, SwitchControl
from synth.hump.control.events import MOVING, Aspect, Event, HumpState, Journal, Kind, Why
from synth.hump.control.models import PracticeRules, Technology, TrackGeometry, leader_track
from synth.hump.control.section_counter import Finding


@dataclass(frozen=True)
class Operation:
    """How a hump is operated: what is done with misrouted cuts, rules of practice, tasks of the retarders by
    (retarder, cut), the limits of exit speeds, and the braking of a cut that came too close."""

    technology: Technology = leader_track
    rules: PracticeRules = field(default_factory=PracticeRules)
    tasks: Mapping[tuple[int, int], BrakeTask] = field(default_factory=dict)
    strobe: Strobe = field(default_factory=Strobe)
    least_interval: LeastInterval = field(default_factory=LeastInterval)


class HumpControl:
    """Controls switches, retarders and signals for one train; `tick` it until the train is humped, then `finish`.

    Cuts that the list marks as not to be humped are left out. `PlantError` for a cut that no route leads home, and for
    rules that need counters where a switch has none.
    """

    def __init__(
        self, table: RouteTable, train: SortingList, track: TrackGeometry, operation: Operation | None = None
    ) -> None:
        how, bare = operation or Operation(), table.uncounted_switch
        require(
            bare is None or not how.rules.counters,
            f"switch {bare} has no axle counters; give it some, or follow no rule of practice that needs them",
        )
        self._table, self._track, self._how, self._journal = table, track, how, Journal()
        self.store = RouteStore(table, train.humped)
        self.counters = AxleCounters(table, self.store, how.rules, self._counted)
        self.switches = SwitchControl(self.store, self.counters, track, how.rules, self._journal)
        self.retarders = RetarderControl(table, self.store, track, how.tasks, how.strobe, self._journal)
        self._misrouting = Misrouting(self.store, how.technology, self._journal)
        self._counts = bare is None
        self._awaits_points: dict[int, int] = {}
        self._seen: dict[int, int] = {}
        self._last = {cut.lead: cut.serial for cut in self.store.cuts}
        for cut in self.store.cuts:
            self._journal.tell(Kind.STORED, table.graph.leads[cut.lead], cut.serial, cut.track)
        for lead in sorted(self._last):
            self._show(lead, Aspect.HUMP)
        for switch in table.needed:
            self.switches.aim(switch)

    @property
    def state(self) -> HumpState:
        """The states of all elements."""
        return self._journal.state

    @property
    def events(self) -> tuple[Event, ...]:
        """What happened so far."""
        return self._journal.events

    def tick(self, time_s: float) -> None:
        """Read the track at `time_s`, and command what follows."""
        self._journal.now_s = time_s
        self._track.advance(time_s)
        if self._counts:
            for axle in self._track.axles():
                self.counters.count(axle)
        for switch, position in self._track.positions():
            self._points(switch, position)
        for element, objects in self._track.occupations():
            self._section(element, objects)
        self.counters.check(time_s)
        self.switches.throw_waiting()
        self.retarders.brake()

    def finish(self) -> None:
        """The train is humped: close the signals, record cuts that were not found, or not with all axles, or in part on
        the way of another cut, and counters that are not at zero."""
        for lead in sorted(self._last):
            self._show(lead, Aspect.STOP)
        unfinished, off_route = self.counters.unfinished(), self.counters.off_route()
        for cut in self.store.cuts:
            lead, waiting = self._table.graph.leads[cut.lead], unfinished.get(cut.serial)
            if cut.serial not in self.state.arrived:
                self._journal.tell(Kind.MISROUTED, self._seen.get(cut.serial, lead), cut.serial, Why.NOT_SEEN)
            elif waiting and cut.serial not in self.state.misrouted:
                ahead = min(waiting, key=lambda element: self._table.places[lead][element].from_m)
                self._journal.tell(Kind.MISROUTED, ahead, cut.serial, Why.NOT_SEEN)
            elif cut.serial in off_route and cut.serial not in self.state.misrouted:
                self._journal.tell(Kind.MISROUTED, off_route[cut.serial], cut.serial, Why.OFF_ROUTE)
        for element, axles in self.counters.left_over().items():
            self._journal.tell(Kind.COUNTERS_LEFT, element, value=axles)

    def _show(self, lead: int, aspect: Aspect) -> None:
        signal = self._table.graph.leads[lead]
        if self.state.aspects.get(signal) != aspect:
            self._journal.tell(Kind.SIGNAL, signal, value=aspect)
            self._track.show(signal, aspect)

    def _counted(self, time_s: float, element: int, finding: Finding) -> None:
        """A counter tells something."""
        self._journal.tell(finding.kind, element, finding.cut, finding.value, time_s)
        if finding.kind is Kind.TOO_MANY_AXLES:
            follower = int(finding.value)
            if self.store.track(finding.cut) != self.store.record(follower).track:
                self._journal.tell(Kind.MISROUTED, element, follower, Why.COUPLED)

    def _points(self, switch: int, position: int) -> None:
        """Points were detected in another position."""
        self._journal.tell(Kind.POSITION, switch, value=position)
        cut = self._awaits_points.get(switch)
        if cut is not None and position != MOVING:
            del self._awaits_points[switch]
            self._check_way(switch, cut)

    def _section(self, element: int, objects: tuple[int, ...]) -> None:
        """The objects on a section changed."""
        if element in self._table.retarders:
            self.retarders.occupied(element, objects)
        before, now = self.state.occupant(element), objects[-1] if objects else 0
        if now == before:
            return
        if not now:
            self._freed(element, before)
            return
        self.counters.occupied(element)
        if now not in self.store:
            self._journal.tell(Kind.UNKNOWN_OBJECT, element, now)
            return
        self._seen[now] = element
        apart = before == 0 or element in self._table.plain
        if apart:
            self._journal.tell(Kind.OCCUPIED, element, now)
        else:
            self._journal.tell(Kind.NOT_SEPARATED, element, now, before)
        self._arrive(element, now, 0 if apart else before)

    def _freed(self, element: int, cut: int) -> None:
        self._journal.tell(Kind.FREED, element, cut)
        self._awaits_points.pop(element, None)
        self.counters.freed(element, self._journal.now_s)
        if element in self._table.needed:
            self.switches.aim(element)

    def _arrive(self, element: int, cut: int, leader: int) -> None:
        """`cut` came on the section of `element`, which its `leader` has not left (0: it is alone)."""
        record = self.store.record(cut)
        if self._last.get(record.lead) == cut:
            self._show(record.lead, Aspect.STOP)
        if element in self._table.needed:
            self.switches.passes(element, cut)
            if leader:
                self._follow(element, cut, leader)
        self._check_way(element, cut)
        if element in self._table.home:
            self._journal.tell(Kind.ARRIVED, element, cut, self._table.home[element])

    def _follow(self, switch: int, cut: int, leader: int) -> None:
        """The switch stays; the follower gets the track that the technology says, and is braked."""
        self._send(cut, switch, Why.NOT_SEPARATED, leader)
        self.retarders.hold_back(cut, switch, self._how.least_interval)

    def _check_way(self, element: int, cut: int) -> None:
        """Whether the route of `cut` leads over `element`, and the points there lie for it."""
        track = self.store.track(cut)
        position = self.state.position(element) if element in self._table.needed else None
        if position == MOVING:
            self._awaits_points[element] = cut
        if track not in self._table.behind[element]:
            self._send(cut, element, Why.OFF_ROUTE)
        elif position not in (None, MOVING) and position != self._table.needed[element][track]:
            self._send(cut, element, Why.WRONG_POSITION)

    def _send(self, cut: int, element: int, why: Why, leader: int = 0) -> None:
        """Ask for another track, of those that the points at `element` let it reach."""
        reachable = self._table.behind[element]
        position = self.state.position(element)
        if element in self._table.needed and position != MOVING:
            reachable = frozenset(self._table.tracks_by(element, position))
        for switch in self._misrouting.send(cut, element, why, reachable, leader):
            self.switches.aim(switch)
