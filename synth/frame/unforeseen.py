"""An exception that nobody has foreseen, in one line."""

from __future__ import annotations

import os
import traceback


def unforeseen(fault: BaseException) -> str:
    """Type, words and place of `fault`, without a line break."""
    frames = traceback.extract_tb(fault.__traceback__)
    place = f" (in {os.path.basename(frames[-1].filename)}, line {frames[-1].lineno})" if frames else ""
    return f"{type(fault).__name__}: {' '.join(str(fault).split()) or 'no words'}{place}"
