"""The closed loop that can freeze its radar and go over to another table, and that tells the alarms of every pass.

It is the kernel of the simulator, the same text with other functions in the place of three of its own: the sensor's,
which remembers its last reading; the estimator's, which runs one for each table, notes the alarms and chooses the
table; the rule's, which takes that table. So the product's kernels know nothing of them, and with one table and
without fault every pass is the simulator's to the last bit.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from threading import Lock
from typing import Any, NamedTuple

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from scripts.studies.regulated_lane import compiled, loop_at_rest
from synth.kernels.compiled_rules import compiled_rule
from synth.kernels.loop import regulator
from synth.kernels.loop.lane_estimator import Observed
from synth.kernels.loop.passes import Draws, Exits
from synth.simulation.closed_loop import (
    ClosedLoop,
    TableController,
    empty_exits,
    empty_trace,
    lane_memory,
    sample_of,
)
from synth.simulation.passes import ExitSample
from tuning_tables.estimator import STATE_SIZE
from tuning_tables.programs.decide import alarms, table_after
from tuning_tables.programs.held import LineTable


class FreezingSensor(NamedTuple):
    """`regulator.Sensor` with the memory of its last reading, (1,)."""

    period_s: float
    noise_m_s: float
    resolution_m_s: float
    last_m_s: Floats


class Together(NamedTuple):
    """Tables in the place of one: number `now`[0] is in force, at the beginning of a pass number `now`[1]."""

    stages: int
    breaks: int
    tables: tuple[LineTable, ...]
    now: Ints


@frozen_arrays
class WatchedPasses:
    """`seen` (n,): bits of all alarms that a pass had at any sample; `at_end` (n,): those of its last sample.

    Both are 0 for a table without estimator. `table` (n,): which table braked the cut at the end.
    """

    sample: ExitSample
    seen: Ints
    at_end: Ints
    table: Ints


def watched_passes(loop: ClosedLoop, controller: TableController, draws: Draws) -> WatchedPasses:
    """All passes of `draws`; a reading with z = `faults.FROZEN` is the one before it again (NaN: there was none).

    Raises `ValueError` for a table that is asked at any time.
    """
    return passes_by_weight(loop, (controller,), 0, draws)


def passes_by_weight(
    loop: ClosedLoop, controllers: Sequence[TableController], told: int, draws: Draws
) -> WatchedPasses:
    """The same, each cut told to be of table `told`; by `table_after` it goes over to others of `controllers`.

    They are for one position and one exit speed, from the lightest category to the heaviest. Raises `ValueError` for
    tables that are asked at any time.
    """
    rules = [each.law() for each in controllers]
    if not all(isinstance(each, regulator.Rule) for each in rules):
        raise ValueError("watched passes: only tables that decide at rest can be watched")
    passes, now = len(draws.cut_factor), np.array([told, told])
    exits, found = empty_exits(passes), np.zeros((3, passes), np.int64)
    sensor = FreezingSensor(*loop.sensor, np.empty(1))
    with _COMPILING:
        run = _watching()
    law = together([each.rule for each in controllers], now)
    known = np.empty((1, len(rules) * (STATE_SIZE + 1) + 2), np.float32)
    observed = Observed(known, np.empty((1, 0), np.float32), np.zeros(1, np.int64), np.zeros(1))
    memory = empty_trace(0), lane_memory(), observed
    run(loop.path, loop.pieces, sensor, law, draws, exits, memory, found)
    return WatchedPasses(sample_of(exits, draws), *found)


def together(rules: Sequence[regulator.Rule], now: Ints) -> Any:
    """One law of all `rules`, for `_watching`."""
    first = rules[0].table
    tables = Together(first.stages, first.breaks, tuple(each.table for each in rules), now)
    law: Any = rules[0]
    # With a lead the radar reads at every sample, also during a change of stage; the rule of a table knows no lead.
    return law._replace(table=tables, lead_s=1.0)


_COMPILING = Lock()
"""Two threads that begin together must not both compile."""


@cache
def _watching() -> Callable[..., None]:
    """The loop over passes; compiled anew in a process, so that no stale cache is asked."""
    read, observe, decide = regulator.measure, regulator.estimated_speed, regulator.stage_by_table
    word_of, after = compiled_rule(alarms, fresh=True), compiled_rule(table_after, fresh=True)
    size = STATE_SIZE

    @compiled
    def measure(v, z, sensor):  # type: ignore[no-untyped-def]  # numba infers the types
        if z != np.inf:
            sensor.last_m_s[0] = read(v, z, sensor)
        return sensor.last_m_s[0]

    @compiled
    def estimated_speed(law, known, s, v, kpa):  # type: ignore[no-untyped-def]  # as above
        now, count = law.now, len(law.tables)
        speeds, words = known[count * size : count * size + count], known[count * size + count :]
        for i in range(count):
            speeds[i] = observe(law.tables[i], known[i * size : (i + 1) * size], s, v, kpa)
        word = word_of(law.tables[now[0]], known[now[0] * size : (now[0] + 1) * size])
        words[0], words[1] = int(words[0]) | word, word
        now[0] = after(word, now[0], count - 1)
        return speeds[now[0]]

    @compiled
    def stage_by_table(law, stage, s, v, kpa):  # type: ignore[no-untyped-def]  # as above
        return decide(law.tables[law.now[0]], stage, s, v, kpa)

    run_one = loop_at_rest(measure, estimated_speed, stage_by_table)

    @compiled
    def run(path, pieces, sensor, law, draws, exits, memory, found):  # type: ignore[no-untyped-def]  # as above
        trace, work, observed = memory
        factor, known, now = draws.cut_factor, observed.state[0], law.table.now
        for i in range(factor.shape[0]):
            sensor.last_m_s[0], now[0], known[:], observed.passed_kpa[0] = np.nan, now[1], 0.0, 0.0
            one = Draws(
                factor[i : i + 1], draws.resistance_n_kn[i : i + 1], draws.entry_m_s[i : i + 1],
                draws.first_sample_s[i : i + 1], draws.path_z[i : i + 1], draws.noise_z[i : i + 1],
                draws.brake_m_s2_per_kpa[i : i + 1], draws.weight[i : i + 1],
            )  # fmt: skip
            alone = Exits(
                exits.speed_m_s[i : i + 1], exits.time_s[i : i + 1], exits.stalled[i : i + 1],
                exits.switchings[i : i + 1],
            )  # fmt: skip
            run_one(path, pieces, sensor, law, one, alone, trace, work, observed)
            found[0, i], found[1, i], found[2, i] = int(known[-2]), int(known[-1]), now[0]

    watching: Callable[..., None] = run
    return watching
