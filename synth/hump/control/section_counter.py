"""The axle counters at the ends of one section, loaded from records and counted down ([hump-computer-1970s])."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

from synth.hump.control.events import Kind
from synth.hump.control.models import PracticeRules


class Finding(NamedTuple):
    """What a counter tells: kind, cut, value of the event."""

    kind: Kind
    cut: int
    value: float


class Axle(NamedTuple):
    """An axle that came in: its cut, the widest gap between axles of it, how many were still to come, when it came, and
    how long after the axle ahead of the same cut (infinite for the first)."""

    cut: int
    base_m: float
    still: int
    in_s: float
    after_s: float


@dataclass
class Load:
    """A record that was handed to the section: its axles, the widest gap between two, how many came and left, and how
    long after the axle ahead its first one came."""

    cut: int
    axles: int
    base_m: float
    came: int = 0
    left: int = 0
    first_after_s: float = float("inf")

    @property
    def begun(self) -> bool:
        """Whether an axle of it was counted."""
        return self.came > 0 or self.left > 0


class SectionCounter:
    """Counts the axles of the records that it was told to expect, in this order.

    Axles are counted off the records one after the other, so a gap at the wrong place shifts no record: which axle
    belongs to which cut follows from the order of the train alone. `exits` is False for a track that cuts do not leave.
    """

    def __init__(self, length_m: float, exits: bool, rules: PracticeRules, judges_gaps: bool) -> None:
        self._length_m, self._exits, self._rules, self._judges_gaps = length_m, exits, rules, judges_gaps
        self._loads: deque[Load] = deque()
        self._within: deque[Axle] = deque()
        self._before: tuple[Axle, float] | None = None
        self._latest_s = self._came_s = float("-inf")
        self._told: set[tuple[Kind, int]] = set()

    def expect(self, cut: int, axles: int, base_m: float) -> None:
        """The next record; `base_m`: no two axles of it are further apart."""
        self._loads.append(Load(cut, axles, base_m))

    def shorten(self, cut: int, axles: int) -> Iterator[Finding]:
        """Expect only so many axles of `cut`: the rest went another way."""
        for load in self._loads:
            if load.cut == cut:
                load.axles = max(min(load.axles, axles), load.came)
        self._drop_complete()
        yield from self._registers(cut)

    def _drop_complete(self) -> None:
        while self._loads and self._loads[0].axles == (self._loads[0].left if self._exits else self._loads[0].came):
            self._loads.popleft()

    def _registers(self, cut: int) -> Iterator[Finding]:
        yield Finding(Kind.ENTRY_COUNTER, cut, self.entry)
        if self._exits:
            yield Finding(Kind.EXIT_COUNTER, cut, self.exit)

    @property
    def is_clear(self) -> bool:
        """Whether no cut is known to be on the section, or to be passing it in parts."""
        return not self._loads or not self._loads[0].begun

    @property
    def entry(self) -> int:
        """Axles of the record at the entry joint that are still to come; 0 where none has begun to come."""
        entering = next((load for load in self._loads if load.came < load.axles), None)
        return entering.axles - entering.came if entering is not None and entering.begun else 0

    @property
    def exit(self) -> int:
        """Axles of all records that have begun to come and are still to leave."""
        return sum(load.axles - load.left for load in self._begun()) if self._exits else 0

    @property
    def waits_for(self) -> tuple[int, ...]:
        """Cuts of which an axle was counted and others are still to come or to leave."""
        return tuple(load.cut for load in self._begun())

    def counted_all(self, cut: int) -> bool:
        """Whether all axles of `cut` came, or it is gone."""
        return all(load.came == load.axles for load in self._loads if load.cut == cut)

    def axle_in(self, time_s: float) -> Iterator[Finding]:
        """An axle at the entry joint."""
        before_s, self._came_s, self._latest_s = self._came_s, time_s, time_s
        load = next((load for load in self._loads if load.came < load.axles), None)
        if load is None:
            yield Finding(Kind.COUNTER_FAULT, 0, 1.0)
            return
        leader = self._loads[0]
        if load.came == 0 and leader is not load and self._exits:
            yield Finding(Kind.CATCH_UP, load.cut, leader.cut)
        if load.came == 0:
            load.first_after_s = time_s - before_s
        load.came += 1
        after_s = time_s - before_s if load.came > 1 else float("inf")
        self._within.append(Axle(load.cut, load.base_m, load.axles - load.came, time_s, after_s))
        if not self._exits:
            self._drop_complete()
        yield Finding(Kind.ENTRY_COUNTER, load.cut, load.axles - load.came)
        if load.came == 1 and self._exits:
            yield Finding(Kind.EXIT_COUNTER, load.cut, self.exit)

    def axle_out(self, time_s: float) -> Iterator[Finding]:
        """An axle at an exit joint."""
        self._latest_s = time_s
        load = self._loads[0] if self._loads else None
        if load is None or not load.begun:
            yield Finding(Kind.COUNTER_FAULT, load.cut if load else 0, -1.0)
            return
        load.left += 1
        missed = load.came - load.left if load.left == load.axles else 0
        self._drop_complete()
        yield Finding(Kind.EXIT_COUNTER, load.cut, self.exit)
        if missed < 0:
            yield from self._once(Kind.COUNTER_FAULT, load.cut, missed)
            yield Finding(Kind.ENTRY_COUNTER, load.cut, self.entry)
        if self._judges_gaps and self._within:
            yield from self._gap(self._within.popleft(), time_s)

    def _gap(self, axle: Axle, out_s: float) -> Iterator[Finding]:
        """Judge the gap ahead of an axle that left at `out_s`, by the times that both axles took for the section."""
        before, self._before = self._before, (axle, out_s)
        if before is None or before[1] <= before[0].in_s or out_s <= axle.in_s:
            return
        ahead, ahead_out_s = before
        if max(ahead_out_s - ahead.in_s, out_s - axle.in_s) > self._length_m / self._rules.crawl_m_s:
            return  # one of them stood on the section, or nearly; so its time tells no speed in the gap
        apart_s, speed_m_s = axle.in_s - ahead.in_s, self._length_m / (ahead_out_s - ahead.in_s)
        if axle.in_s > ahead_out_s:
            # The speed of the one ahead is from the begin of the gap, that of this one from its end.
            speed_m_s = 0.5 * (speed_m_s + self._length_m / (out_s - axle.in_s))
        gap_m = speed_m_s * apart_s
        if ahead.cut == axle.cut and gap_m > ahead.base_m:
            yield from self._once(Kind.TOO_FEW_AXLES, axle.cut, ahead.still)
        # The last two axles ahead are those of a bogie: by its measure at the joint, no later braking deceives. Half of
        # it is left for speeds that change in the gap itself.
        near_by_bogie = 0.5 * self._rules.bogie_m * apart_s < self._rules.coupled_gap_m * ahead.after_s
        if ahead.cut != axle.cut and gap_m < self._rules.coupled_gap_m and near_by_bogie:
            yield from self._once(Kind.TOO_MANY_AXLES, ahead.cut, axle.cut)

    def check(self, now_s: float, free_since_s: float, passed: Callable[[int], bool]) -> Iterator[Finding]:
        """Judge the counters of a section that is free; `passed`: whether the next sections counted all axles of a cut.

        Only quiet counts: time in which the section was free and no axle passed, since a section may be told free
        while a cut rolls over it.
        """
        quiet_s = now_s - max(free_since_s, self._latest_s)
        begun = list(self._begun())
        came, left = sum(load.came for load in begun), sum(load.left for load in begun)
        if not begun:
            return
        if came == left:
            if quiet_s > self._rules.patience_s:
                yield from self._once(Kind.TOO_FEW_AXLES, begun[0].cut, begun[0].axles - came)
            return
        if quiet_s < self._rules.lone_axle_s:
            return
        yield from self._once(Kind.COUNTER_FAULT, begun[0].cut, came - left)
        if passed(begun[0].cut):
            self._loads.popleft()
            yield from self._put_right(begun[0].cut)
        elif (
            came == 1
            and left == 0
            and quiet_s > self._rules.patience_s
            and begun[0].first_after_s <= self._rules.bogie_s
        ):
            begun[0].came = 0  # it is of the cut ahead, one of whose axles was counted twice; another may stand there
            yield from self._put_right(begun[0].cut)

    def _put_right(self, cut: int) -> Iterator[Finding]:
        self._within.clear()
        self._before = None
        yield from self._registers(cut)

    def _begun(self) -> Iterator[Load]:
        for load in self._loads:
            if not load.begun:
                return
            yield load

    def _once(self, kind: Kind, cut: int, value: float) -> Iterator[Finding]:
        if (kind, cut) not in self._told:
            self._told.add((kind, cut))
            yield Finding(kind, cut, value)
