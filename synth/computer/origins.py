"""Where the usual numbers of a control computer are from."""

from __future__ import annotations

from typing import Final

from plant_models.library.sourced_value import JUDGEMENT

USUAL: Final = f"{JUDGEMENT}: its order of magnitude"
SPEED: Final = "[hump-computer-1970s], chapter 3"
MONEY: Final = "[hump-computer-1970s], chapter 4"
STUDY: Final = "study control-computer, hump `large` of the library"
