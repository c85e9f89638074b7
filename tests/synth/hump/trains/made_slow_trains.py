"""Drawn cuts as the slow simulator takes them, and when they are let go."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from plant_models.rolling.random_cuts import DrawnCuts
from tests.synth.hump.trains.slow_train import Heads, SlowBody, SlowCar


def slow_body(drawn: DrawnCuts, i: int, bend_heads: Mapping[int, Heads]) -> SlowBody:
    """The numbers of one drawn cut, whose row may have room for more cars; heads of bends by track."""
    cars = []
    for place, mass_t in zip(drawn.types[i], drawn.mass_t[i], strict=True):
        car = drawn.mix.cars[place].car
        overhang = (car.length_m - car.axle_offsets_m[-1]) / 2.0
        if mass_t > 0.0:
            cars.append(SlowCar(car.length_m, float(mass_t), tuple(overhang + a for a in car.axle_offsets_m)))
    return SlowBody(
        tuple(cars),
        float((drawn.mass_t[i] * drawn.basic_n_per_kn[i]).sum() / drawn.mass_t[i].sum()),
        float(drawn.head_wind_m_s[i]),
        float(drawn.air_n_per_kn[i]),
        bend_heads,
    )


def crest_times_s(bodies: Sequence[SlowBody], speeds_m_s: Sequence[float]) -> list[float]:
    """When the middles of coupled cuts are at the crest; the train gets faster evenly between two releases."""
    times = [0.0]
    for k in range(1, len(bodies)):
        path = 0.5 * (bodies[k - 1].length_m + bodies[k].length_m)
        times.append(times[-1] + path / (0.5 * (speeds_m_s[k - 1] + speeds_m_s[k])))
    return times
