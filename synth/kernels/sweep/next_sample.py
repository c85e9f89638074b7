"""How far a cut rolls at a held stage until the regulator samples again."""

from __future__ import annotations

from synth.kernels.compiling import part


@part
def quanta_to_next_sample(speed, begin, end, acceleration, period, path_step, out):
    """`out`[begin:end]: path until the next sample in quanta, from every `speed` (E,), never below a small number.

    Where the next decision is a place and not a time away, `period` is 0: then it is looked for at every node.
    """
    if period <= 0.0:
        out[begin:end] = 1.0
        return
    quanta = 1.0 / path_step
    gained, stopping = 0.5 * acceleration * period * period, 0.0
    if acceleration < 0.0:
        stopping = -0.5 / acceleration
    for j in range(begin, end):
        v = speed[j]
        reach = v * period + gained if v + acceleration * period >= 0.0 else v * v * stopping
        out[j] = max(reach * quanta, 0.01)
