"""What every command that tunes does around its tune."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, NoReturn

import pytest

from synth.frame.input_error import InputError
from synth.retarder.asked_tune import AskedTune, tuned
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.failed_case import FailedCase
from synth.retarder.radar_epochs import RadarEpochs
from synth.retarder.tune import Book, no_notice
from tests.synth.case_factory import make_case
from tuning_tables import InvalidTable

CONFIG = parse_config("", "x.toml")
WORK: Any = SimpleNamespace(progress=SimpleNamespace(note=print), directory=None)


@pytest.mark.parametrize(("cases", "sentence"), [((make_case(),), "two tables are alike"), ((), "no table for")])
def test_what_makes_no_book_is_refused_in_a_sentence_about_the_file(
    cases: tuple[Any, ...], sentence: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    failed = () if cases else (FailedCase("a class", 2.0, "too coarse"),)
    book: Book[Any] = Book(CONFIG, "2026-11-20T22:46:00Z", cases, failed)
    monkeypatch.setattr("synth.retarder.tune.tune", lambda *_: book)
    monkeypatch.setattr("synth.retarder.first_run.first_time", lambda: False)

    def found(_: Book[Any]) -> NoReturn:
        raise InvalidTable("two tables are alike.")

    with pytest.raises(InputError, match=f"^x.toml: .*{sentence}"):
        tuned(AskedTune(CONFIG, "x.toml", RadarEpochs(), 1), WORK, no_notice, found)
