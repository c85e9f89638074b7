"""What a run on the bench has left."""

from __future__ import annotations

from dataclasses import dataclass

from synth.retarder.bench.bench_pass import BenchPass
from synth.retarder.bench.clock import Cycles
from synth.retarder.bench.exchange import Traffic
from synth.retarder.bench.score import Errors


@dataclass(frozen=True)
class FoundBench:
    """What became of the cuts that came, out of `asked`; `cycles` None where there was no clock."""

    title: str
    period_s: float
    computing_delay_s: float
    seed: int
    asked: int
    passes: tuple[BenchPass, ...]
    errors: tuple[Errors, ...]
    traffic: Traffic
    cycles: Cycles | None
    prediction_ratio_low: float
