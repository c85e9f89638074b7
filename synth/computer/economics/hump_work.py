"""What a hump does in a day: hours of trains, cars and locomotives, damages, gaps."""

from __future__ import annotations

from dataclasses import dataclass

from synth.computer.economics.hump_queue import HumpQueue, WaitLaw, whitt_h
from synth.computer.economics.hump_rates import HumpRates
from synth.computer.economics.traffic import Handling, Traffic

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
