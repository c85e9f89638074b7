"""Options of a study come from words as they are written, or are refused in one sentence."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pytest

from scripts.studies.options import option, options_from, parser_of
from synth.frame.input_error import InputError


@dataclass(frozen=True)
class Options:
    """One of each kind."""

    config: Path | None = option(None, "a file")
    passes: int = option(20_000, "how many", (200, 10**6))
    step_m_s: float = option(0.5, "how far, in % of nothing", (0.1, 5.0))
    cases: tuple[str, ...] = option(("22:2",), "which")
    spreads: tuple[float, ...] = option((), "how wide", (0.0, 1.0))
    as_tuned: bool = option(False, "whether")


def test_words_become_values_of_their_types() -> None:
    words = "--config a.toml --passes 300 --step-m-s=0.25 --cases 52:3 85:4 --spreads 0.1 1 --as-tuned"
    assert options_from(words.split(), Options, "s") == Options(
        Path("a.toml"), 300, 0.25, ("52:3", "85:4"), (0.1, 1.0), True
    )
    assert options_from([], Options, "s") == Options()


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ("--passes 199", "study s: --passes: it is '199'; give a whole number from 200 to 1000000"),
        ("--passes 1e3", "study s: --passes: it is '1e3'; give a whole number from 200 to 1000000"),
        ("--passes nan", "study s: --passes: it is 'nan'; give a whole number from 200 to 1000000"),
        ("--step-m-s nan", "study s: --step-m-s: it is 'nan'; give a number from 0.1 to 5"),
        ("--spreads 0.1 2", "study s: --spreads: it is '2'; give a number from 0 to 1"),
        ("--pass 300", "study s: there is no option --pass; did you mean --passes?"),
        ("--passes", "study s: --passes: expected one argument"),
        ("--cases", "study s: --cases: expected at least one argument"),
        ("300", "study s: there is no option 300; known: "),
    ],
)
def test_other_words_are_refused_in_one_sentence(words: str, sentence: str) -> None:
    with pytest.raises(InputError) as fault:
        options_from(words.split(), Options, "s")
    assert str(fault.value).startswith(sentence)


def test_the_help_tells_every_option_with_its_default() -> None:
    told = parser_of(Options, "s").format_help()
    for word in ("--config FILE", "how many (20000)", "how far, in % of nothing (0.5)", "which (22:2)", "--as-tuned"):
        assert word in told
