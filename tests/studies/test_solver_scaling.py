"""The study of the solver's cost: slopes of known laws, differences of two solutions, bytes on several threads."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from plant_models import Plant
from synth.problem.aim import Aim
from synth.problem.criterion import Criterion
from synth.problem.resolution import Resolution
from synth.solver.backward_induction import solve, solve_all
from synth.solver.chain.chain import Chain, persistent_chain
from synth.solver.switching_lines import SwitchingLines
from synth.studies.solver_scaling.findings import TARGETS, Growth
from synth.studies.solver_scaling.study import NO_LINE, growth, on_nodes
from synth.studies.solver_scaling.value_types import apart, changes
from synth.studies.solver_scaling.whole_book import digest, solved_on
from tests.oracles.conftest import plant_with

__all__ = ["plant_with"]

AIM = Aim(2.0, Criterion())


@pytest.fixture
def chain(plant_with: Callable[..., Plant]) -> Chain:
    return persistent_chain(
        plant_with(stages_kpa=(0.0, 200.0, 400.0)), Resolution(1.0, 0.1, friction_nodes=2, resistance_nodes=1)
    )


def test_the_slope_of_a_power_is_its_exponent() -> None:
    assert Growth("nodes", (1, 2, 4, 8), (3.0, 12.0, 48.0, 192.0)).slope == pytest.approx(2.0)
    assert Growth("nodes", (1, 2, 4), (3.0, 6.0, 12.0)).note == "slope 1.00"


def test_an_extra_target_is_told_over_the_first() -> None:
    """0.1 for the first, 0.006 for each of seven more."""
    found = Growth(TARGETS, (1, 8), (0.1, 0.1 + 7 * 0.006))
    assert found.extra_over_first == pytest.approx(0.06)
    assert found.note == "an extra one costs 6 % of the first"


def test_sizes_keep_their_order_and_the_least_time() -> None:
    found = growth("loops", (1, 200), [lambda: sum(range(10_000)), lambda: sum(range(2_000_000))], 3)
    assert found.size == (1, 200)
    assert found.processor_s[0] < found.processor_s[1]


def test_single_and_double_precision_differ_by_roundings_and_other_aims_by_more(chain: Chain) -> None:
    single, double = (solve(chain, AIM, value_type=kind) for kind in (np.float32, np.float64))
    near = changes(chain, single, double, degree=3)
    assert 0.0 < near.values < 1e-5
    assert near.cost < 1e-4
    other = solve(chain, Aim(2.5, Criterion()), value_type=np.float64)
    far = changes(chain, other, double, degree=3)
    assert far.values > 1e-2
    assert far.cost > 10 * near.cost
    assert far.lines_m_s > 0.1


def test_lines_are_apart_where_both_are() -> None:
    assert apart(np.array([1.0, np.inf, 2.0]), np.array([1.5, 3.0, 2.1])) == 0.5
    assert apart(np.array([np.inf]), np.array([1.0])) == 0.0


def test_a_digest_does_not_see_threads_but_sees_another_aim(chain: Chain) -> None:
    aims = [AIM, Aim(2.5, Criterion())]
    digests = {digest(solved_on(threads, [chain, chain, chain], aims)) for threads in (1, 2)}
    assert len(digests) == 1
    assert digest(solve_all(chain, aims)) != digest(solve_all(chain, aims[::-1]))


def test_lines_on_other_nodes_are_interpolated_and_never_infinite(chain: Chain) -> None:
    path = np.array([0.0, float(chain.grid.path_m[-1])])
    lines = SwitchingLines(path, np.array([[1.0, 3.0], [-np.inf, -np.inf]]), np.array([[2.0, 4.0], [np.inf, np.inf]]))
    found = on_nodes(lines, chain)
    middle = len(chain.grid.path_m) // 2
    share = chain.grid.path_m[middle] / chain.grid.path_m[-1]
    assert found.lower_m_s[0, middle] == pytest.approx(1.0 + 2.0 * share)
    assert found.upper_m_s[1].tolist() == [NO_LINE] * len(chain.grid.path_m)
