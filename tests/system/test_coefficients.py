"""Not one coefficient changes unless somebody means it to: hashes of all stages and lines, kept in `coefficients.json`.

Those without approach were made by commit 0514bc8, before the rooms of `synth` were moved. Who changes tables on
purpose writes the file anew (`python -m tests.system.coefficients`) and says why in the commit. BLAS is told which
processor to compute for, as its kernels differ in the last bit; on a processor without AVX2 this test cannot run.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
KEPT = json.loads(Path(__file__).with_name("coefficients.json").read_text(encoding="utf-8"))


def test_no_coefficient_has_changed() -> None:
    found = subprocess.run(
        [sys.executable, "-m", "tests.system.coefficients"],
        cwd=ROOT, env={**os.environ, "OPENBLAS_CORETYPE": "Haswell"}, check=True, capture_output=True, text=True,
    )  # fmt: skip
    assert json.loads(found.stdout) == KEPT
