"""The checker's estimator: bit for bit what a controller computes, of the right plant, and faults in it are found."""

from __future__ import annotations

import dataclasses
import json
import math
from collections import Counter
from collections.abc import Iterator
from random import Random

import numpy as np
import pytest

from plant_models import DopplerSensor
from synth.checker.claims import PredictionRatio
from synth.checker.estimator import Observer
from synth.checker.estimator import estimator_of as read_estimator
from synth.checker.estimator_sense import chance_of_equals, estimator_faults, frozen_after, work_of
from synth.checker.float32 import bits
from synth.checker.plant import Plant, plant_of
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.estimation.estimator_design import estimator_of, frozen_readings
from tests.checker.planted_fault import Document
from tuning_tables.estimator import Estimator, begin
from tuning_tables.held_table import lines_apart
from tuning_tables.programs.decide import alarms
from tuning_tables.programs.observe import observe

Sample = tuple[float, float, float]
PREDICTION_RATIO = PredictionRatio(0.8, 1.25)
STATE = (
    "begun", "s", "v", "x", "a", "vv", "vx", "va", "xx", "xa", "aa", "unseen", "reading", "repeated", "believed",
    "doubted",
)  # fmt: skip
"""What the numbers of the controller's state are called in the checker."""


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
    return Estimator(
        10.0 ** chance.uniform(-4.0, 0.0), chance.random(), chance.choice([0.0, 10.0 ** chance.uniform(-4.0, 0.0)]),
        chance.random(), 10.0 ** chance.uniform(-3.0, 2.0), chance.choice([1, 2, 5, 1000]), chance.choice([1, 4, 20]),
        10.0 ** chance.uniform(-2.0, 1.0), chance.uniform(0.0, 0.8), chance.uniform(0.0, 100.0), *rows,
    )  # fmt: skip


def likely_estimator(chance: Random) -> Estimator:
    """One for a heavy cut on 20 m, its numbers near those of a plant."""
    places = (-4.0, 0.0, 5.0, 12.0, 20.0)
    return Estimator(
        chance.uniform(0.01, 0.1), 0.15, chance.choice([0.0, 0.006, 0.05]), 0.1, 2.0, chance.choice([1, 3, 7]),
        chance.choice([3, 8, 20]), chance.choice([0.05, 0.2]), chance.choice([0.05, 0.5]), 50.0,
        places, (0.0, 0.3, 0.6, 0.9, 1.5), (0.0, 0.0, 0.006, 0.02, 0.03),
    )  # fmt: skip


def random_samples(chance: Random, length_m: float) -> list[Sample]:
    """Path, speed and overpressure of a cut, some of them impossible."""
    odd = [math.nan, math.inf, -math.inf, -0.0, -1.0, 5e-324, 1e-40, 39.99, 40.0, 40.01, 2000.5, 1e39, 1e300]
    wild, s, v, samples = chance.choice([0.0, 0.05, 0.4]), chance.choice([0.0, -2.0]), chance.uniform(0.0, 9.0), []
    for _ in range(100):
        sample = (s, v + chance.gauss(0.0, 0.1), chance.uniform(0.0, 600.0))
        path, speed, kpa = (chance.choice(odd) if chance.random() < wild else x for x in sample)
        samples.append((path, speed, kpa))
        s, v = s + chance.choice([0.0, length_m / 90.0, 1e-4, -0.1, 19.0]), max(0.0, v + chance.gauss(0.0, 0.3))
    return samples


def faulty_samples(chance: Random, estimator: Estimator) -> list[Sample]:
    """A cut as the estimator knows it, give or take its friction, seen by a sensor that fails in every way.

    Spells of missing, zero and frozen readings, of a speed that is off by so much or by a factor, and single spikes;
    half of the cuts are watched well for the first five samples.
    """
    work, steps = np.array(estimator.work, dtype=np.float64), chance.choice([40, 120])
    factor, speed, s, kpa, v = chance.uniform(0.4, 1.8), chance.uniform(1.5, 7.0), -4.0, 0.0, 0.0
    kind, left, bias, samples = "good", 5 * chance.randint(0, 1), 0.0, []
    for _ in range(steps):
        if left <= 0:
            kind = chance.choice(["good", "good", "missing", "zero", "frozen", "bias", "scale", "spike"])
            left = 1 if kind == "spike" else chance.choice([1, 3, 10, 40])
            bias = chance.choice([-3.0, -0.7, 0.7, 3.0])
        left -= 1
        good = max(0.0, speed + chance.gauss(0.0, estimator.speed_noise_m_s))
        shown = {"missing": math.nan, "zero": 0.0, "frozen": v, "bias": good + bias, "spike": good + bias}
        seen = shown.get(kind, good * (1.3 if kind == "scale" else 1.0))
        v = v if math.isnan(seen) else seen
        samples.append((s, seen, kpa))
        kpa = chance.choice([0.0, 100.0, 300.0])
        ahead = s + 24.0 / steps
        gained, lost = (float(np.interp(ahead, work[0], row) - np.interp(s, work[0], row)) for row in work[1:])
        s, speed = ahead, math.sqrt(max(0.04, speed**2 + 2.0 * (gained - factor * kpa * lost)))
    return samples


