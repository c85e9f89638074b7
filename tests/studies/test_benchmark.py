"""The benchmark counts work as by hand; what compiled code costs follows from listings and dumps."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from plant_models import Friction, Plant, RollingResistance
from scripts.studies.benchmark.by_numpy import sweep_by_numpy
from scripts.studies.benchmark.findings import (
    CACHE_LINE_BYTES,
    SUMS_A_TURN,
    Limit,
    SweepWork,
    filled,
    load_loop,
    multiply_add_loop,
    sweep_work,
)
from scripts.studies.benchmark.kernels.roofline import loads, loads_a_turn, multiply_adds
from scripts.studies.benchmark.study import apart, line_difference, value_difference, vectors_needed
from scripts.studies.in_the_loop.cost_study import CodeSize, dearest_call, missing, size_in, size_program, totals_in
from scripts.studies.timing import Times
from synth.problem.criterion import Criterion
from synth.problem.problem import Aim
from synth.problem.resolution import Resolution
from synth.solver.backward_induction import solve_all
from synth.solver.chain.chain import Chain, persistent_chain
from tests.oracles.conftest import plant_with

__all__ = ["plant_with"]

AIMS = [Aim(1.5, Criterion()), Aim(2.5, Criterion(switching_tolerance_m2_s2=1e-4))]


@pytest.fixture
def chain(plant_with: Callable[..., Plant]) -> Chain:
    """Scenarios of friction and of resistance, two noise levels, three stages."""
    plant = plant_with(
        stages_kpa=(0.0, 200.0, 400.0), friction=Friction(0.12, 0.05, 0.10, 1.5), resistance=RollingResistance(2.0, 0.8)
    )
    return persistent_chain(plant, Resolution(1.0, 0.1, friction_nodes=2, resistance_nodes=2))


def test_numpy_and_kernels_find_the_same_values_and_lines(chain: Chain) -> None:
    swept, exact = sweep_by_numpy(chain, AIMS), solve_all(chain, AIMS, value_type=np.float64)
    assert np.isfinite(swept.lower_m_s).any()
    assert np.isfinite(swept.upper_m_s).any()
    assert value_difference(swept, exact) < 1e-12
    assert line_difference(swept, exact) < 1e-10


def test_a_different_recursion_is_noticed(chain: Chain) -> None:
    """Lines for another target, and a line that is not there."""
    swept, exact = sweep_by_numpy(chain, AIMS[::-1]), solve_all(chain, AIMS, value_type=np.float64)
    assert value_difference(swept, exact) > 1e-3
    assert apart(np.array([1.0, np.inf]), np.array([1.5, np.inf])) == 0.5
    assert apart(np.array([1.0, np.inf]), np.array([1.0, -np.inf])) > 1e300


def test_work_is_counted_as_by_hand(chain: Chain) -> None:
    swept = sweep_by_numpy(chain, AIMS)
    work = sweep_work(chain, swept)
    nodes, points, reach = len(chain.drive_m_s2), len(chain.grid.speed_m_s), len(chain.entry)
    modes, changes = len(chain.actuator.mode_stage), len(chain.landings.end_mode)
    assert work.states == nodes * 4 * modes * 2 * (points - 1)
    most = nodes * changes * 4 * 2 * points * 4
    stalls = np.count_nonzero((chain.landings.travel_m < 0.0).all(axis=2))
    assert stalls > 0
    assert 0.5 * most < swept.landings <= most - stalls * 4 * 2 * 2, "of two levels at least one is possible"
    assert swept.landings <= swept.groups <= 2 * swept.landings
    assert work.transitions == swept.landings + 2 * work.states * (reach - 1)
    assert work.products == 4 * swept.groups + work.states * (6 * (reach - 1) + 2)


def test_vectors_are_rounded_up() -> None:
    assert vectors_needed(SweepWork(1, 1, 5, 1), 3) == 1
    assert vectors_needed(SweepWork(1, 1, 5, 1), 4) == 2


def test_a_limit_scales_with_what_is_needed() -> None:
    limit = Limit("loads", operations=1000, needed=250, times=Times((3.0, 9.0), (2.0, 4.0)))
    assert limit.per_s == 500.0
    assert limit.sweep.wall_s == (0.5, 1.0)


def test_loops_of_the_machine_do_what_they_count() -> None:
    """Ones are loaded: the sum in each lane is the number of loads over all lanes' turns."""
    data, result = filled(1024, 1.0), filled(16, 0.0)
    loads(3, data, result)
    assert result.tolist() == [3.0 * loads_a_turn(1024)] * 16
    assert loads_a_turn(1024) == 56
    assert load_loop(1024).operations % loads_a_turn(1024) == 0


def test_chains_of_products_end_at_their_fixed_point() -> None:
    """x·½ + ½ tends to 1, whatever it begins with: twelve chains sum up to twelve."""
    result = filled(16, 0.0)
    multiply_adds(100, filled(16, 0.5), result)
    assert result.tolist() == [12.0] * 16
    assert multiply_add_loop().operations % SUMS_A_TURN == 0


def test_loads_do_not_straddle_two_cache_lines() -> None:
    assert {filled(floats, 1.0).ctypes.data % CACHE_LINE_BYTES for floats in (16, 100, 4096)} == {0}


LISTING = """\
retarder_table.o  :
section                    size   addr
.text                       100      0
.text.unlikely               10      0
.data                         4      0
.bss                          2      0
.rodata                    1000      0
.data.rel.ro.local          200      0
.comment                     55      0
Total                      1371
"""


def test_sections_are_summed_by_kind_and_remarks_are_none() -> None:
    assert size_in(LISTING) == CodeSize(code=110, constants=1200, variables=6)


def test_a_cross_compiler_has_a_size_program_of_its_own() -> None:
    assert size_program("gcc") == "size"
    assert size_program("arm-linux-gnueabihf-gcc") == "arm-linux-gnueabihf-size"


def test_a_dump_tells_its_total() -> None:
    assert totals_in("events: Ir\n0 12\n\ntotals: 12\n") == [12]
    assert totals_in("nothing\n") == []


PROGRAM = """\
#include <unistd.h>
__attribute__((noinline)) unsigned work(unsigned turns) {
    unsigned sum = 0;
    for (volatile unsigned i = 0; i < turns; i++) sum += i;
    return sum;
}
int main(void) {
    unsigned char turns;
    unsigned sum = 0;
    while (read(0, &turns, 1) == 1) sum += work(turns);
    return sum == 1;
}
"""


@pytest.mark.skipif(bool(missing("gcc", "valgrind")), reason="gcc and valgrind are not installed")
def test_the_dearest_call_is_the_one_that_turns_most(tmp_path: Path) -> None:
    """A loop's instructions grow in proportion with its turns, whatever the order of the calls."""
    source, program = tmp_path / "work.c", tmp_path / "work"
    source.write_text(PROGRAM)
    subprocess.run(["gcc", "-O1", str(source), "-o", str(program)], check=True)

    def cost(*turns: int) -> int:
        return dearest_call((str(program),), "work", bytes(turns), tmp_path)

    ten, twenty = cost(10), cost(20)
    a_turn = (twenty - ten) / 10
    assert 3 <= a_turn <= 10
    assert cost(10, 20, 1) == twenty
    assert cost(30) == twenty + 10 * a_turn
