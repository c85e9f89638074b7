"""Whether kernels are compiled by what numba promises alone.

They are made fast with options that numba does not document (`kernels.vector.numba_internals`), which a new release may
drop. With the environment variable `RETARDER_SYNTH_PLAIN_KERNELS=1` none of them is used. Results are the same to the
last bit.
"""

from __future__ import annotations

import os
from typing import Final

VARIABLE: Final = "RETARDER_SYNTH_PLAIN_KERNELS"

IS_PLAIN: Final = os.environ.get(VARIABLE, "") not in ("", "0")
