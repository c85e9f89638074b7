"""A position of regulators: each cut goes through the closed loop as through a plant of its own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from plant_models import Plant, PlantError
from synth.aim.position_models import SampledExits
from synth.aim.scene import AimScene
from synth.aim.table_position import TablePosition, entry_speeds_m_s
from synth.retarder.comparison.baselines import energy_rule
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.table_class import TableClass
from synth.simulation.closed_loop import close_loop
from synth.simulation.random_passes import random_passes
from tests.synth.aim.conftest import HEAVY, LIGHT

TARGETS = (1.5, 2.0, 3.0)
PARK = """\
position.name = "rnz-2m-park"
entry.low_m_s = 3.2
entry.high_m_s = 5.0
targets.exit_speeds_m_s = [1.5]
cut = [{ car = "gondola-4", mass_t = 23 }, { car = "gondola-4", mass_t = 27 }]
"""


def regulated(plant: Plant) -> TableClass:
    """The energy rule at every target."""
    loop = close_loop(plant, plant.top_stage + 1)
    rules = tuple(energy_rule(loop, target, plant.top_stage, 0.9, -0.03, 0.4, 0.1) for target in TARGETS)
    return TableClass(plant, TARGETS, rules)


@pytest.fixture(scope="module")
def position() -> TablePosition:
    return TablePosition(tuple(regulated(plant) for _, plant in parse_config(PARK, "park.toml").plants()))


def test_each_cut_is_as_in_a_plant_of_its_own(scene: AimScene, position: TablePosition) -> None:
    """The plant is built anew with the mass of the cut; the position scales the work of the brake instead.

    A relay may decide otherwise at one sample for a difference of a millimetre a second: so not every cut is as near.
    """
    cuts = scene.draw(LIGHT, 1, 5, 0, 40)
    exits, entry = position.exits(cuts).exits_m_s, entry_speeds_m_s(cuts)
    passes, masses = random_passes(5, 0, 40), cuts.rolling.cuts.cut_mass_t
    apart = np.empty((40, len(TARGETS)))
    for i in range(40):
        of_class = position.classes[0 if masses[i] < 25.0 else 1]
        own = replace(of_class.plant, cut=replace(of_class.plant.cut, mass_t=float(masses[i])))
        for k, target in enumerate(TARGETS):
            loop = close_loop(own, own.top_stage + 1)
            resistance = cuts.resistance_at(0.5 * (entry[i : i + 1] + target), np.array([i]))
            drawn = loop.draws(passes.part(i, i + 1))._replace(
                resistance_n_kn=resistance, entry_m_s=own.start_speed_m_s(entry[i : i + 1], resistance)
            )
            alone = loop.run(of_class.controllers[k], drawn).exit_speed_m_s[0]
            apart[i, k] = exits[i, k] - alone
    assert np.median(np.abs(apart)) < 0.001
    assert np.quantile(np.abs(apart), 0.85) < 0.02
    assert abs(apart.mean()) < 0.005


def test_exits_of_a_cut_do_not_depend_on_the_others(scene: AimScene, position: TablePosition) -> None:
    together = position.exits(scene.draw(LIGHT, 1, 5, 0, 2500)).exits_m_s
    alone = position.exits(scene.draw(LIGHT, 1, 5, 2100, 30)).exits_m_s
    assert (together[2100:2130] == alone).all()


def test_cuts_without_a_class_are_named(scene: AimScene, position: TablePosition) -> None:
    for category, cars in ((HEAVY, 1), (LIGHT, 2)):
        with pytest.raises(PlantError, match=f"none for {cars} cars of category {category.name}"):
            position.exits(scene.draw(category, cars, 5, 0, 10))


def test_one_target_is_no_choice(position: TablePosition) -> None:
    first = position.classes[0]
    with pytest.raises(PlantError, match="1 targets; a position that is commanded needs two or more"):
        TableClass(first.plant, (1.5,), first.controllers[:1])


def test_between_two_targets_exits_are_linear_and_thresholds_their_inverse() -> None:
    rng = np.random.default_rng(1)
    commands = np.array([1.0, 1.5, 2.5, 4.0])
    sampled = SampledExits(commands, np.sort(commands + rng.normal(0.0, 0.1, (300, 4)), axis=1))
    asked = rng.uniform(1.0, 4.0, 300)
    expected = [np.interp(v, commands, row) for v, row in zip(asked, sampled.exits_m_s, strict=True)]
    assert sampled.at(asked) == pytest.approx(expected)
    assert sampled.threshold(sampled.at(asked)) == pytest.approx(asked, abs=1e-9)


def test_a_cut_that_no_command_holds_has_no_threshold_and_a_slow_one_none_that_binds() -> None:
    sampled = SampledExits(np.array([1.0, 2.0]), np.array([[3.0, 3.1], [1.0, 1.4]]))
    threshold = sampled.threshold(np.array([2.0, 1.9]))
    assert threshold[0] == -np.inf
    assert threshold[1] == pytest.approx(2.5)


def test_noise_that_lets_an_exit_fall_does_not_lower_the_threshold_after_it() -> None:
    sampled = SampledExits(np.array([1.0, 2.0, 3.0]), np.array([[1.0, 2.2, 2.1]]))
    assert sampled.at(np.array([3.0]))[0] == 2.2
    assert sampled.threshold(np.array([2.15]))[0] < 2.0
