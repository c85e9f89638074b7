"""Pairs of trials on the same trains: couplings by the exactness of the positions, a bad day, programs of hump
speeds, other switches.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from plant_models.hump import HumpGraph, Signal, Switch
from scripts.studies.humping.base_trial import (
    READING,
    Day,
    Locomotive,
    UnknownWind,
    braked_by,
    with_free,
    with_known_resistance,
    with_planner,
)
from scripts.studies.humping.day_figures import Pair, PairFigures
from scripts.studies.study import Tell
from synth.hump.planning.speed_rules import pair_by_pair
from synth.hump.rolling.hump_routes import hump_routes
from synth.hump.rolling.route_rolling import route_ways
from synth.hump.trial.trial import HumpTrial

SHARES = (1.0, 0.5, 0.25)
"""Of the error of the positions: as it was, halved, quartered."""

FREE = ((0.1, 0.5), (0.2, 0.9))
"""Free shares of the tracks, from and to; assumed, the source tells none."""

CAREFUL = 0.05


@dataclass(frozen=True)
class Aimed:
    """All positions have the error `std_m_s`; the last one's commands were chosen for `aim_std_m_s` and a share of
    over-speeds. Tracks are free on a share of their length between both of `free`. `measured`: commands follow the
    measured resistance of a cut, not the mean of its category."""

    std_m_s: float
    aim_std_m_s: float
    p_overspeed: float
    free: tuple[float, float]
    measured: bool = False

    @property
    def name(self) -> str:
        """Tells it from the others."""
        return (
            f"σ {self.std_m_s:.3g}, commands for σ {self.aim_std_m_s:.3g} and {self.p_overspeed:g}, free "
            f"{self.free[0]:g}–{self.free[1]:g}{', measured' * self.measured}"
        )


@dataclass(frozen=True)
class AimedFigures:
    """What it came to."""

    aimed: Aimed
    found: PairFigures


def coupling_pairs(day: Day, stds_m_s: tuple[float, ...], tell: Tell) -> dict[Aimed, Pair]:
    """A pair a position, way of choosing commands, and length of the free tracks: the position of `day` and better
    ones, then positions with `stds_m_s` and commands of their own."""
    usual = day.p_overspeed
    ways = [
        (day.std_m_s * part, aim_std, p)
        for part in SHARES
        for aim_std, p in ((day.std_m_s, usual), (day.std_m_s * part, usual), (day.std_m_s * part, CAREFUL))
    ]
    known = [*((*way, False) for way in ways), *((std, std, usual, m) for m in (False, True) for std in stds_m_s)]
    pairs: dict[Aimed, Pair] = {}
    for std, aim_std, p, measured in dict.fromkeys(known):
        made = Day(day.seed, day.cuts, std, aim_std, p, day.design_cuts, measured).trial()
        for free in FREE:
            aimed = Aimed(std, aim_std, p, free, measured)
            pairs[aimed] = Pair(aimed.name, with_free(made, free), READING if measured else None)
    tell("commands chosen for every exactness")
    return pairs


WEAKER, OILED = 0.6, 0.7
"""Shares of the full brake: low supply, and friction that is 30 % less."""

WIND_M_S = 6.0
COLD = "temperature_c = -20.0\nsnow_n_per_kn = {snow}\n"
SNOW_N_PER_KN = 0.3
"""Assumed."""

TB = '[resistance]\nlaw = "tb-10062"\n'
USUAL = "as planned"


def disturbance_pairs(day: Day, base: HumpTrial, tell: Tell) -> list[Pair]:
    """A pair a disturbance; what the control knows of it is in its name."""
    out = ("", "out_of_service = true\n", "")
    weak = (f"supply_share = {WEAKER}\n",) * 3
    wind = f"[weather]\nhead_wind_mean_m_s = {WIND_M_S}\n"
    cold = "[weather]\n" + COLD.format(snow=SNOW_N_PER_KN)
    pairs = [
        Pair(USUAL, base),
        Pair("position 2 out of service, known", replace(day, positions=out).trial()),
        Pair("position 2 out of service, not known", braked_by(base, 0.0, 1)),
        Pair(f"supply: {WEAKER:g} of the full brakes, known", replace(day, positions=weak).trial()),
        Pair(f"supply: {WEAKER:g} of the full brakes, not known", braked_by(base, WEAKER)),
        Pair("all wheels oiled: friction −30 %, not known", braked_by(base, OILED)),
        Pair("law TB 10062 at +10 °C", replace(day, more=TB).trial()),
        Pair("law TB 10062 at −20 °C, snow", replace(day, more=TB + cold).trial()),
        Pair(f"head wind {WIND_M_S:g} m/s, known", replace(day, more=wind).trial()),
        Pair(
            f"head wind {WIND_M_S:g} m/s, not known",
            replace(base, source=UnknownWind(**vars(base.source), more_m_s=WIND_M_S)),
        ),
    ]
    tell("trials of bad days made")
    return pairs


CONSTANT_M_S = (1.7, 2.2, 2.7)

CAPS_M_S = (3.0, 2.5)
"""Fastest at which cuts are uncoupled by hand; assumed, the source tells none."""

WEAK_M_S2 = 0.05
"""Acceleration of a weaker locomotive."""

KNOWN, MEAN, WORST = "resistance known", "mean of the category", "worst pair"
PAIRWISE, WEAK = "mean of the category, pair by pair", f"mean of the category, locomotive {WEAK_M_S2:g} m/s²"


def program_pairs(base: HumpTrial) -> list[Pair]:
    """A pair a program."""
    worst = with_planner(base, worst_pair=True)
    weak = Locomotive(acceleration_m_s2=WEAK_M_S2)
    pairs = [
        Pair(KNOWN, with_known_resistance(base)),
        Pair(MEAN, base),
        Pair(WORST, worst),
        *(Pair(capped(cap), with_planner(worst, locomotive=Locomotive(cap))) for cap in CAPS_M_S),
        Pair(WEAK, with_planner(base, locomotive=weak)),
        Pair(PAIRWISE, with_planner(base, method=pair_by_pair)),
        Pair(f"{PAIRWISE}, locomotive {WEAK_M_S2:g} m/s²", with_planner(base, method=pair_by_pair, locomotive=weak)),
    ]
    return pairs + [Pair(f"{each:g} m/s for all", constant(base, each)) for each in CONSTANT_M_S]


def constant(base: HumpTrial, speed_m_s: float) -> HumpTrial:
    """All cuts pushed at one speed."""
    limits = replace(base.planner.limits, steps_m_s=(speed_m_s,))
    return replace(base, planner=replace(base.planner, limits=limits))


def capped(cap_m_s: float) -> str:
    """The row of a program with uncoupling by hand."""
    return f"{WORST}, at most {cap_m_s:g} m/s"


THROWS_S = (0.8, 1.0)
SECTIONS_M = (9.0, 15.0)
KING_M = (36.0, 50.0)

Change = Callable[[Switch], Switch]


def sensitivity_pairs(base: HumpTrial) -> list[Pair]:
    """A pair a change, the hump as it is first."""
    graph, lead = base.routes.graph, base.routes.lead
    changed = [("as it is", graph)]
    changed += [(f"throw {each:g} s", with_switches(graph, thrown_in(each))) for each in THROWS_S]
    changed += [(f"sections {each:g} m", with_switches(graph, on_section(each))) for each in SECTIONS_M]
    changed += [(f"king switch at {each:g} m", with_king_switch(graph, lead, each)) for each in KING_M]
    return [Pair(name, on_graph(base, each)) for name, each in changed]


def thrown_in(throw_s: float) -> Change:
    """Switches with slower machines."""
    return lambda switch: replace(switch, throw_s=throw_s)


def on_section(length_m: float) -> Change:
    """Switches with longer or shorter sections: the joint behind the points is elsewhere."""
    return lambda switch: replace(switch, exit_joint_m=length_m - switch.entry_joint_m)


def with_switches(graph: HumpGraph, change: Change) -> HumpGraph:
    """The hump with every switch changed."""
    vertices = tuple(change(each) if isinstance(each, Switch) else each for each in graph.vertices)
    return HumpGraph(vertices, graph.leads)


def with_king_switch(graph: HumpGraph, lead: int, from_crest_m: float) -> HumpGraph:
    """The first switch at another place; the fall to it is the same, on a first grade that is steeper or less steep."""
    signal = graph.vertex(lead)
    assert isinstance(signal, Signal)
    edge = signal.next
    (_, steep), (turns_m, flat) = edge.grades
    rest_m = edge.length_m - turns_m
    begins_m = from_crest_m - rest_m
    moved = replace(edge, length_m=from_crest_m, grades=((0.0, steep * turns_m / begins_m), (begins_m, flat)))
    vertices = tuple(replace(signal, next=moved) if each is signal else each for each in graph.vertices)
    return HumpGraph(vertices, graph.leads)


def on_graph(base: HumpTrial, graph: HumpGraph) -> HumpTrial:
    """The trial on another hump with the same tracks behind the last position, for which its aims were chosen."""
    routes, source = hump_routes(graph, base.routes.lead), base.source
    return replace(
        base,
        source=replace(source, routes=routes.routes),
        routes=routes,
        ways=route_ways(source.people, routes.routes),
        planner=replace(base.planner, routes=routes),
    )
