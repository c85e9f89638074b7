"""Not one coefficient changes unless somebody means it to: hashes of all stages and lines, kept in `coefficients.json`.

Who changes tables on purpose writes the file anew (`python -m tests.system.coefficients`), on a processor with AVX-512
and on one without, and says why in the commit. BLAS is told which processor to compute for, as its kernels differ in
the last bit; on a processor without AVX2 this test cannot run.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.effort import sized
from tests.system.coefficients import kept

ROOT = Path(__file__).parents[2]


NAMES = sized(("example of the README", "approach, estimator", "p_overspeed", "rnz-2m-park", "sweep"), tuple(kept()))


@pytest.mark.requirement("PRED-10")
def test_no_coefficient_has_changed() -> None:
    found = subprocess.run(
        [sys.executable, "-m", "tests.system.coefficients", *NAMES],
        cwd=ROOT, env={**os.environ, "OPENBLAS_CORETYPE": "Haswell"}, check=True, capture_output=True, text=True,
    )  # fmt: skip
    assert json.loads(found.stdout) == {name: kept()[name] for name in NAMES}
