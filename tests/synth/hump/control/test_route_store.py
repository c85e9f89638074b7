"""The next cut over a switch, by the definition: the first behind the last whose route has the switch."""

from __future__ import annotations

import numpy as np
import pytest

from synth.hump.control.route_store import RouteStore
from synth.hump.control.route_table import RouteTable
from tests.plant_models.hump.random_humps import random_hump
from tests.synth.hump.control.made_trains import record


def has_switch(table: RouteTable, track: int, switch: int) -> bool:
    """Whether the route from the first lead has the switch."""
    return switch in table.graph.route(table.graph.leads[0], track).positions


@pytest.mark.requirement("HUMP-02")
@pytest.mark.parametrize("seed", range(30))
def test_the_next_cut_over_a_switch_is_the_first_whose_route_has_it(seed: int) -> None:
    """Also after cuts got other tracks; and a change names the switches of both routes."""
    table, random = RouteTable(random_hump(seed)), np.random.default_rng(seed)
    tracks = list(table.graph.routes(table.graph.leads[0]))
    cuts = [record(n, int(random.choice(tracks))) for n in range(1, 25)]
    store, goes = RouteStore(table, cuts), {cut.serial: cut.track for cut in cuts}
    for _ in range(15):
        for switch in table.needed:
            for behind in (-1, 0, 7, 23):
                comers = [c for n, c in enumerate(goes) if n > behind and has_switch(table, goes[c], switch)]
                assert store.next_over(switch, behind) == (comers[0] if comers else None)
        cut, track = int(random.integers(1, 25)), int(random.choice(tracks))
        both = [s for s in table.needed if has_switch(table, goes[cut], s) or has_switch(table, track, s)]
        assert sorted(store.change(cut, track)) == sorted(both)
        goes[cut] = track
        assert store.track(cut) == track
