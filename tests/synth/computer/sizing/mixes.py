"""Tasks to test with: of every law, with more than one of a priority."""

from __future__ import annotations

from synth.computer.sizing.service_law import Constant, Erlang, Exponential, Hyperexponential
from synth.computer.sizing.task import Stream

EXPONENTIAL = (
    Stream("a", 0.3, Exponential(0.5), 1),
    Stream("b", 0.3, Exponential(0.8), 2),
    Stream("c", 0.2, Exponential(1.0), 3),
)
"""The three classes of yard-facts §11.E."""

MIXED = (
    Stream("constant", 0.4, Constant(0.5), 1),
    Stream("erlang", 0.3, Erlang(0.8, 3), 2),
    Stream("hyper", 0.2, Hyperexponential(1.0, 3.0), 3),
    Stream("also second", 0.1, Exponential(0.5), 2),
)
