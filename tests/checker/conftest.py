"""A small tune with every export, done once."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests.corpus import Corpus, Recipe

CONFIG = """\
[position]
name = "rnz-2m-park"
[entry]
high_m_s = 4.0
[targets]
exit_speeds_m_s = [1.5, 2.5]
[grid]
path_step_m = 1.0
speed_step_m_s = 0.05
transient_step_s = 0.05
friction_scenarios = 3
resistance_scenarios = 1
[fit]
degree = 2
[validation]
passes = 4000
[acceptance]
prediction_ratio_low = 0.9
prediction_ratio_high = 1.35
[output]
csv = true
plots = false
report = false
[[cut]]
car = "gondola-4"
mass_t = 22
"""
"""A park retarder, one light class and two targets, on a coarse grid."""

FROM_THE_ENTRANCE = "approach_m = 0.0\nestimator = false\n"

APPROACHED = f"{CONFIG}entrance_stage = 1\n[regulator]\napproach_m = 4.0\n"
"""The class may be given stage 1 before the entrance."""


ANY_TIME = f'{CONFIG}[regulator]\ncommands = "any_time"\n'.replace("[1.5, 2.5]", "[2.5]")
"""At every sample; one target, for the polish of surfaces takes long."""

REGULATORS_AT_ANY_TIME = {
    "gauge": FROM_THE_ENTRANCE,
    "none": f'pressure = "none"\n{FROM_THE_ENTRANCE}',
    "estimated": "approach_m = 4.0\nestimator = true\n",
}


EVERY_EXPORT = (
    ("tune", "config.toml", "-o", "out", "--workers", "1"),
    ("export", "out/book.h5", "--format", "st", "-o", "out/st"),
)


def tune(corpus: Corpus, config: str) -> Path:
    """The directory of a tune with every export."""
    made = corpus.made(Recipe(config, EVERY_EXPORT))
    assert made.codes == (0, 0)
    return made.folder / "out"


@pytest.fixture(scope="session")
def tuned_once(corpus: Corpus) -> Path:
    """The directory of the tune, C99 in c/ and Structured Text in st/; not to be changed."""
    return tune(corpus, f"{CONFIG}[regulator]\n{FROM_THE_ENTRANCE}")


@pytest.fixture(scope="session")
def estimated_once(corpus: Corpus) -> Path:
    """The directory of the same tune with an estimator; not to be changed."""
    return tune(corpus, f"{CONFIG}[regulator]\napproach_m = 0.0\nestimator = true\n")


@pytest.fixture(scope="session", params=[False, True], ids=["measured", "estimated"])
def approached_once(request: pytest.FixtureRequest, corpus: Corpus) -> Path:
    """The directory of the same tune with an approach, without and with estimator; not to be changed."""
    return tune(corpus, f"{APPROACHED}estimator = {str(request.param).lower()}\n")


@pytest.fixture(scope="session")
def gauged_once(corpus: Corpus) -> Path:
    """The directory of a tune of one table at any time, with a gauge; not to be changed."""
    return tune(corpus, f"{ANY_TIME}{REGULATORS_AT_ANY_TIME['gauge']}")


@pytest.fixture(scope="session", params=REGULATORS_AT_ANY_TIME)
def any_time_once(request: pytest.FixtureRequest, corpus: Corpus) -> Path:
    """The same with a gauge, without, and with an estimator and an approach; not to be changed."""
    return tune(corpus, f"{ANY_TIME}{REGULATORS_AT_ANY_TIME[request.param]}")


@pytest.fixture
def gauged(gauged_once: Path, tmp_path: Path) -> Path:
    """A copy of it, to be changed at will."""
    return Path(shutil.copytree(gauged_once, tmp_path / "out"))


@pytest.fixture
def tuned(tuned_once: Path, tmp_path: Path) -> Path:
    """A copy of it, to be changed at will."""
    return Path(shutil.copytree(tuned_once, tmp_path / "out"))


@pytest.fixture
def approached(approached_once: Path, tmp_path: Path) -> Path:
    """A copy of it, to be changed at will."""
    return Path(shutil.copytree(approached_once, tmp_path / "out"))


@pytest.fixture
def estimated(estimated_once: Path, tmp_path: Path) -> Path:
    """A copy of it, to be changed at will."""
    return Path(shutil.copytree(estimated_once, tmp_path / "out"))
