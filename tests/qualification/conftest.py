"""The two small books, made once."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from synth.cli.qualification.tuned import KINDS, Tuned, tuned


@pytest.fixture(scope="session")
def books(tmp_path_factory: pytest.TempPathFactory) -> Mapping[str, Tuned]:
    """Each by its kind, as the installed program makes it."""
    folder = tmp_path_factory.mktemp("qualified")
    return {kind: tuned(folder, kind, plain=False) for kind in KINDS}
