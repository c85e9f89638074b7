"""What a run on the bench has left."""

from __future__ import annotations

from dataclasses import dataclass

from synth.retarder.bench.bench_pass import BenchPass
from synth.retarder.bench.exchange import Traffic
from synth.retarder.bench.score import Errors


@dataclass(frozen=True)
class FoundBench:
    """What became of the cuts that came, out of `asked`.

    `cycles`: the times from sample to sample, None where there was no clock; `is_first`: they went before all else that
    the machine had to do.
    """

    title: str
    period_s: float
    computing_delay_s: float
    seed: int
    asked: int
    passes: tuple[BenchPass, ...]
    errors: tuple[Errors, ...]
    traffic: Traffic
    cycles: tuple[float, ...] | None
    is_first: bool
    prediction_ratio_low: float
