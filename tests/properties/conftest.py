"""A small plant with everything random in it, coarse enough to be solved in a blink."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from plant_models import Approach, DopplerSensor, EntrySpeed, Friction, Plant, PressingForce, RollingResistance
from synth.problem.resolution import Resolution
from synth.solver.chain.chain import Chain, persistent_chain
from tests.oracles.conftest import small_plant

ROUGH = Friction(0.12, 0.0, 0.10, 2.0)
RADAR = DopplerSensor(0.05, 0.04, 0.1, 0.02)
RUNNER = RollingResistance(1.5, 0.5)


def random_plant(
    *,
    friction: Friction = ROUGH,
    sensor: DopplerSensor = RADAR,
    resistance: RollingResistance = RUNNER,
) -> Plant:
    """One retarder of 8 m, three stages, a cut of two axles."""
    return small_plant(
        zones_m=((0.0, 8.0),),
        force=PressingForce(0.08, 50.0, (1.0, 0.9)),
        friction=friction,
        resistance=resistance,
        sensor=sensor,
        entry=EntrySpeed(4.0, 5.0),
    )


COARSE = Resolution(
    path_step_m=0.5, speed_step_m_s=0.05, transient_substeps=5, friction_nodes=3, path_levels=2, resistance_nodes=1
)


@pytest.fixture(scope="session")
def plant_with() -> Callable[..., Plant]:
    """`random_plant`."""
    return random_plant


@pytest.fixture(scope="session")
def coarse() -> Resolution:
    """19 quanta × 4 modes × 3 scenarios × 2 levels × about 100 speeds."""
    return COARSE


@pytest.fixture(scope="session", params=[Approach(), Approach(2.0, 1, 1)], ids=["entrance", "approach"])
def small(request: pytest.FixtureRequest) -> Callable[[], Chain]:
    """The random plant on the coarse grid; behind a call, as hypothesis prints its arguments."""
    chain = persistent_chain(replace(random_plant(), approach=request.param), COARSE)
    return lambda: chain
