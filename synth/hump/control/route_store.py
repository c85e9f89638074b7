"""The route store of the published model: which track each cut goes to, and which cut comes next over a switch."""

from __future__ import annotations

from bisect import bisect_left, bisect_right, insort
from collections.abc import Sequence

from plant_models.errors import require
from synth.hump.control.cut_record import CutRecord
from synth.hump.control.route_table import RouteTable


class RouteStore:
    """Cuts in the order in which they come over the hump, and their tracks; filled before each train.

    `PlantError` for a track that no route leads to, a lead that the hump has not, or a number given twice.
    """

    def __init__(self, table: RouteTable, cuts: Sequence[CutRecord]) -> None:
        self._table = table
        self.cuts = tuple(cuts)
        self.place = {cut.serial: place for place, cut in enumerate(self.cuts)}
        require(len(self.place) == len(self.cuts), "route store: two cuts have the same number")
        self._tracks: dict[int, int] = {}
        self._comers: dict[int, list[int]] = {switch: [] for switch in table.needed}
        leads = len(table.graph.leads)
        for cut in self.cuts:
            require(
                cut.lead < leads,
                f"cut {cut.serial}: lead is {cut.lead}; the hump has {leads} lead{'s' if leads > 1 else ''}, from 0 on",
            )
            self._put(cut.serial, cut.track)

    def record(self, cut: int) -> CutRecord:
        """The record of the cut with this serial number."""
        return self.cuts[self.place[cut]]

    def __contains__(self, cut: int) -> bool:
        return cut in self.place

    def track(self, cut: int) -> int:
        """Where it goes now."""
        return self._tracks[cut]

    def next_over(self, switch: int, behind: int) -> int | None:
        """The first cut behind the place `behind` whose route has this switch; None if there is none."""
        comers = self._comers[switch]
        at = bisect_right(comers, behind)
        return self.cuts[comers[at]].serial if at < len(comers) else None

    def position(self, switch: int, cut: int) -> int:
        """The position, 0 left or 1 right, that `cut` needs of a switch of its route."""
        return self._table.needed[switch][self._tracks[cut]]

    def change(self, cut: int, track: int) -> tuple[int, ...]:
        """Give `cut` another track; the switches of both routes."""
        place, old = self.place[cut], self.switches(cut)
        for switch in old:
            comers = self._comers[switch]
            del comers[bisect_left(comers, place)]
        self._put(cut, track)
        return tuple(dict.fromkeys((*old, *self.switches(cut))))

    def switches(self, cut: int) -> tuple[int, ...]:
        """The switches of its route, the first one first."""
        return tuple(self._table.route(self.record(cut).lead, self._tracks[cut]).positions)

    def _put(self, cut: int, track: int) -> None:
        self._tracks[cut] = track
        for switch in self.switches(cut):
            insort(self._comers[switch], self.place[cut])
