"""Numbers as C99 writes them."""

from __future__ import annotations

import numpy as np


def hex_float(value: np.float32) -> str:
    """`value`, finite, as a C99 hexadecimal constant of type float: 2.5 is "0x1.4p+1f"."""
    mantissa, _, exponent = float(value).hex().partition("p")
    return f"{mantissa.rstrip('0').rstrip('.') if '.' in mantissa else mantissa}p{exponent}f"
