"""What a controller made of one cut."""

from __future__ import annotations

from dataclasses import dataclass

from synth.simulation.sampled_pass import PassEnd


@dataclass(frozen=True)
class BenchPass:
    """A cut under the controller; `case`, `number`: which table's, and which of its row.

    `switchings`: commands that changed the stage; `samples`, and of these `unanswered`: the stage before stood;
    `moved_alone`, `held_alone`: samples at which the controller changed the stage and the table would not, and the
    other way round; `response_s`: longest time to an answer; `silent_s`: longest time without one.
    """

    case: int
    number: int
    end: PassEnd
    switchings: int
    samples: int
    unanswered: int
    moved_alone: int
    held_alone: int
    response_s: float
    silent_s: float
