"""For all tests: hypothesis draws the same examples in CI; what is long waits; a matrix of requirements if wanted."""

from __future__ import annotations

import gc
import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings

from tests.corpus import Corpus, shared_base
from tests.effort import IS_LONG, sized
from tests.printed_page import Page, caught
from tests.requirement_matrix import RequirementMatrix

EXAMPLES = sized(25, 100)
"""That hypothesis draws where a test does not say how many."""
settings.register_profile("ci", max_examples=EXAMPLES, derandomize=True, deadline=None)
settings.register_profile("here", max_examples=EXAMPLES, deadline=None)
settings.load_profile("ci" if os.environ.get("CI") else "here")


@pytest.fixture(scope="session", autouse=True)
def pages() -> Iterator[list[Page]]:
    """Every page that commands have printed in this process; each is found whole at every width as it is printed."""
    with caught() as found:
        yield found


@pytest.fixture(scope="session")
def corpus(tmp_path_factory: pytest.TempPathFactory) -> Corpus:
    """What commands have left, made once for all processes of this run."""
    return Corpus(shared_base(tmp_path_factory))


def pytest_addoption(parser: pytest.Parser) -> None:
    """Take the option that asks for a matrix."""
    parser.addoption("--matrix", type=Path, help="write what became of each requirement into this file, as Markdown")


def pytest_configure(config: pytest.Config) -> None:
    """Keep the outcomes where a matrix is wanted."""
    if path := config.getoption("matrix"):
        config.pluginmanager.register(RequirementMatrix(path))


COMPILES = "checker/test_mutations.py"
"""Its first tune compiles most kernels. Its tables are for commands at rest, as those of the process that helps it."""

WITHOUT_KERNELS = ("architecture", "attack", "controller_code", "frame", "tuning_tables")
"""Folders whose tests need hardly any: one process runs them while the other compiles what both need afterwards."""

WITH_KERNELS = "controller_code/fmi"
"""What is in such a folder all the same: both processes would compile it."""


def turn_of(item: pytest.Item) -> int:
    """When the file of a test comes: what compiles first, then what needs no kernel, then the rest."""
    place = item.path.relative_to(Path(__file__).parent)
    if place.as_posix() == COMPILES:
        return 0
    return 1 if place.parts[0] in WITHOUT_KERNELS and not place.is_relative_to(WITH_KERNELS) else 2


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out what is marked as long, unless it is wanted; within a turn the order of names stays."""
    items.sort(key=turn_of)
    if not IS_LONG:
        left_out = [item for item in items if item.get_closest_marker("long")]
        config.hook.pytest_deselected(items=left_out)
        items[:] = [item for item in items if item not in left_out]


def pytest_collection_finish() -> None:
    """Keep Python's collector from going through ten thousand collected tests again and again: a tenth of the time."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(200_000, 20, 20)
