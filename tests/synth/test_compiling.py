"""Decorators of kernels: what Python may call, and what only kernels may."""

from __future__ import annotations

import pytest

from synth.kernels.compiling import borrowing, part, part_inline


@part
def doubled(x):  # type: ignore[no-untyped-def]
    return 2.0 * x


@part_inline
def raised(x):  # type: ignore[no-untyped-def]
    return x + 1.0


@borrowing
def whole(x):  # type: ignore[no-untyped-def]
    return raised(doubled(x))


def test_parts_are_called_by_kernels_and_refused_to_python() -> None:
    """Before and after they were compiled: a call of what numba did not make would end the process."""
    for compiled in (False, True):
        for each in (doubled, raised):
            with pytest.raises(TypeError, match=rf"{each.__name__} is a part of kernels"):
                each(1.5)
        if not compiled:
            assert whole(1.5) == 4.0
    assert raised.py_func(doubled.py_func(1.5)) == 4.0
