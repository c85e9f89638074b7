"""What a hump does in a day: hours of trains (which wait in a queue at the hump), cars and locomotives, damages,
gaps.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from plant_models.errors import PlantError
from synth.computer.economics.traffic import Handling, HumpRates, Traffic


@dataclass(frozen=True)
class HumpQueue:
    """Trains that come, wait in one line and are humped on `leads` leads, first come first served.

    `trains_per_h`: mean rate. `arrival_scv`: squared coefficient of variation (variance / mean²) of the times between
    trains. `service_h`, `service_scv`: mean and squared coefficient of variation of the time for which a train takes a
    lead. All times are independent. A wait grows as 1/(1 − ρ): where the load is uncertain and may come near 1, the
    wait has quantiles but no mean. `PlantError` where more comes than the leads can hump.
    """

    trains_per_h: float
    arrival_scv: float
    service_h: float
    service_scv: float
    leads: int = 1

    def __post_init__(self) -> None:
        if self.load >= 1.0:
            raise PlantError(overload_sentence(self))

    @property
    def load(self) -> float:
        """ρ = λτ/c: the part of the time for which a lead is taken."""
        return self.trains_per_h * self.service_h / self.leads

    @property
    def relaxation_h(self) -> float:
        """How long the queue remembers where it began: 2τρ(c_a² + c_s²) / (1 − ρ)² / c.

        The gap of the spectrum of Brownian motion that is reflected at 0, with the drift and variance of the work that
        waits. A mean wait is one of times that are long against this: where it comes near a day, a day's queue depends
        on how it began. A heavy-traffic value; for M/M/1 it is 1/(μ(1 − √ρ)²) within 3 % at ρ ≥ 0.95.
        """
        spread = self.arrival_scv + self.service_scv
        return 2.0 * self.service_h * self.load * spread / (1.0 - self.load) ** 2 / self.leads


def overload_sentence(queue: HumpQueue) -> str:
    """Says by how much more comes than can be humped."""
    possible = queue.leads / queue.service_h
    return (
        f"the hump is overloaded: {queue.trains_per_h:.4g} trains an hour come and fewer than {possible:.4g} can be "
        f"humped (leads: {queue.leads}); the load is {queue.load:.4g} and must be below 1"
    )


WaitLaw = Callable[[HumpQueue], float]
"""Mean wait of a train until its humping begins, in h."""


def allen_cunneen_h(queue: HumpQueue) -> float:
    """Mean wait after Allen and Cunneen: W = C(c, ρ)·τ / (c(1 − ρ)) · (c_a² + c_s²)/2, C of Erlang.

    Exact for Poisson arrivals on one lead (Pollaczek and Khinchine) and for M/M/c; with c = 1 it is the heavy-traffic
    formula of Kingman, exact as ρ → 1 for any arrivals. Trains that come more evenly than Poisson wait less than it
    tells.
    """
    return erlang_c(queue) * queue.service_h / (queue.leads * (1.0 - queue.load)) * mean_scv(queue)


def whitt_h(queue: HumpQueue) -> float:
    """Mean wait after Whitt (QNA, Bell System Technical Journal 62 (1983)): Allen and Cunneen's times g.

    g = exp(−2(1 − ρ)(1 − c_a²)² / (3ρ(c_a² + c_s²))) for c_a² < 1, by Krämer and Langenbach-Belz, else 1. Exact where
    Allen and Cunneen's is. Otherwise two moments do not settle a wait: on one lead with gamma-distributed times and ρ
    from 0.5 to 0.95 it came within 12 % or 0.03 τ of simulations for c_a² from 0.25 to 1, and was up to 20 % too short
    for c_a² to 2, most at ρ = 0.5. On trains much more even than that (c_a² = 0.1, c_s² under 0.1) half of a short
    wait is missing.
    """
    ca2, cs2, load = queue.arrival_scv, queue.service_scv, queue.load
    if load == 0.0 or ca2 + cs2 == 0.0:
        return 0.0
    correction = 1.0
    if ca2 < 1.0:
        correction = math.exp(-2.0 * (1.0 - load) * (1.0 - ca2) ** 2 / (3.0 * load * (ca2 + cs2)))
    return correction * allen_cunneen_h(queue)


def mean_scv(queue: HumpQueue) -> float:
    """(c_a² + c_s²)/2."""
    return 0.5 * (queue.arrival_scv + queue.service_scv)


def erlang_c(queue: HumpQueue) -> float:
    """Share of customers of M/M/c that wait; ρ for one lead. By Erlang B: B_k = a·B_{k−1} / (k + a·B_{k−1})."""
    offered = queue.load * queue.leads
    blocked = 1.0
    for servers in range(1, queue.leads + 1):
        blocked = offered * blocked / (servers + offered * blocked)
    return blocked / (1.0 - queue.load * (1.0 - blocked))


HOURS_PER_DAY = 24.0


@dataclass(frozen=True)
class HumpWork:
    """The work of a day, all leads together.

    `load`: part of the time for which a lead is taken. `humping_h`: mean time over the crest of a train of mean length.
    `wait_h`: mean wait of a train for humping. `relaxation_h`: see `HumpQueue`. The rest is a day's sum: hours that
    cars are in a train that is humped or that waits for it; hours of the hump locomotive with trains (`humping`), gaps
    (`pushing_up`) and cuts on a wrong track (`sorting_again`); numbers of couplings by class of speed, catch-ups and
    misrouted cuts; metres of gap.
    """

    load: float
    humping_h: float
    wait_h: float
    relaxation_h: float
    car_h_humping: float
    car_h_waiting: float
    locomotive_h_humping: float
    locomotive_h_pushing_up: float
    locomotive_h_sorting_again: float
    over_speeds_to_1_5: float
    over_speeds_to_2: float
    over_speeds_above_2: float
    catch_ups: float
    misrouted: float
    gap_m: float

    @property
    def car_h(self) -> float:
        """Hours that cars spend waiting for humping and being humped."""
        return self.car_h_humping + self.car_h_waiting


def hump_work(rates: HumpRates, traffic: Traffic, handling: Handling, wait_law: WaitLaw = whitt_h) -> HumpWork:
    """The work of a mean day; `PlantError` where more trains come than can be humped.

    The humping of a train takes its whole time of every car: a car stands in the train first and on its track then.
    Trains wait first come first served, so a wait does not depend on a train's own length.
    """
    queue = hump_queue(rates, traffic, handling)
    wait_h = wait_law(queue)
    cuts, on_track = traffic.cuts_per_day, traffic.cuts_per_day * rates.on_track
    gap_m, misrouted = on_track * rates.gap_m, cuts * rates.misrouted
    trains = traffic.trains_per_day
    return HumpWork(
        load=queue.load,
        humping_h=traffic.cars_per_train / rates.cars_per_h,
        wait_h=wait_h,
        relaxation_h=queue.relaxation_h,
        car_h_humping=trains * traffic.squared_cars_per_train / rates.cars_per_h,
        car_h_waiting=traffic.cars_per_day * wait_h,
        locomotive_h_humping=traffic.cars_per_day / rates.cars_per_h + trains * handling.between_trains_h,
        locomotive_h_pushing_up=gap_m * handling.locomotive_h_per_gap_m,
        locomotive_h_sorting_again=misrouted * handling.locomotive_h_per_misrouted_cut,
        over_speeds_to_1_5=on_track * rates.over_speeds_to_1_5,
        over_speeds_to_2=on_track * rates.over_speeds_to_2,
        over_speeds_above_2=on_track * rates.over_speeds_above_2,
        catch_ups=cuts * rates.catch_ups,
        misrouted=misrouted,
        gap_m=gap_m,
    )


def hump_queue(rates: HumpRates, traffic: Traffic, handling: Handling) -> HumpQueue:
    """The queue of trains for humping.

    A train of n cars takes a lead for n·h + b: h is what a car takes over the crest, and its share of pushing up and
    sorting again that stops humping; b the time between trains. Variance of both, n and b independent.
    """
    extra_h = (
        rates.on_track * rates.gap_m * handling.locomotive_h_per_gap_m
        + rates.misrouted * handling.locomotive_h_per_misrouted_cut
    ) / traffic.cars_per_cut
    per_car_h = 1.0 / rates.cars_per_h + handling.blocked_share * extra_h
    mean_h = traffic.cars_per_train * per_car_h + handling.between_trains_h
    variance_h2 = (traffic.cars_per_train_std * per_car_h) ** 2 + handling.between_trains_std_h**2
    return HumpQueue(
        trains_per_h=traffic.trains_per_day / HOURS_PER_DAY,
        arrival_scv=traffic.arrival_scv,
        service_h=mean_h,
        service_scv=variance_h2 / mean_h**2,
        leads=traffic.leads,
    )
