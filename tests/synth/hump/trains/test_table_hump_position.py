"""A position of exported tables: each cut goes through it as through the closed loop of its class."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from plant_models import PlantError
from plant_models.library.catalogue import load_car, load_weight_categories
from plant_models.stage_regulator import FullBrake
from synth.hump.rolling.hump_position import Arrivals
from synth.hump.rolling.table_hump_position import ClassChoice, Looped, TableHumpPosition
from synth.retarder.table_class import TableClass
from synth.simulation.closed_loop import simulate, trace
from synth.simulation.random_passes import RandomPasses, keyed_passes
from tests.synth.hump.trains.coarse_book import coarse_classes, coming, estimating

CATEGORIES = load_weight_categories()
N = 300


@pytest.fixture(scope="module")
def classes() -> tuple[TableClass, ...]:
    """Single light gondolas, then pairs; targets 1.5, 2 and 3 m/s."""
    return coarse_classes()


@pytest.fixture(scope="module")
def position(classes: tuple[TableClass, ...]) -> TableHumpPosition:
    return TableHumpPosition(ClassChoice(classes, CATEGORIES))


def passes_of(of_class: TableClass, n: int = N) -> RandomPasses:
    """The passes that `coming` cuts have."""
    path, keys = of_class.loops[0].path, (np.arange(n), np.full(n, 3), np.full(n, 2))
    return keyed_passes(11, keys, keys[:2], len(path.gravity_m_s2) - path.approach_cells)


def as_drawn(of_class: TableClass, commanded_m_s: float, n: int = N) -> Arrivals:
    """Cuts with entry speed and resistance as the closed loop alone draws them for the class."""
    passes = passes_of(of_class, n)
    entry = of_class.plant.entry.speed_m_s(passes.entry_u)
    resistance = of_class.loops[0].resistance_n_kn(passes.resistance_u)
    return coming(of_class, entry, resistance, np.full(n, commanded_m_s))


@pytest.mark.parametrize("with_estimator", [False, True])
@pytest.mark.parametrize("place", [0, 1])
def test_at_a_target_it_is_the_closed_loop(classes: tuple[TableClass, ...], with_estimator: bool, place: int) -> None:
    """What `validate` runs, on equal passes: only rounding of the resistance lies between."""
    of_class = estimating(classes[place]) if with_estimator else classes[place]
    position = TableHumpPosition(ClassChoice((of_class,), CATEGORIES))
    for target, controller in zip(of_class.targets_m_s, of_class.controllers, strict=True):
        passed = position.passed(as_drawn(of_class, target))
        sample = simulate(of_class.plant, controller, passes_of(of_class))
        same = np.abs(passed.exit_m_s - sample.exit_speed_m_s) < 1e-9
        assert same.mean() > 0.99, "a relay may decide otherwise for a rounding"
        assert (passed.switchings == sample.switchings)[same].all()
        assert 0.01 < np.abs(passed.exit_m_s - target).mean() < 0.5


def test_times_begin_at_the_entrance(classes: tuple[TableClass, ...], position: TableHumpPosition) -> None:
    of_class = classes[0]
    passed = position.passed(as_drawn(of_class, 2.0))
    for i in range(20):
        seen = trace(of_class.plant, of_class.controllers[1], passes_of(of_class), i)
        assert seen.path_m[0] == -of_class.plant.approach.length_m < 0.0
        entrance_s = np.interp(0.0, seen.path_m, seen.time_s)
        assert passed.time_s[i] == pytest.approx(seen.time_s[-1] - entrance_s, abs=1e-3)


def mixed_cuts(classes: tuple[TableClass, ...], n: int = N) -> Arrivals:
    """Cuts of both classes, of 3 and 5 cars, and all commands between 1 and 4 m/s."""
    rng = np.random.default_rng(4)
    came = as_drawn(classes[0], 2.0, n)
    cars = rng.choice((1, 2, 3, 5), n)
    return replace(
        came,
        axles=4 * cars,
        mass_t=25.0 * cars,
        path_m=came.path_m + 13.92 * (cars - 1),
        commanded_m_s=rng.uniform(1.0, 4.0, n),
    )


def test_a_cut_passes_the_same_whoever_is_beside_it(
    classes: tuple[TableClass, ...], position: TableHumpPosition
) -> None:
    came = mixed_cuts(classes)
    whole = position.passed(came)
    order = np.random.default_rng(0).permutation(N)
    for part in (order[:1], order[1:8], order[8:]):
        some = position.passed(came.chosen(part))
        for name in ("exit_m_s", "time_s", "switchings"):
            assert (getattr(some, name) == getattr(whole, name)[part]).all()


def test_between_targets_it_is_linear_and_beyond_the_last_it_is_that(
    classes: tuple[TableClass, ...], position: TableHumpPosition
) -> None:
    came = as_drawn(classes[1], 0.0)
    at = {v: position.passed(replace(came, commanded_m_s=np.full(N, v))) for v in (0.7, 1.5, 1.7, 2.0, 3.0, 9.0)}
    np.testing.assert_allclose(at[1.7].exit_m_s, 0.6 * at[1.5].exit_m_s + 0.4 * at[2.0].exit_m_s, atol=1e-12)
    assert (at[1.7].switchings == at[1.5].switchings).all()
    assert (at[0.7].exit_m_s == at[1.5].exit_m_s).all()
    assert (at[9.0].exit_m_s == at[3.0].exit_m_s).all()
    between = (at[1.7].time_s - at[2.0].time_s) / (at[1.5].time_s - at[2.0].time_s)
    assert np.median(between) == pytest.approx(0.6, abs=0.01)


def test_beside_a_pass_that_stops_the_nearer_target_alone_counts() -> None:
    looped = Looped(
        np.array([[0.0, 0.0, 1.5], [2.0, 2.1, 2.2]]),
        np.array([[9.0, 9.0, 7.0], [6.0, 6.0, 5.0]]),
        np.array([[True, True, False], [False, False, False]]),
        np.array([[3, 3, 3], [4, 4, 4]]),
    )
    passed = looped.between(np.array([0.4, 0.6, 0.5]))
    np.testing.assert_allclose(passed.exit_m_s, [0.0, 2.1, 1.85])
    np.testing.assert_allclose(passed.time_s, [9.0, 6.0, 6.0])
    assert passed.switchings.tolist() == [3, 4, 3]


def test_a_cut_that_nothing_brakes_rolls_through(classes: tuple[TableClass, ...], position: TableHumpPosition) -> None:
    """Slower than the highest target all the way, singles and five cars, whatever the grade of the hump."""
    came = mixed_cuts(classes)
    for grade_m_s2 in (-0.01, 0.02):
        unbraked = np.sqrt(2.2**2 + 2.0 * grade_m_s2 * came.path_m)
        slow = replace(came, entry_m_s=np.full(N, 2.2), unbraked_exit_m_s=unbraked, commanded_m_s=np.full(N, 3.0))
        passed = position.passed(slow)
        free = passed.switchings == 0
        assert free.mean() > 0.5
        np.testing.assert_allclose(passed.exit_m_s[free], unbraked[free], atol=1e-9)
        np.testing.assert_allclose(passed.time_s[free], 2.0 * came.path_m[free] / (2.2 + unbraked[free]), rtol=1e-9)
        assert (passed.exit_m_s <= unbraked).all()


def test_the_whole_brake_has_the_work_of_the_cut_itself(
    classes: tuple[TableClass, ...], position: TableHumpPosition
) -> None:
    """Cuts far too heavy for the top stage, also of five cars where the book ends with two: energy by their own axles.

    Over 60 to 80 cuts each, η along the path averages out to half a per cent.
    """
    came = mixed_cuts(classes)
    heavy = replace(
        came, mass_t=4.0 * came.mass_t, entry_m_s=np.full(N, 4.5), unbraked_exit_m_s=np.full(N, 4.5),
        commanded_m_s=np.full(N, 1.5),
    )  # fmt: skip
    plant = classes[0].plant
    factor = plant.friction.cut_factor(passes_of(classes[0]).cut_z, plant.friction_cv)
    head = FullBrake(plant.position, load_car("gondola-4").car).head_m(heavy.mass_t, heavy.axles, np.full(N, 2))
    exit_m_s = position.passed(heavy).exit_m_s
    taken = (4.5**2 - exit_m_s**2) / (2.0 * heavy.reduced_gravity_m_s2)
    for axles in (4, 8, 12, 20):
        of_full = (taken / (head * factor))[(heavy.axles == axles) & (exit_m_s > 2.0)]
        assert len(of_full) > 30
        assert np.median(of_full) == pytest.approx(0.995, abs=0.02)


def test_friction_is_kept_in_all_positions_or_drawn_anew(classes: tuple[TableClass, ...]) -> None:
    """Cuts that take the whole brake: their exit tells the friction."""
    came = as_drawn(classes[0], 1.5, 2000)
    heavy = replace(came, mass_t=4.0 * came.mass_t, entry_m_s=np.full(2000, 4.5), unbraked_exit_m_s=np.full(2000, 4.5))
    for anew, low, high in ((False, 0.8, 1.0), (True, -0.09, 0.09)):
        position = TableHumpPosition(ClassChoice(classes, CATEGORIES), friction_anew=anew)
        exits = [position.passed(replace(heavy, position=p)).exit_m_s for p in (1, 2)]
        assert low < np.corrcoef(exits[0], exits[1])[0, 1] < high


def test_a_cut_that_stops_unbraked_stays(classes: tuple[TableClass, ...], position: TableHumpPosition) -> None:
    passed = position.passed(replace(as_drawn(classes[0], 3.0), unbraked_exit_m_s=np.zeros(N)))
    assert (passed.exit_m_s == 0.0).all()
    assert np.isinf(passed.time_s).all()


def test_the_nearest_class_stands_for_a_cut(classes: tuple[TableClass, ...]) -> None:
    single, pair = classes
    heavier = replace(single, plant=replace(single.plant, cut=replace(single.plant.cut, mass_t=28.0)))
    choice = ClassChoice((pair, single, heavier), CATEGORIES)
    came = as_drawn(single, 2.0, 6)
    kinds = replace(came, axles=np.array([4, 4, 6, 6, 8, 20]), mass_t=np.array([22.0, 27.0, 37.5, 41.0, 55.0, 130.0]))
    assert choice.of(kinds).tolist() == [1, 2, 1, 2, 0, 0]


@pytest.mark.parametrize(
    ("category", "axles", "words"),
    [(0, 40, "none for cuts of category Л .L. with 40 axles"), (4, 4, "none for cuts of category Т .T. with 4 axles")],
)
def test_a_cut_without_a_class_is_named(
    classes: tuple[TableClass, ...], position: TableHumpPosition, category: int, axles: int, words: str
) -> None:
    came = as_drawn(classes[0], 2.0, 3)
    odd = replace(came, category=np.array([0, 0, category]), axles=np.array([4, 4, axles]))
    with pytest.raises(PlantError, match=words):
        position.passed(odd)
