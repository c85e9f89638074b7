"""Prints `golden.json` with the two books as they are on the processor at hand: who changes tables on purpose keeps it.

    python -m tests.qualification.keep "with AVX-512"

A processor with AVX-512 makes the bytes of one without where numba, numpy and OpenBLAS are told so:
NUMBA_CPU_NAME=haswell OPENBLAS_CORETYPE=Haswell NPY_DISABLE_CPU_FEATURES="AVX512F AVX512CD AVX512_SKX AVX512_CLX
AVX512_CNL AVX512_ICL AVX512_SPR".
"""

from __future__ import annotations

import json
import sys
import tempfile
from pathlib import Path
from typing import Any

from synth.cli.qualification.golden import golden_of, kept, surroundings
from synth.cli.qualification.tuned import KINDS, tuned


def with_this(kind: str, processor: str, folder: Path) -> dict[str, Any]:
    """The kept book with its hash on this `processor`, and those of the others if the libraries were the same."""
    found, before = golden_of(tuned(folder, kind, plain=False)), kept()[kind]
    others = before.sha256 if before.made_with == found.made_with else {}
    return {"sha256": {**others, processor: found.sha256[""]}, "rms_m_s": found.rms_m_s}


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        books = {kind: with_this(kind, sys.argv[1], Path(folder)) for kind in KINDS}
    print(json.dumps({"books": books, "made_with": surroundings()}, indent=1, sort_keys=True))
