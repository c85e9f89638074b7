"""The checker's estimator: bit for bit what a controller computes, of the right plant, and faults in it are found."""

from __future__ import annotations

import dataclasses
import json
import math
from random import Random

import numpy as np
import pytest

from synth.book.estimation.estimator_design import estimator_of
from synth.checker.claims import Honesty
from synth.checker.estimator import Observer
from synth.checker.estimator import estimator_of as read_estimator
from synth.checker.estimator_sense import estimator_faults, work_of
from synth.checker.float32 import bits
from synth.checker.plant import Plant, plant_of
from synth.configuration.config_file import parse_config
from tests.checker.planted_fault import Document
from tuning_tables.estimator import Estimator, begin, observe

HONESTY = Honesty(0.8, 1.25)


def section_of(estimator: Estimator) -> Document:
    """The estimator as its JSON document has it."""
    fields = [field.name for field in dataclasses.fields(estimator) if field.init]
    values = {name: getattr(estimator, name) for name in fields}
    return {name: list(value) if isinstance(value, tuple) else value for name, value in values.items()}


def random_estimator(chance: Random) -> Estimator:
    """Any that a table may hold: steep, flat, absurd work, breaks a millimetre to metres apart, noise over decades."""
    absurd = chance.choice([-2.0, -2.0, -2.0, 3.0])
    steps = [10.0 ** chance.uniform(-2.9, 1.0) for _ in range(chance.choice([1, 3, 15, 60]))]
    places = np.cumsum([chance.choice([0.0, -3.0, 2.0]), *steps])
    slopes = [chance.choice([0.0, 10.0 ** chance.choice([-5.0, -3.0, -2.0, absurd])]) for _ in steps]
    brake = np.cumsum([0.0, *(a * b for a, b in zip(slopes, steps, strict=True))])
    drive = np.cumsum([0.0, *(chance.uniform(-0.3, 0.3) * 10.0 ** max(0.0, absurd) * step for step in steps)])
    rows = (tuple(row.tolist()) for row in (places, drive, brake))
    numbers = (10.0 ** chance.uniform(-4.0, 0.0), chance.random(), chance.random(), 10.0 ** chance.uniform(-3.0, 2.0))
    return Estimator(*numbers, chance.uniform(0.0, 100.0), *rows)


def random_samples(chance: Random, length_m: float) -> list[tuple[float, float, float]]:
    """Path, speed and overpressure of a cut, some of them impossible."""
    odd = [math.nan, math.inf, -math.inf, -0.0, -1.0, 5e-324, 1e-40, 39.99, 40.0, 40.01, 2000.5, 1e39, 1e300]
    wild, s, v, samples = chance.choice([0.0, 0.05, 0.4]), chance.choice([0.0, -2.0]), chance.uniform(0.0, 9.0), []
    for _ in range(100):
        sample = (s, v + chance.gauss(0.0, 0.1), chance.uniform(0.0, 600.0))
        path, speed, kpa = (chance.choice(odd) if chance.random() < wild else x for x in sample)
        samples.append((path, speed, kpa))
        s, v = s + chance.choice([0.0, length_m / 90.0, 1e-4, -0.1, 19.0]), max(0.0, v + chance.gauss(0.0, 0.3))
    return samples


def word_of(x: float) -> int | None:
    """The bits of a number, one word for all NaN."""
    return None if math.isnan(x) else bits(x)


def test_it_is_that_of_the_controller_bit_for_bit() -> None:
    """Estimate and all eight numbers of the state, after each of 30 000 samples of 300 cuts."""
    chance, clamped = Random(7), 0
    for _ in range(300):
        estimator = random_estimator(chance)
        own, state = Observer(read_estimator(section_of(estimator))), begin()
        for s, v, p in random_samples(chance, estimator.s_m[-1]):
            with np.errstate(all="ignore"):
                expected = observe(estimator.parameters, estimator.work, state, s, v, p)
            numbers = [own.observe(s, v, p), float(own.begun), own.s, own.v, own.factor]
            numbers += [own.speed_variance, own.covariance, own.factor_variance, own.unseen]
            wanted = [np.float32(expected), *state]
            assert [word_of(x) for x in numbers] == [word_of(float(x)) for x in wanted]
            clamped += own.factor in (float(np.float32(0.3)), float(np.float32(1.9)))
    assert clamped > 100  # the samples are wild enough to reach the limits


def test_a_new_cut_begins_anew() -> None:
    observer = Observer(read_estimator(section_of(random_estimator(Random(1)))))
    samples = random_samples(Random(2), 10.0)
    first = [observer.observe(*sample) for sample in samples]
    observer.begin()
    assert [observer.observe(*sample) for sample in samples] == first


CONFIGS = (
    "",
    'retarder.name = "rnz-2m-park"\nsensor.noise_m_s = 0.0\nsensor.resolution_m_s = 0.0\n',
    'retarder.name = "kv-3-bunch"\ntrack.grade_permille = [[0.0, 12.0], [9.5, 3.0]]\nfriction.axle_cv = 0.2\n'
    '[[cut]]\ncar = "gondola-4"\nmass_t = 180\ncars = 3\n[[cut]]\ncar = "gondola-4"\nmass_t = 1000\ncars = 40\n',
)
"""Every law of force, several grades, spread per axle, no sensor noise, more breaks than a table takes."""


def plants_of(config: str) -> list[tuple[Estimator, Plant]]:
    """The production estimator, and the checker's own plant, of each cut."""
    resolved = parse_config(config, "x.toml")
    document = json.loads(resolved.canonical_json())
    production = [plant for _, plant in resolved.plants()]
    own = [plant_of(document, cut) for cut in document["cut"]]
    return [(estimator_of(one), other) for one, other in zip(production, own, strict=True)]


@pytest.mark.parametrize("config", CONFIGS)
def test_the_production_estimator_is_that_of_the_plant(config: str) -> None:
    for estimator, plant in plants_of(config):
        work, section = work_of(plant), section_of(estimator)
        assert list(estimator_faults(read_estimator(section), plant, wanted=True)) == []
        if len(estimator.s_m) < 256:
            for name in ("s_m", "drive_m2_s2", "brake_m2_s2_per_kpa"):
                assert section[name] == pytest.approx(getattr(work, name), rel=1e-12, abs=1e-12)


def test_work_is_the_integral_along_the_path() -> None:
    """Against sums over 20 000 cells: N(s), its slope and the grades change on the way."""
    ((_, plant), _) = plants_of(CONFIGS[2])
    work, count = work_of(plant), 20_000
    assert plant.approach_m == 4.0
    step = (plant.exit_m + plant.approach_m) / count
    middles = [(i + 0.5) * step - plant.approach_m for i in range(count)]
    braked = [plant.braked(s) for s in middles]
    weight = 9.81 * plant.mass_t * 1e-3
    drive = sum(weight * (plant.grade_permille(s) - plant.resistance_n_kn[0]) for s in middles) * step
    brake = sum(n * plant.slope_kn_per_kpa[n - 1] for n in braked if n) * step
    assert work.drive_m2_s2[-1] * plant.inertia_t == pytest.approx(drive, rel=1e-3)
    assert work.brake_m2_s2_per_kpa[-1] * plant.inertia_t == pytest.approx(brake, rel=1e-3)
    assert work.mean_braked == pytest.approx(sum(braked) / sum(n > 0 for n in braked), rel=1e-3)
    assert len(set(braked)) > 4
