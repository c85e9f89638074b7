"""Cuts that cannot go where the list says: their record, and their new track."""

from __future__ import annotations

from collections.abc import Iterable

from plant_models.errors import require
from synth.hump.control.event import Kind, Why
from synth.hump.control.journal import Journal
from synth.hump.control.models import Misroute, Technology
from synth.hump.control.route_store import RouteStore


class Misrouting:
    """Asks the technology for another track, and records where and why."""

    def __init__(self, store: RouteStore, technology: Technology, journal: Journal) -> None:
        self._store, self._technology, self._journal = store, technology, journal

    def send(self, cut: int, element: int, why: Why, reachable: Iterable[int], leader: int = 0) -> tuple[int, ...]:
        """Send `cut`, which is at `element`, to one of the `reachable` tracks; the switches whose next cut may have
        changed by that. A cut that keeps its own track is no misrouted one."""
        tracks, belongs = tuple(sorted(reachable)), self._store.record(cut).track
        leader_track = self._store.track(leader) if leader in self._store else None
        chosen = self._technology(Misroute(cut, element, why, leader, tracks, belongs, leader_track))
        require(
            chosen in tracks, f"technology: track {chosen} for cut {cut} cannot be reached from element {element}; "
            f"it must be one of {', '.join(map(str, tracks))}",
        )  # fmt: skip
        keeps = chosen == self._store.track(cut)
        if chosen != belongs and not (keeps and cut in self._journal.state.misrouted):
            self._journal.tell(Kind.MISROUTED, element, cut, why)
        if keeps:
            return ()
        self._journal.tell(Kind.RE_ROUTED, element, cut, chosen)
        return self._store.change(cut, chosen)
