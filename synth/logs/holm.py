"""Which of several tests speak, when all of them together may be wrong seldom."""

from __future__ import annotations

from collections.abc import Sequence


def rejected(p_values: Sequence[float], level: float) -> tuple[int, ...]:
    """Numbers of the tests whose hypothesis falls, the clearest first.

    The chance that any true hypothesis falls is `level` at most, however the tests depend on one another (Holm 1979,
    Scandinavian Journal of Statistics 6, 65–70): the smallest of k p values is held against level / k, the next one
    against level / (k − 1), and so on to the first that does not pass. A NaN never passes.
    """
    order = sorted(range(len(p_values)), key=lambda number: (p_values[number] != p_values[number], p_values[number]))
    passed: list[int] = []
    for place, number in enumerate(order):
        if not p_values[number] * (len(order) - place) <= level:
            break
        passed.append(number)
    return tuple(passed)
