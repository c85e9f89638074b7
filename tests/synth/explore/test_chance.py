"""What the page draws follows the laws of the plant, and its figures have the intervals that they say."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy import stats

from plant_models import HistogramEntrySpeed, NormalEntrySpeed, Plant
from synth.retarder.explore.plant_data import entry_quantiles_m_s, plant_data
from synth.simulation.closed_loop import TableController, close_loop
from synth.simulation.random_passes import random_passes
from tests.in_javascript import needs_javascript
from tests.synth.explore.braked import LIMITS_T, STAGES, estimating_table, plant_of, told_by
from tuning_tables.controller_code.js_rules import js_rules

CUTS = 4000
LEAST_P = 1e-3
MASK = 2**32 - 1

DRAWING = """
tell(Array.from({ length: given.count }, (_, place) => Draws.cut(given.plant, given.seed, place)).map((cut) =>
  ({ ...cut, pathZ: [...cut.pathZ], noiseZ: [...cut.noiseZ] })));
"""


def drawn(plant: Plant, count: int, seed: int = 11) -> list[dict[str, Any]]:
    """Cuts as the page draws them; null is a lost reading."""
    found: list[dict[str, Any]] = told_by(
        None, ("draws.js",), DRAWING, {"plant": plant_data(plant, LIMITS_T, STAGES), "count": count, "seed": seed}
    )
    return found


@needs_javascript
def test_cuts_follow_the_laws_of_the_plant() -> None:
    plant = plant_of(estimating_table())
    cuts = drawn(plant, CUTS)
    law = plant.resistance
    factor, resistance, entry = (np.array([cut[key] for cut in cuts]) for key in ("factor", "resistance", "entryMS"))
    assert stats.kstest(factor, "norm", args=(1.0, plant.friction_cv)).pvalue > LEAST_P
    assert stats.kstest(resistance, "gamma", args=(law.shape, 0.0, law.scale_n_per_kn)).pvalue > LEAST_P
    assert stats.kstest(entry, "uniform", args=(5.0, 1.5)).pvalue > LEAST_P
    assert stats.kstest([cut["phase"] for cut in cuts], "uniform").pvalue > LEAST_P
    for key in ("pathZ", "noiseZ"):
        assert stats.kstest(np.array([cut[key][:3] for cut in cuts]).ravel(), "norm").pvalue > LEAST_P
    numbers = np.column_stack([factor, resistance, entry, [cut["noiseZ"][0] for cut in cuts]])
    assert np.abs(np.corrcoef(numbers.T) - np.eye(4)).max() < 4.0 / np.sqrt(CUTS)


@needs_javascript
def test_a_wide_law_of_the_resistance_has_its_gamma_shape_below_1() -> None:
    plant = plant_of(estimating_table())
    plant = replace(plant, resistance=replace(plant.resistance, std_n_per_kn=2.5))
    law = plant.resistance
    assert law.shape < 1.0
    found = [cut["resistance"] for cut in drawn(plant, CUTS)]
    assert stats.kstest(found, "gamma", args=(law.shape, 0.0, law.scale_n_per_kn)).pvalue > LEAST_P


@needs_javascript
def test_lost_readings_have_their_share_and_come_in_bursts() -> None:
    plant = plant_of(estimating_table())
    plant = replace(plant, sensor=replace(plant.sensor, missed_share=0.2, missed_burst_s=0.6))
    lost = np.array([[z is None for z in cut["noiseZ"]] for cut in drawn(plant, 500)])
    assert lost.mean() == pytest.approx(0.2, abs=0.01)
    begun = lost[:, 1:] & ~lost[:, :-1]
    assert lost.sum() / begun.sum() == pytest.approx(plant.sensor.missed_readings, rel=0.06)


@needs_javascript
def test_a_pass_has_the_same_numbers_whatever_the_length_of_the_path() -> None:
    plant = plant_of(estimating_table())
    one, same = drawn(plant, 2), drawn(plant, 2)
    (longer, _) = drawn(replace(plant, friction=replace(plant.friction, correlation_length_m=0.5)), 2)
    (other, _) = drawn(plant, 2, seed=12)
    assert one == same
    assert longer["noiseZ"] == one[0]["noiseZ"]
    assert longer["pathZ"][: len(one[0]["pathZ"])] == one[0]["pathZ"]
    assert other["noiseZ"] != one[0]["noiseZ"]


def sfc32(seed: int, stream: int, purpose: int, count: int) -> list[int]:
    """The generator once more, in whole numbers of any size."""
    a, b, c, counter, found = seed, stream, purpose, 1, []
    for _ in range(16 + count):
        word = (a + b + counter) & MASK
        a, b = b ^ (b >> 9), (c + (c << 3)) & MASK
        c = (((c << 21) | (c >> 11)) + word) & MASK
        counter += 1
        found.append(word)
    return found[16:]


@needs_javascript
def test_the_generator_is_sfc32() -> None:
    plant = plant_of(estimating_table())
    (cut,) = drawn(plant, 1, seed=77)
    words = [(word + 0.5) / 2**32 for word in sfc32(77, 0, 0, 4)]
    assert cut["factor"] == pytest.approx(
        1.0 + plant.friction_cv * np.sqrt(-2.0 * np.log(words[0])) * np.cos(2.0 * np.pi * words[1]), rel=1e-12
    )
    assert cut["phase"] == words[3]


@pytest.mark.parametrize(
    "law",
    [
        NormalEntrySpeed(4.0, 7.0, 5.6, 0.4),
        HistogramEntrySpeed((4.0, 4.5, 5.0, 6.0, 6.5), (2.0, 0.0, 5.0, 1.0)),
    ],
)
def test_quantiles_of_the_entry_law_stand_for_it(law: NormalEntrySpeed | HistogramEntrySpeed) -> None:
    u = (np.arange(20_000) + 0.5) / 20_000
    values = entry_quantiles_m_s(law)
    read = np.interp(u, np.linspace(0.0, 1.0, len(values)), values)
    assert np.mean(np.abs(read - law.speed_m_s(u))) < 2e-3


QUANTILES = """
const exits = (errors) => errors.map((error) => ({ exitMS: error, stalled: false, commands: 0, time: 0 }));
tell(given.samples.map((errors) => Figures.of(exits(errors), 0, 0.3).within));
"""


@needs_javascript
@pytest.mark.parametrize("count", [100, 1000])
def test_the_interval_of_a_quantile_holds_the_truth_in_95_of_100_samples(count: int) -> None:
    samples = np.random.default_rng(5).standard_t(3.0, (1000, count))
    truth = stats.t(3.0).ppf(0.975)
    values = np.array(told_by(None, ("figures.js",), QUANTILES, {"samples": samples.tolist()}))
    ordered = np.sort(np.abs(samples), axis=1)
    assert (values[:, 0] == ordered[:, count * 95 // 100 - 1]).all()
    held = (values[:, 1] <= truth) & (truth <= values[:, 2])
    assert 0.945 < held.mean() < 0.99


FIGURES = "tell(Figures.of(given.exits, given.target, 0.3));"


@needs_javascript
def test_figures_have_the_intervals_of_student_and_wilson() -> None:
    rng = np.random.default_rng(3)
    speeds = 3.0 + 0.2 * rng.standard_normal(100)
    speeds[:2] = 0.0
    exits = [
        {"exitMS": v, "stalled": bool(v == 0.0), "commands": int(k), "time": 10.0 + v}
        for v, k in zip(speeds, rng.poisson(6.0, 100), strict=True)
    ]
    found = told_by(None, ("figures.js",), FIGURES, {"exits": exits, "target": 3.0})
    error = speeds - 3.0
    mean = stats.ttest_1samp(error, 0.0).confidence_interval(0.95)
    assert found["n"] == 100
    assert found["bias"] == pytest.approx([error.mean(), mean.low, mean.high], abs=1e-5)
    assert found["rms"] == pytest.approx(np.sqrt(np.mean(error**2)), abs=1e-12)
    for key, count in (("overspeed", int((error > 0.3).sum())), ("stalled", 2)):
        share = stats.binomtest(count, 100).proportion_ci(method="wilson")
        assert found[key] == pytest.approx([count / 100, share.low, share.high], abs=1e-12)


EXITS = """
const { plant, table: values, count } = given, table = Rule.table(values);
const setting = { massT: plant.mass_t, noiseMS: plant.sensor.noise_m_s, drive: Drive.drive(plant, false, 1) };
const regulator = Laws.byTable(plant, table);
tell(Array.from({ length: count }, (_, place) => Passes.run(plant, regulator, setting, Draws.cut(plant, 5, place))));
"""


@needs_javascript
def test_many_cuts_leave_as_those_of_the_closed_loop() -> None:
    table = estimating_table()
    plant, rules = plant_of(table), js_rules([table])
    given = {"plant": plant_data(plant, LIMITS_T, STAGES), "table": rules.tables[0], "count": CUTS}
    found = told_by(rules, ("motion.js", "drive.js", "laws.js", "passes.js", "draws.js"), EXITS, given)
    loop = close_loop(plant, STAGES)
    sample = loop.run(TableController(table), loop.draws(random_passes(1, 0, CUTS, loop.cells)))
    for key, theirs in (
        ("exitMS", sample.exit_speed_m_s), ("commands", sample.switchings), ("time", sample.transit_time_s),
    ):  # fmt: skip
        mine = np.array([float(each[key]) for each in found])
        assert stats.ks_2samp(mine, theirs.astype(np.float64)).pvalue > LEAST_P, key
