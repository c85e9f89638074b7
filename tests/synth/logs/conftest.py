"""Logs of a known plant, made once."""

from __future__ import annotations

import pytest

from scripts.studies.identification import TRUTHS, Yard, assumed_yard
from synth.logs.estimate import Estimate, estimate
from synth.logs.fitting_passes import FittingPasses
from synth.logs.unknowns import unknowns_of
from tests.corpus import Corpus

PASSES, SEED = 80, 7


@pytest.fixture(scope="session")
def yard() -> Yard:
    return assumed_yard()


@pytest.fixture(scope="session")
def passes(yard: Yard) -> FittingPasses:
    """Of the plant that was assumed, with a gauge."""
    return yard.passes(TRUTHS[0], PASSES, SEED)


@pytest.fixture(scope="session")
def found(yard: Yard, passes: FittingPasses, corpus: Corpus) -> Estimate:
    return corpus.value("estimate", lambda: estimate(passes, unknowns_of(passes, yard.config.parameters), 2))