def word_of(x: float) -> int | None:
    """The bits of a number, one word for all NaN."""
    return None if math.isnan(x) else bits(x)


def assert_the_same(estimator: Estimator, samples: list[Sample]) -> Iterator[tuple[Observer, int, float]]:
    """Estimate, state and alarms bit for bit after each sample; then the checker's observer, alarms and answer."""
    own, state = Observer(read_estimator(section_of(estimator))), begin()
    for sample in samples:
        with np.errstate(all="ignore"):
            expected = float(np.float32(observe(lines_apart(estimator), state, *sample)))
            alarmed = alarms(lines_apart(estimator), state)
        answer = own.observe(*sample)
        numbers = [answer, *(float(getattr(own, name)) for name in STATE)]
        assert [word_of(x) for x in numbers] == [word_of(float(x)) for x in (expected, *state)]
        assert own.alarms == alarmed
        yield own, alarmed, answer


@pytest.mark.requirement("VERIFY-06")
def test_it_is_that_of_the_controller_bit_for_bit() -> None:
    """After each of 30 000 samples of 300 cuts, many of them impossible, of estimators of every kind."""
    chance, clamped = Random(7), 0
    for _ in range(300):
        estimator = random_estimator(chance)
        for own, _, _ in assert_the_same(estimator, random_samples(chance, estimator.s_m[-1])):
            clamped += own.x in (float(np.float32(0.3)), float(np.float32(1.9))) or abs(own.a) == 0.5
    assert clamped > 100  # the samples are wild enough to reach the limits


def test_it_doubts_what_the_controller_doubts() -> None:
    """Missing, zero, frozen, spiky, shifted readings and long losses: every way of the recursion is gone often."""
    chance, gone = Random(8), Counter[str]()
    for _ in range(300):
        estimator = likely_estimator(chance)
        before = (0.0, 0.0, 0.0)  # believed, doubted, unseen
        for own, alarmed, answer in assert_the_same(estimator, faulty_samples(chance, estimator)):
            anew = own.believed == 1.0 and own.unseen == 0.0 and before[0] > 0.0
            gone["begun anew early"] += anew and before[0] < 3.0
            gone["begun anew late"] += anew and before[0] >= 3.0
            gone["doubt goes on"] += own.doubted > 1.0
            gone["doubt ends"] += before[1] > 0.0 and own.doubted == 0.0 and not anew
            gone["doubt after a loss"] += own.doubted == 1.0 and before[1] == 0.0 and before[2] > 0.0
            gone["frozen"] += own.repeated >= estimator.frozen_readings
            gone["cautious"] += answer < own.v
            gone["stands still for all we know"] += answer == 0.0
            gone.update(f"alarm {bit}" for bit in (1, 2, 4) if alarmed & bit)
            before = own.believed, own.doubted, own.unseen
    assert min(gone.values()) > 30, gone
    assert len(gone) == 11


def test_a_new_cut_begins_anew() -> None:
    observer = Observer(read_estimator(section_of(random_estimator(Random(1)))))
    samples = random_samples(Random(2), 10.0)
    first = [observer.observe(*sample) for sample in samples]
    observer.begin()
    assert [observer.observe(*sample) for sample in samples] == first


CONFIGS = (
    "",
    'position.name = "rnz-2m-park"\nsensor.noise_m_s = 0.0\nsensor.resolution_m_s = 0.0\n',
    'position.name = "kv-3-bunch"\ntrack.grade_permille = [[0.0, 12.0], [9.5, 3.0]]\nfriction.axle_cv = 0.2\n'
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


@pytest.mark.parametrize("noise_m_s", [0.001, 0.02, 0.1, 1.0])
@pytest.mark.parametrize("resolution_m_s", [0.003, 0.05, 0.3])
def test_chance_of_equal_readings(noise_m_s: float, resolution_m_s: float) -> None:
    """Against the closed form of the plant, and against 10 000 pairs of readings within five standard errors."""
    chance = chance_of_equals(noise_m_s, resolution_m_s)
    sensor = DopplerSensor(noise_m_s, resolution_m_s, 0.1, 0.0)
    assert chance == pytest.approx(sensor.repeat_probability, rel=1e-8)
    rng = np.random.default_rng(3)
    speed = rng.random(10_000) * resolution_m_s
    one, other = (np.rint((speed + noise_m_s * rng.standard_normal(10_000)) / resolution_m_s) for _ in range(2))
    assert np.mean(one == other) == pytest.approx(chance, abs=5.0 * math.sqrt(chance * (1.0 - chance) / 10_000))
    count = frozen_after(chance)
    assert chance**count <= 1e-4 or count == 10_000
    assert count == 1 or chance ** (count - 1) > 1e-4
    assert count == frozen_readings(sensor)


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
