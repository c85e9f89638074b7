"""Values with arrays cannot be written to, whichever way they came to be, and can be compared and hashed."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
import pytest
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays


@frozen_arrays
@dataclass(frozen=True, eq=False)
class Curve:
    """Two arrays, a tuple of arrays, one made by itself, and a number."""

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    parts: tuple[NDArray[np.float64], ...] = ()
    scale: float = 1.0
    sums: NDArray[np.float64] = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "sums", self.x + self.y)


def arrays(curve: Curve) -> list[NDArray[np.float64]]:
    return [curve.x, curve.y, curve.sums, *curve.parts]


def made() -> Curve:
    return Curve(np.arange(3.0), y=np.ones(3), parts=(np.zeros(2), np.zeros(1)))


@pytest.mark.parametrize(
    "way",
    [
        lambda curve: curve,
        lambda curve: pickle.loads(pickle.dumps(curve)),
        copy.copy,
        copy.deepcopy,
        lambda curve: replace(curve, y=np.zeros(3)),
    ],
    ids=["made", "unpickled", "copied", "deeply copied", "replaced"],
)
def test_no_array_can_be_written_to(way: Callable[[Curve], Curve]) -> None:
    curve = way(made())
    assert len(arrays(curve)) == 5
    for array in arrays(curve):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 7.0


def test_the_values_are_those_given() -> None:
    curve = pickle.loads(pickle.dumps(made()))
    assert curve.sums.tolist() == [1.0, 2.0, 3.0]
    assert (curve.scale, [part.size for part in curve.parts]) == (1.0, [2, 1])


def test_equality_and_hash_do_not_raise() -> None:
    one, other = made(), made()
    assert one == one
    assert one != other
    assert len({one, other, one}) == 2


def test_repr_tells_the_shape_of_an_array_and_not_its_numbers() -> None:
    shown = repr(replace(made(), parts=(), x=np.zeros(10_000), y=np.ones(10_000)))
    assert shown == "Curve(x=float64 (10000,), y=float64 (10000,), parts=(), scale=1.0, sums=float64 (10000,))"


def test_without_it_an_unpickled_array_can_be_written_to() -> None:
    """Why `__setstate__` is needed: numpy forgets the flag."""
    array = np.zeros(2)
    array.setflags(write=False)
    assert pickle.loads(pickle.dumps(array)).flags.writeable
