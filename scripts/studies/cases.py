"""Which cases of a configuration a study takes, the tables that a tune would make of them, what a regulator
reaches that is told the friction of every cut, and work on several cases at a time.

What a regulator reaches that is told the friction of every cut, with more effort than a tune makes. All else is as it
is: sensor, sampling, valves, path noise, one stage a command. It passes cuts as they come, each with the lines for its
friction.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeVar

from plant_models import Plant
from synth.frame.faults import InputError
from synth.problem.problem import Aim
from synth.retarder.comparison.friction_bound import Told, by_lines, run_told
from synth.retarder.configuration.config_file import load_config, parse_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.simulation.closed_loop import close_loop
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.solver.any_time.polynomial_surfaces import PolynomialSurfaces
from synth.solver.backward_induction import Solution, solve
from synth.solver.chain.chain import Chain, persistent_chain
from synth.solver.switching_lines import PolynomialLines
from synth.solver.tabulate import UNPREDICTED, tabulate
from synth.solver.told_lines import SQUARED_ERROR_ALONE, Effort, told_lines
from synth.solver.tuned_lines import fitted, polished, tuned_lines
from tuning_tables import ControllerTable, Estimator, Generator

_T = TypeVar("_T")
_R = TypeVar("_R")

THREADS = 2
"""Times of the documentation are of two cores. No figure depends on it."""


def side_by_side(work: Callable[[_T], _R], orders: Iterable[_T], threads: int = THREADS) -> tuple[_R, ...]:
    """`work` of each of `orders`, in their order."""
    with ThreadPoolExecutor(max_workers=threads) as pool:
        return tuple(pool.map(work, orders))


OTHER_PLANTS = (
    ("park", '[position]\nname = "rnz-2m-park"\n[[cut]]\ncar = "gondola-4"\nmass_t = 36\n'),
    ("three cars", '[targets]\nexit_speeds_m_s = [4.0]\n[[cut]]\ncar = "gondola-4"\ncars = 3\nmass_t = 156\n'),
    ("8 axles", '[targets]\nexit_speeds_m_s = [3.5]\n[[cut]]\ncar = "tank-8"\nmass_t = 120\n'),
)
"""Configurations besides the default one: name, text."""


@dataclass(frozen=True)
class Case:
    """A plant with the label of its class of cuts, and a target speed."""

    label: str
    plant: Plant
    target_m_s: float

    @property
    def name(self) -> str:
        """'22 t to 2 m/s'."""
        return f"{self.plant.cut.mass_t:g} t to {self.target_m_s:g} m/s"


def named_cases(config: ResolvedConfig, words: Sequence[str]) -> tuple[Case, ...]:
    """The cases named '22:2' (mass of a cut of the configuration, t : target, m/s). Raises `InputError`."""
    plants = {plant.cut.mass_t: (label, plant) for label, plant in config.plants()}
    found = []
    for word in words:
        try:
            mass, target = (float(part) for part in word.split(":"))
            label, plant = plants[mass]
        except (KeyError, ValueError):
            known = ", ".join(f"{mass:g}" for mass in plants)
            raise InputError(
                f"study: the case is {word!r}; give MASS:TARGET as in 22:2, the mass one of {known} t"
            ) from None
        found.append(Case(label, plant, target))
    return tuple(found)


def of_masses(config: ResolvedConfig, masses_t: Sequence[float]) -> ResolvedConfig:
    """`config` with the cuts of these masses only; with all of them where none is given. Raises `InputError`."""
    known = {cut_class.cut.mass_t for cut_class in config.cuts}
    unknown = [mass for mass in masses_t if mass not in known]
    if unknown:
        all_known = ", ".join(f"{mass:g}" for mass in sorted(known))
        raise InputError(f"study: no cut of the configuration has {unknown[0]:g} t; its masses are {all_known} t")
    return replace(config, cuts=tuple(c for c in config.cuts if not masses_t or c.cut.mass_t in masses_t))


def class_cases(config: ResolvedConfig, masses_t: Sequence[float], targets_m_s: Sequence[float]) -> tuple[Case, ...]:
    """The cuts of these masses (all for none) to each of these speeds (their targets for none). Raises `InputError`."""
    return tuple(
        Case(label, plant, target)
        for label, plant in of_masses(config, masses_t).plants()
        for target in targets_m_s or config.targets_of(label)
    )


def from_the_entrance(config: Path | None) -> ResolvedConfig:
    """The configuration in the file `config`; without one, the default book without approach."""
    if config is not None:
        return load_config(config)
    return parse_config("[regulator]\napproach_m = 0.0\n", "the default book without approach")


CREATED = "2000-01-01T00:00:00Z"


def tuned_table(config: ResolvedConfig, plant: Plant, target_m_s: float) -> ControllerTable:
    """Solved, fitted, polished and rounded as in a tune of `plant`, which need not be one of the configuration."""
    resolution = config.grid.resolution(plant.sensor.sample_period_s).for_pass(plant.pass_m)
    design = persistent_chain(plant, resolution)
    lines = tuned_lines(design, Aim(target_m_s, config.criterion), config.fit.degree).best
    return rounded(config, plant, lines, target_m_s)


def lines_of_solution(solution: Solution, degree: int) -> PolynomialLines:
    """Lines of `degree` fitted to a solution, and polished."""
    return polished(solution, fitted(solution, degree)).best


def rounded(
    config: ResolvedConfig,
    plant: Plant,
    lines: PolynomialLines | PolynomialSurfaces,
    target_m_s: float,
    estimator: Estimator | None = None,
) -> ControllerTable:
    """The table of `lines`, or of surfaces."""
    maker = Generator("retarder-synth study", "0", config.sha256)
    return tabulate(plant, lines, target_m_s, UNPREDICTED, maker, f"to-{target_m_s:g}", CREATED, estimator)


THOROUGH = Effort(frictions=13, iterations=(40, 40), resistance_nodes=2, least_share=0.0)
"""At more frictions; until a step gains nothing; also for the resistance that is not told; at every friction."""


def thorough(frictions: int, iterations: int) -> Effort:
    """As `THOROUGH`, with so many frictions and iterations of each polish."""
    return replace(THOROUGH, frictions=frictions, iterations=(iterations, iterations))


def told_friction(design: Chain, target_m_s: float, degree: int, effort: Effort = THOROUGH) -> Told:
    """The regulator of lines that are solved, fitted and polished on `design`, then polished for each friction."""
    solution = solve(design, Aim(target_m_s, SQUARED_ERROR_ALONE))
    fit = fitted(solution, degree)
    return by_lines(told_lines(design, target_m_s, polished(solution, fit).best, fit.curvature, effort))


def simulate_told(plant: Plant, told: Told, passes: RandomPasses) -> ExitSample:
    """`passes` of `plant`, each under the regulator for its friction."""
    loop = close_loop(plant, plant.top_stage + 1)
    return run_told(lambda _: loop, loop.draws(passes), told)
