"""Whether kernels are compiled by what numba promises alone.

The fast way stands on numba's inside (`kernels.vector.numba_internals`), which a new release may change. With the
environment variable `RETARDER_SYNTH_PLAIN_KERNELS=1` nothing of it is imported: packs are small arrays then, and a
kernel counts references as numba wants it to. Results are the same to the last bit; study `benchmark` tells how much
longer they take.
"""

from __future__ import annotations

import os
from typing import Final

VARIABLE: Final = "RETARDER_SYNTH_PLAIN_KERNELS"

IS_PLAIN: Final = os.environ.get(VARIABLE, "") not in ("", "0")
