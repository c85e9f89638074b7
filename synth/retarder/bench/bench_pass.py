"""The cuts that come to the bench, for each table those of its class, drawn as the simulator draws them, and mixed; and
what a controller made of one of them.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import groupby

import numpy as np

from synth.retarder.bench.exchange import Answer
from synth.retarder.served_class import ServedClass
from synth.simulation.closed_loop import ClosedLoop, TableController
from synth.simulation.common_passes import CommonPasses, common_passes
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import random_passes
from synth.simulation.sampled_pass import PassEnd, sampled_pass
from tuning_tables import ControllerTable

ORDER, CLASSES = 0, 1
"""Numbers of child streams of the seed: which table is next, and the row of passes of each table."""


@dataclass(frozen=True)
class BenchCase:
    """The cuts of one table, `common` to all that is compared, and what the simulator makes of them under the table.

    `category`: the number that stands for the weight category in controllers.
    """

    table: ControllerTable
    label: str
    category: int
    common: CommonPasses
    by_table: ExitSample

    @property
    def loop(self) -> ClosedLoop:
        """The position with the stages of the table."""
        return self.common.loop(len(self.table.stages))


def bench_case(table: ControllerTable, category: int, served: ServedClass, seed: int, passes: int) -> BenchCase:
    """The first `passes` of the row of `seed`; `PlantError` where valves cannot be commanded at any moment."""
    served.plant.drive_at_any_time()
    common = common_passes(served.plant, random_passes(seed, 0, passes))
    case = BenchCase(table, served.label, category, common, common.run(TableController(table)))
    rolling = sampled_pass(case.loop, common.draws.part(0, 1))
    rolling.send(next(rolling).stage)  # loads its kernels, as clients may leave the run no file to open
    return case


def class_seeds(seed: int, cases: int) -> list[int]:
    """A seed for each table."""
    words = np.random.SeedSequence(seed, spawn_key=(CLASSES,)).generate_state(cases, np.uint32)
    return [int(word) for word in words]


def coming_cuts(seed: int, cases: int, passes: int) -> list[tuple[int, int]]:
    """(table, number in its row) of each cut: in every round each table once, in random order; for the same seed a
    longer list begins with the shorter one."""
    order = np.random.Generator(np.random.SFC64(np.random.SeedSequence(seed, spawn_key=(ORDER,))))
    rounds = -(-passes // cases)
    cuts = [(int(case), number) for number in range(rounds) for case in order.permutation(cases)]
    return cuts[:passes]


@dataclass(frozen=True)
class AskedSample:
    """One sample: the stage in force `before`, that of the table in its place, and what stood in the end."""

    before: int
    by_table: int
    answer: Answer

    @property
    def is_changed(self) -> bool:
        """The controller commanded another stage."""
        return self.answer.stage != self.before

    @property
    def is_answered(self) -> bool:
        """Its answer came before the next sample."""
        return self.answer.response_s is not None


@dataclass(frozen=True)
class BenchPass:
    """A cut under the controller; `case`, `number`: which table's, and which of its row; `asked`: its samples."""

    case: int
    number: int
    end: PassEnd
    asked: tuple[AskedSample, ...]

    @property
    def samples(self) -> int:
        """How many there were."""
        return len(self.asked)

    @property
    def switchings(self) -> int:
        """Commands that changed the stage."""
        return sum(each.is_changed for each in self.asked)

    @property
    def unanswered(self) -> int:
        """Samples at whose end the stage before stood, for want of an answer."""
        return sum(not each.is_answered for each in self.asked)

    @property
    def moved_alone(self) -> int:
        """Samples at which the controller changed the stage and the table would not."""
        return sum(each.is_changed and each.by_table == each.before for each in self.asked)

    @property
    def held_alone(self) -> int:
        """The other way round."""
        return sum(not each.is_changed and each.by_table != each.before for each in self.asked)

    @property
    def response_s(self) -> float:
        """Longest time from a sample to its answer; 0 without any."""
        return max((each.answer.response_s or 0.0 for each in self.asked), default=0.0)

    @property
    def silence(self) -> int:
        """Most samples one after the other without an answer."""
        rows = groupby(self.asked, lambda each: each.is_answered)
        return max((len(list(row)) for is_answered, row in rows if not is_answered), default=0)
