"""All axle counters of a hump: records follow their cuts from section to section ([hump-computer-1970s])."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator

from synth.hump.control.cut_record import CutRecord, Mark
from synth.hump.control.cut_routes import RouteStore, RouteTable
from synth.hump.control.events import Kind
from synth.hump.control.models import ENTRY, AxlePass, PracticeRules
from synth.hump.control.section_counter import Finding, SectionCounter

Tell = Callable[[float, int, Finding], None]
"""Takes the time, the element and what was found."""


class AxleCounters:
    """The counters of all sections, told what the train is; findings go to `tell`.

    `latest`: by section, the last cut all of whose axles came in.
    """

    def __init__(self, table: RouteTable, store: RouteStore, rules: PracticeRules, tell: Tell) -> None:
        self._table, self._store, self._tell = table, store, tell
        first = {lead: table.next_counted(lead) for lead in table.graph.leads}
        self._sections = {
            number: SectionCounter(
                sum(table.vertex(number).section_m), number not in table.last, rules, number in first.values()
            )
            for number in sorted(table.counted)
        }
        self._rules = rules
        self._expected: dict[tuple[int, int], int] = {}
        self._handed: dict[tuple[int, int], int] = {}
        self._gone: dict[tuple[int, int], int] = defaultdict(int)
        self._off_route: dict[tuple[int, int], int] = defaultdict(int)
        self._free_since: dict[int, float] = {}
        self.latest: dict[int, int] = {}
        for cut in store.cuts:
            begin = first[table.graph.leads[cut.lead]]
            if begin is not None:
                self._expect(begin, cut, cut.axles)

    def is_clear(self, element: int) -> bool:
        """Whether the counters of the section know of no cut on it; True where there are none."""
        return element not in self._sections or self._sections[element].is_clear

    def count(self, axle: AxlePass) -> None:
        """One axle more."""
        section = self._sections[axle.element]
        found = section.axle_in(axle.time_s) if axle.end == ENTRY else section.axle_out(axle.time_s)
        for finding in found:
            if finding.kind is Kind.ENTRY_COUNTER and finding.value == 0.0:
                self.latest[axle.element] = finding.cut
            elif finding.kind is Kind.EXIT_COUNTER and axle.end != ENTRY:
                self._hand_over(finding.cut, axle)
            self._tell(axle.time_s, axle.element, finding)

    def _expect(self, element: int, cut: CutRecord, axles: int) -> None:
        """Announce so many axles of a cut to a section."""
        long_base = Mark.LONG_BASE in cut.marks
        base_m = self._rules.longest_base_m if long_base else self._rules.usual_base_m
        self._expected[element, cut.serial] = axles
        self._sections[element].expect(cut.serial, axles, base_m)

    def _hand_over(self, cut: int, axle: AxlePass) -> None:
        """Give the record to the section to which its first axle goes; where the rest of a split cut goes another way,
        give the rest to that, and let nobody behind the first way wait for it."""
        here, gone = (axle.element, cut), self._gone[axle.element, cut]
        self._gone[here] = gone + 1
        own = self._table.needed.get(axle.element, {}).get(self._store.record(cut).track, axle.end)
        if own != axle.end:
            self._off_route[here] += 1
        branch = self._handed.get(here)
        if branch == axle.end:
            return
        self._handed[here] = axle.end
        following = self._table.next_counted(axle.element, axle.end)
        if branch is not None:
            old = self._table.next_counted(axle.element, branch)
            for number in self._below(old):
                if (number, cut) in self._expected:
                    self._expected[number, cut] = gone
                    for finding in self._sections[number].shorten(cut, gone):
                        self._tell(axle.time_s, number, finding)
        if following is not None:
            self._expect(following, self._store.record(cut), self._expected[here] - gone)

    def _below(self, element: int | None) -> Iterator[int]:
        """The sections from `element` on."""
        if element is not None:
            yield element
            for number in self._following(element):
                yield from self._below(number)

    def occupied(self, element: int) -> None:
        """The section is occupied."""
        self._free_since.pop(element, None)

    def freed(self, element: int, time_s: float) -> None:
        """The section is free."""
        if not self.is_clear(element):
            self._free_since[element] = time_s

    def check(self, time_s: float) -> None:
        """Judge the sections that are free while their counters wait."""
        for element, since in tuple(self._free_since.items()):
            section, following = self._sections[element], self._following(element)

            def passed(cut: int, here: int = element, following: tuple[int, ...] = following) -> bool:
                went_on = (here, cut) in self._handed
                return went_on and all(self._sections[number].counted_all(cut) for number in following)

            for finding in section.check(time_s, since, passed):
                self._tell(time_s, element, finding)
            if section.is_clear:
                del self._free_since[element]

    def left_over(self) -> dict[int, int]:
        """Axles that counters still wait for, by section; zeros left out."""
        left = {number: section.exit or section.entry for number, section in self._sections.items()}
        return {number: axles for number, axles in left.items() if axles}

    def unfinished(self) -> dict[int, list[int]]:
        """By cut, the sections that have counted an axle of it and still wait for others."""
        waiting: dict[int, list[int]] = {}
        for number, section in self._sections.items():
            for cut in section.waits_for:
                waiting.setdefault(cut, []).append(number)
        return waiting

    def off_route(self) -> dict[int, int]:
        """By cut, the first switch behind which two axles of it, or more, were counted on another way than that to the
        track of its list. One alone may be of the cut ahead or behind: a counter that slips shifts one axle."""
        found: dict[int, int] = {}
        for (switch, cut), axles in self._off_route.items():
            if axles > 1:
                found.setdefault(cut, switch)
        return found

    def _following(self, element: int) -> tuple[int, ...]:
        branches = (0, 1) if self._table.is_switch(element) else (0,)
        found = (self._table.next_counted(element, branch) for branch in branches)
        return tuple(number for number in found if number is not None)
