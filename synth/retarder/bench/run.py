"""The run: cut after cut comes, the controller commands, and what it did is kept, pass by pass."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from synth.frame.workers.engine import Tell
from synth.retarder.bench.bench_pass import AskedSample, BenchCase, BenchPass
from synth.retarder.bench.exchange import Answer, Clock, Exchange, next_count
from synth.retarder.bench.live_run import LiveRun
from synth.simulation.sampled_pass import Reading, sampled_pass
from tuning_tables import ControllerTable, begin, decide_for, speed_for
from tuning_tables.decisions import Decisions


@dataclass(frozen=True)
class Patience:
    """`gap_s`: without a cut, between two; `silent_s`: without an answer, from then on a controller is called silent;
    `first_s`: until the first answer; `end_s`: without an answer, after which the run ends."""

    gap_s: float = 2.0
    silent_s: float = 1.0
    first_s: float = 600.0
    end_s: float = 60.0


class Silence(Exception):
    """Nobody has answered for so long that the run ends; says for how long."""


class Bench:
    """The position at the end of the cable: `exchange`, played by `clock` with samples `period_s` apart.

    `note` is told what is remarkable.
    """

    def __init__(self, exchange: Exchange, clock: Clock, period_s: float, patience: Patience, note: Tell) -> None:
        self._exchange, self._clock, self._period_s = exchange, clock, period_s
        self._patience, self._note = patience, note
        self._sample = 0
        self._unheard = 0

    def run(
        self, cases: Sequence[BenchCase], cuts: Sequence[tuple[int, int]], live: LiveRun, done: Tell
    ) -> tuple[BenchPass, ...]:
        """All `cuts`, each told to `done`; fewer where the controller falls silent for good, none if it never came."""
        passes: list[BenchPass] = []
        try:
            self._await_controller(cases[cuts[0][0]])
            for count, (case, number) in enumerate(cuts, 1):
                self._gap(cases[case], count)
                passes.append(self._pass(cases[case], case, number, count, live))
                live.ended(cases[case], passes[-1])
                done(told_of(cases[case], passes[-1]))
        except Silence as silence:
            self._note(f"{silence}: the run ends")
        return tuple(passes)

    def _await_controller(self, case: BenchCase) -> None:
        """Samples without a cut until one is answered."""
        while self._exchange_sample(case, 0, None).response_s is None:
            self._require_life(self._patience.first_s)

    def _gap(self, case: BenchCase, count: int) -> None:
        """No cut for a while; the position is in its initial stage, and what is commanded does not count."""
        for _ in range(self._samples_in(self._patience.gap_s)):
            self._exchange_sample(case, count, None)
            self._require_life(self._patience.end_s)

    def _pass(self, case: BenchCase, at: int, number: int, count: int, live: LiveRun) -> BenchPass:
        """One cut."""
        shadow, asked = TableShadow(case.table), list[AskedSample]()
        rolling = sampled_pass(case.loop, case.common.draws.part(number, number + 1))
        reading = next(rolling)
        live.begins(case, count)
        while True:
            answer = self._exchange_sample(case, count, reading)
            asked.append(AskedSample(reading.stage, shadow.stage_at(reading), answer))
            if self._unheard == self._samples_in(self._patience.silent_s):
                self._note(f"cut {count}: the controller is silent; stage {answer.stage} stands")
            self._require_life(self._patience.end_s)
            live.sampled(reading, answer.stage)
            try:
                reading = rolling.send(answer.stage)
            except StopIteration as ended:
                return BenchPass(at, number, ended.value, tuple(asked))

    def _exchange_sample(self, case: BenchCase, count: int, reading: Reading | None) -> Answer:
        """Tell a sample, and wait until it is over."""
        self._sample = next_count(self._sample)
        stage = case.loop.sampled.initial_stage if reading is None else reading.stage
        self._exchange.tell({"sample": self._sample, "pass_number": count, **told(case, reading, stage)}, stage)
        answer = self._clock.next_sample(self._exchange)
        self._unheard = self._unheard + 1 if answer.response_s is None else 0
        return answer

    def _samples_in(self, time_s: float) -> int:
        """Samples of a time, one at least."""
        return max(1, round(time_s / self._period_s))

    def _require_life(self, patience_s: float) -> None:
        """`Silence` where nobody has answered for longer."""
        if self._unheard > self._samples_in(patience_s):
            raise Silence(f"no answer for {patience_s:g} s")


def told(case: BenchCase, reading: Reading | None, stage: int) -> dict[str, float]:
    """What the position tells of a sample; None: no cut is there, the next one is announced."""
    drive, table = case.loop.sampled, case.table
    over_kpa = max(0.0, drive.initial_kpa - drive.valves.touch_kpa)
    there = reading or Reading(case.loop.plant.start_m, math.nan, over_kpa, drive.initial_kpa, True, stage, 0.0)
    return {
        "present": reading is not None,
        "category": case.category,
        "axles": len(table.cut.axle_offsets_m),
        "stage_in_force": stage,
        "commanded_m_s": table.target_speed_m_s,
        "path_m": there.path_m,
        "measured_m_s": -1.0 if math.isnan(there.measured_m_s) else there.measured_m_s,
        "mean_overpressure_kpa": there.mean_overpressure_kpa,
        "pressure_kpa": there.pressure_kpa,
        "at_rest": there.at_rest,
    }


def told_of(case: BenchCase, found: BenchPass) -> str:
    """A pass in a sentence."""
    target = case.table.target_speed_m_s
    end = "stands" if found.end.stalled else f"leaves with {found.end.exit_speed_m_s:.3f} m/s"
    missing = f", {found.unanswered} of {found.samples} samples unanswered" if found.unanswered else ""
    return f"{case.label} to {target:g} m/s {end}, the table {case.by_table.exit_speed_m_s[found.number]:.3f}{missing}"


class TableShadow:
    """One cut under a table; an estimator learns of each sample."""

    def __init__(self, table: ControllerTable) -> None:
        self._table, self._state = table, begin()

    def stage_at(self, reading: Reading) -> int:
        """The stage of the table at this sample; to be asked once at each."""
        speed = speed_for(self._table, self._state, reading.path_m, reading.measured_m_s, reading.mean_overpressure_kpa)
        if not reading.at_rest and self._table.decisions is Decisions.AT_REST:
            return reading.stage
        return decide_for(self._table, reading.stage, reading.path_m, speed, reading.pressure_kpa)
