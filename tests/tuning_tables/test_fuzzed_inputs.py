"""Nearly right inputs are refused in order or read exactly.

At length: FUZZ_COUNT=100000 FUZZ_SEED=7 ./scripts/test --quick tests/tuning_tables/test_fuzzed_inputs.py
"""

import os
import warnings
from collections import Counter
from itertools import islice
from pathlib import Path

import pytest

from tests.effort import sized
from tests.tuning_tables.damaged_inputs import Attempt, attempts
from tests.tuning_tables.reader_trial import Finding, outcome_of
from tuning_tables import ControllerTable, from_json, to_json

COUNT, FIRST_SEED = int(os.environ.get("FUZZ_COUNT", sized(400, 1200))), int(os.environ.get("FUZZ_SEED", "0"))


@pytest.mark.parametrize(
    ("seed", "names"),
    [
        (FIRST_SEED, ("table", "approached_estimate")),
        (FIRST_SEED + 1, ("table", "approached_estimate")),
        (FIRST_SEED + 2, ("surface_table", "surface_estimate", "table")),
    ],
)
def test_nearly_right_inputs_are_refused_in_order_or_read_exactly(
    request: pytest.FixtureRequest, tmp_path: Path, seed: int, names: tuple[str, ...]
) -> None:
    originals: list[ControllerTable] = [request.getfixturevalue(name) for name in names]
    outcomes: Counter[tuple[str, str, str]] = Counter()
    for attempt in islice(attempts(seed, originals, tmp_path), COUNT):
        try:
            outcomes[attempt.reader, attempt.kind, outcome_of(attempt, tmp_path)] += 1
        except Finding as finding:
            pytest.fail(f"{finding}: {attempt}")
    assert outcomes.total() == COUNT
    # The deep kinds reach beyond the checksum: some of them are tables of their own, most are not.
    for deep in (("json", "altered"), ("book", "forged")):
        assert outcomes[*deep, "read"] > 0
        assert outcomes[*deep, "DamagedTable"] > outcomes[*deep, "read"]


def test_the_trial_finds_what_it_is_there_to_find(
    table: ControllerTable, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = Attempt("bytes", "json", to_json(table))
    assert outcome_of(text, tmp_path) == "read"
    monkeypatch.setattr(
        "tests.tuning_tables.reader_trial.from_json", lambda content: from_json(content.strip() + b"\n")
    )
    with pytest.raises(Finding, match="none of the two"):
        outcome_of(Attempt("bytes", "json", text.content + b"\n"), tmp_path)

    def fails(_: object) -> None:
        raise KeyError("zones_m")

    monkeypatch.setattr("tests.tuning_tables.reader_trial.from_json", fails)
    with pytest.raises(Finding, match="KeyError instead of"):
        outcome_of(text, tmp_path)
    monkeypatch.setattr("tests.tuning_tables.reader_trial.from_json", lambda _: warnings.warn("overflow", stacklevel=1))
    with pytest.raises(Finding, match="UserWarning instead of"):
        outcome_of(text, tmp_path)
