"""How much a sweep of the tool's own problem cannot do without, counted on the chain itself."""

from __future__ import annotations

from dataclasses import dataclass

from scripts.studies.benchmark.by_numpy import Swept
from synth.solver.chain.chain import Chain


@dataclass(frozen=True)
class SweepWork:
    """Work for one target.

    `states`: scenario, path node, resting mode, noise level, energy (stalls left out). `transitions`: a state, a
    command, an outcome: a landing of a change (a noise level and a side of the law of the friction met), or a noise
    level of a quantum rolled at a held stage on the way to the next sample. `products`: multiply-adds of values that
    interpolating and mixing take; where landings lie, gains and lines are not counted. `value_floats`: the values of
    one scenario that a node reads from, at a sample and before the noise level changes.
    """

    states: int
    transitions: int
    products: int
    value_floats: int


def sweep_work(chain: Chain, swept: Swept) -> SweepWork:
    """Count; `swept` knows how many landings were no stalls."""
    levels, reach = len(chain.path_noise.levels), len(chain.entry)
    rows = len(chain.actuator.mode_stage) * levels
    points, nodes = len(chain.grid.speed_m_s), len(chain.drive_m_s2)
    states = nodes * len(chain.scenarios.factor) * rows * (points - 1)
    rolled = states * (reach - 1)
    ring = chain.transient_noise.probability.shape[1] + 3
    return SweepWork(
        states=states,
        transitions=swept.landings + rolled * levels,
        products=4 * swept.groups + rolled * (levels + 4) + states * levels,
        value_floats=2 * ring * rows * points,
    )
