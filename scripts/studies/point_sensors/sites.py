"""The plants that point sensors are put to (a bunch position, a park position, the position behind a car dumper),
the layouts that are compared (planned, equal sections, the rule of zhukovitsky-2012), and the table of one, with
what the closed loop makes of it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np

from plant_models import Cut, Plant, PointSensors, every_axle, first_axle
from plant_models.errors import near_miss
from scripts.studies.cases import CREATED
from synth.frame.faults import InputError
from synth.frame.workers.engine import silent
from synth.problem.problem import Aim
from synth.problem.resolution import Resolution
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.sensors.layout import equal_layout, rule_layout
from synth.retarder.sensors.layout_plan import JudgedLayout, LayoutProblem, PlanPasses, ended, plan_passes, searched
from synth.retarder.sensors.passage_table import TunedPassages, passage_chains, passage_table, tuned_passages
from synth.simulation.passage_controller import DECIDED, UNFINISHED, PassageSample, of_table
from synth.simulation.passage_loop import PassageLoop, close_passage_loop
from synth.simulation.random_passes import RandomPasses
from synth.simulation.replicates import Interval, half_width
from synth.solver.chain.sampling import with_point_sensors
from tuning_tables import Generator
from tuning_tables.passages.passage_table import PassageTable

TEXTS = {
    "bunch-22": ("", '[[cut]]\ncar = "gondola-4"\nmass_t = 22\ntargets_m_s = [2.0]\n'),
    "bunch-52": ("", '[[cut]]\ncar = "gondola-4"\nmass_t = 52\ntargets_m_s = [3.0]\n'),
    "park-22": (
        '[position]\nname = "rnz-2m-park"\n',
        '[[cut]]\ncar = "gondola-4"\nmass_t = 22\ntargets_m_s = [2.0]\n',
    ),
    "park-85": (
        '[position]\nname = "rnz-2m-park"\n[entry]\nhigh_m_s = 4.5\n',
        '[[cut]]\ncar = "gondola-4"\nmass_t = 85\ntargets_m_s = [2.5]\n',
    ),
    "dumper-4": (
        '[position]\nname = "rnz-2m-dumper"\n',
        '[[cut]]\ncar = "gondola-4"\nmass_t = 22\nallowed_stage = 3\ntargets_m_s = [2.0]\n',
    ),
    "dumper-6": (
        '[position]\nname = "rnz-2m-dumper"\n',
        '[[cut]]\ncar = "gondola-6"\nmass_t = 32\nallowed_stage = 3\ntargets_m_s = [2.0]\n',
    ),
}
"""Position and cut of each site. At the park position brake power for 85 t ends at about 4.5 m/s. Cars behind a dumper
may be given stage 3: with oil it brakes no harder than stage 2 does without."""


@dataclass(frozen=True)
class Site:
    """One class of cuts at a position, with its aim; `config`: the configuration that tables are made with."""

    name: str
    config: ResolvedConfig
    plant: Plant
    aim: Aim

    @property
    def target_m_s(self) -> float:
        """Commanded exit speed."""
        return self.aim.target_speed_m_s

    @property
    def title(self) -> str:
        """'bunch, 52 t to 3 m/s'."""
        kind, _, _ = self.name.partition("-")
        axles = f" on {self.plant.cut.axles} axles" if kind == "dumper" else ""
        return f"{kind}, {self.plant.cut.mass_t:g} t{axles} to {self.target_m_s:g} m/s"


def sites(names: Sequence[str]) -> tuple[Site, ...]:
    """The sites of these names. Raises `InputError`."""
    return tuple(site_of(name) for name in names)


def site_of(name: str) -> Site:
    """The site `name`; its configuration has the grid of a tune. Raises `InputError`."""
    if name not in TEXTS:
        raise InputError(f"study point-sensors: there is no case {name!r}; {near_miss(name, TEXTS)}")
    config = parse_config("".join(TEXTS[name]), name)
    ((label, plant),) = config.plants()
    (target,) = config.targets_of(label)
    return Site(name, config, plant, Aim(target, config.criterion))


def single_stage(site: Site, pressure_kpa: float) -> Site:
    """The same site where the brake has one stage besides the released one, so that no command passes over a stage."""
    position = replace(site.plant.position, stage_pressures_kpa=(0.0, pressure_kpa))
    return replace(site, plant=replace(site.plant, position=position))


Places = tuple[float, ...]
"""Of the deciding sensors, m from the entrance, rising."""

Layouts = Callable[[LayoutProblem, Sequence[int]], tuple[Places, ...]]
"""Layouts of a problem with one case, for several numbers of deciding sensors."""


def equal_sections(problem: LayoutProblem, deciding: Sequence[int]) -> tuple[Places, ...]:
    """One ahead as the rule has it, the others in equal sections from the entrance on."""
    return tuple(equal_layout(problem.first_m, problem.exit_m, count) for count in deciding)


def planned(problem: LayoutProblem, deciding: Sequence[int]) -> tuple[Places, ...]:
    """The best found, as `sensors` has it."""
    if not deciding:
        return ()
    passes = plan_passes(seed=1, count=1000)
    return tuple(each.deciding_m for each in plan_layouts(problem, deciding, passes))


def plan_layouts(
    problem: LayoutProblem,
    counts: Sequence[int],
    passes: PlanPasses,
    threads: int = 1,
) -> tuple[JudgedLayout, ...]:
    """The best layout found for each number of deciding sensors; how many `threads` there are changes nothing of it."""
    with ThreadPoolExecutor(max_workers=threads) as searching, ThreadPoolExecutor(max_workers=threads) as judging:
        return ended(judging.submit(searched, problem, counts, passes, (searching, judging), silent))


def by_rule(problem: LayoutProblem) -> Places:
    """Every section as long as the longest change of stage takes; the rule says how many sensors that needs."""
    (case,) = problem.cases
    return rule_layout(case.plant, problem.sensors, case.aims[0].target_speed_m_s)


AXLES: dict[str, Callable[[Cut], tuple[int, ...]]] = {"first": first_axle, "every": every_axle}
"""The axles that are decided on, by the word of the tables."""


@dataclass(frozen=True)
class SensorTable:
    """A table with what it was made of and the loop that it runs in."""

    tuned: TunedPassages
    table: PassageTable
    loop: PassageLoop

    @property
    def plant(self) -> Plant:
        """The plant, which begins at the first sensor."""
        return self.tuned.plant

    def run(self, passes: RandomPasses) -> PassageSample:
        """The passes by a regulator that is told each passage."""
        return self.loop.run(of_table(self.table, tracking=False), self.loop.draws(passes))


def tabulated(site: Site, tuned: TunedPassages) -> SensorTable:
    """The exported table of tuned switching speeds."""
    maker = Generator("retarder-synth study", "0", site.config.sha256)
    table = passage_table(tuned, maker, f"{site.name}-{len(tuned.sensors.path_m)}", CREATED)
    loop = close_passage_loop(tuned.plant, tuned.sensors, table.switching_m_s.shape[1])
    return SensorTable(tuned, table, loop)


def sensor_table(site: Site, sensors: PointSensors, resolution: Resolution) -> SensorTable:
    """Tuned, predicted and rounded on `resolution`."""
    plant = with_point_sensors(site.plant, sensors)
    return tabulated(site, tuned_passages(passage_chains(plant, sensors, resolution), site.aim))


def unfinished_share(sample: PassageSample) -> tuple[float, Interval]:
    """Share of all passages heard that found a transient unfinished, and its 95 % interval."""
    late = (sample.outcome == UNFINISHED).sum(axis=1).astype(np.float64)
    heard = late + (sample.outcome == DECIDED).sum(axis=1)
    weight = sample.weight * heard
    value = float(sample.weight @ late / weight.sum())
    half = half_width(sample.weight * (late - value * heard), weight)
    return value, (max(value - half, 0.0), value + half)
