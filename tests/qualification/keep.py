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
from dataclasses import asdict
from pathlib import Path

from synth.cli.qualification.golden import Golden, golden_of, kept
from synth.cli.qualification.tuned import KINDS, tuned


def with_this(kind: str, processor: str, folder: Path) -> Golden:
    """The kept book with its hash on this `processor`."""
    found = golden_of(tuned(folder, kind, plain=False))
    return Golden({**kept()[kind].sha256, processor: found.sha256[""]}, found.rms_m_s)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        golden = {kind: asdict(with_this(kind, sys.argv[1], Path(folder))) for kind in KINDS}
    print(json.dumps(golden, indent=1, sort_keys=True))
