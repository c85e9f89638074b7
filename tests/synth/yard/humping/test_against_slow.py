"""Random small trains by the layered simulator and by the slow one: event by event, and when and where cuts pass."""

from __future__ import annotations

import numpy as np
import pytest

from plant_models.library.hump_entry import load_hump
from plant_models.rolling.resistance_law import HumpNormLaw, ResistanceLaw, Tb10062Law
from plant_models.rolling.weather import Weather
from tests.plant_models.rolling.populations import MIX, population
from tests.synth.yard.humping.agreement import agreement, judged
from tests.synth.yard.humping.fast_and_slow import HARD, both_trains
from tests.synth.yard.humping.slow_humping import humped_slowly
from tests.synth.yard.humping.slow_train import Kind

TRACKS = (1, 2, 3, 9, 17)
TRAINS, CUTS = 15, 6
NEAR_S = 0.03
"""A decision that is nearer to its limit may be another with the steps of the layered simulator."""


@pytest.mark.parametrize(
    ("law", "weather", "seed"),
    [(HumpNormLaw(), Weather(), 0), (Tb10062Law(), Weather(temperature_c=20.0, snow_n_per_kn=0.1), 1)],
    ids=["hump-norm", "tb-10062"],
)
def test_both_simulators_tell_the_same_of_small_trains(law: ResistanceLaw, weather: Weather, seed: int) -> None:
    """Same events; times at joints to 30 ms, places where cuts stand to 0.15 m, coupling speeds to 10 mm/s."""
    both = both_trains(load_hump("large").graph, population(MIX, law, weather), TRACKS, seed, TRAINS, CUTS)
    memory = both.fast()
    kinds: set[Kind] = set()
    compared = 0
    for train in range(TRAINS):
        run = humped_slowly(both.graph, both.slow(train))
        np.testing.assert_allclose([cut.crest_s for cut in both.slow(train).cuts], memory.crest_s[train], atol=1e-9)
        if run.closest_s < NEAR_S:
            continue
        found = agreement(both, memory, run, train)
        assert not found.differing, train
        assert not found.tracks, train
        assert found.times_s < 0.03, train
        assert found.heads_m < 0.15, train
        assert found.couplings_m_s < 0.01, train
        kinds |= {event.kind for event in run.events}
        compared += len(judged(run))
    assert kinds >= {Kind.NOT_SEPARATED, Kind.MISROUTED, Kind.CONTACT, Kind.TRACK_CONTACT, Kind.COUPLED, Kind.GAP}
    assert compared > 0.7 * TRAINS * CUTS


def test_both_simulators_see_the_same_cuts_foul() -> None:
    """Cuts that stop short of a fouling point are rare, so the layered simulator looks for them first."""
    both = both_trains(load_hump("large").graph, population(MIX, HumpNormLaw(), Weather()), TRACKS, 5, 3000, CUTS, HARD)
    memory = both.fast()
    alone = (memory.contact_at == both.routes.elements).all(axis=1)  # tails in contact are nearly, not quite, the same
    fouling = np.flatnonzero(memory.foul.any(axis=(1, 2)) & alone).tolist()
    assert len(fouling) >= 3
    for train in fouling[:3]:
        run = humped_slowly(both.graph, both.slow(train))
        assert run.of(Kind.FOULED), train
        assert run.of(Kind.STOPPED), train
        assert not agreement(both, memory, run, train).differing, train
