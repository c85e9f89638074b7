"""Working memory of one solve, kept for the next: the pages of fresh memory cost as much as the operator's build."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

CACHE_LINE_BYTES = 64


class Scratch:
    """Named pieces of memory that begin on a cache line; each grows when more is asked for and is never given back."""

    def __init__(self) -> None:
        self._pieces: dict[str, NDArray[np.uint8]] = {}

    def singles(self, name: str, *shape: int) -> NDArray[np.float32]:
        """A float32 array with whatever is in it; it shares its memory with the last one of this name."""
        return self._bytes(name, 4 * int(np.prod(shape))).view(np.float32).reshape(shape)

    def integers(self, name: str, *shape: int) -> NDArray[np.int32]:
        """The same in int32."""
        return self._bytes(name, 4 * int(np.prod(shape))).view(np.int32).reshape(shape)

    def counters(self, name: str, *shape: int) -> NDArray[np.int64]:
        """The same in int64, set to zero."""
        array = self._bytes(name, 8 * int(np.prod(shape))).view(np.int64).reshape(shape)
        array[:] = 0
        return array

    def _bytes(self, name: str, size: int) -> NDArray[np.uint8]:
        piece = self._pieces.get(name)
        if piece is None or piece.size < size:
            raw = np.empty(size + CACHE_LINE_BYTES, dtype=np.uint8)
            start = -raw.ctypes.data % CACHE_LINE_BYTES
            self._pieces[name] = piece = raw[start : start + size]
        return piece[:size]
