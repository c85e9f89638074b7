"""The last bit of a table does not depend on how many threads BLAS has, nor on the kernel that it takes."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

from synth.solver.one_blas_thread import one_blas_thread

NOISE = """
import importlib.util, sys
from synth.solver.chain.chain import persistent_chain
spec = importlib.util.spec_from_file_location("plants", sys.argv[1])
plants = importlib.util.module_from_spec(spec)
spec.loader.exec_module(plants)
noise = persistent_chain(plants.random_plant(), plants.COARSE).transient_noise
print(noise.probability.tobytes().hex(), noise.mean.tobytes().hex(), noise.std.tobytes().hex())
"""
PLANTS = Path(__file__).parents[1] / "properties" / "conftest.py"


def printed(program: str, **environment: str) -> str:
    """What `program` prints of the random plants."""
    return subprocess.run(
        [sys.executable, "-c", program, str(PLANTS)],
        env={**os.environ, **environment}, check=True, capture_output=True, text=True,
    ).stdout  # fmt: skip


def threads() -> set[int]:
    """What the BLAS libraries of this process would use now."""
    return {library["num_threads"] for library in threadpool_info() if library["user_api"] == "blas"}


def test_every_library_has_one_until_the_first_has_left() -> None:
    np.linalg.inv(np.eye(2))  # whatever BLAS numpy has is there
    with threadpool_limits(2, user_api="blas"):
        assert 1 not in threads()
        seen = []

        def enter_and_leave() -> None:
            with one_blas_thread():
                seen.append(threads())

        with one_blas_thread():
            assert threads() == {1}
            enter_and_leave()
            others = [threading.Thread(target=enter_and_leave) for _ in range(4)]
            for other in others:
                other.start()
            for other in others:
                other.join()
            assert threads() == {1}
        assert seen == [{1}] * 5
        assert 1 not in threads()


def test_what_was_is_restored_after_a_fault() -> None:
    before = threads()
    with pytest.raises(ZeroDivisionError), one_blas_thread():
        raise ZeroDivisionError
    assert threads() == before


def test_the_noise_of_the_prediction_is_the_same_to_the_bit_by_every_kernel_of_blas() -> None:
    # The oldest kernels, which do not fuse multiplication and addition, and those of this processor.
    own = printed(NOISE, OPENBLAS_CORETYPE="")
    assert len(own) > 100
    assert printed(NOISE, OPENBLAS_CORETYPE="Nehalem") == own
