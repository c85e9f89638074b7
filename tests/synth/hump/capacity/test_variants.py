"""Changes to a trial by key: every combination, in order, and nothing else of the trial."""

from __future__ import annotations

import tomllib

import pytest

from synth.frame.input_error import InputError
from synth.hump.capacity.variants import KeyValues, changed_text, key_values, variants

TEXT = """hump = "medium"
[weather]
head_wind_mean_m_s = 1.0
head_wind_std_m_s = 2.0
[[position]]
number = 2
exit_std_m_s = 0.1
"""


def test_every_combination_is_told_by_its_values_and_changes_its_keys() -> None:
    both = KeyValues("exit_std_m_s", ("position.1.exit_std_m_s", "position.2.exit_std_m_s"), (0.3, 0.1))
    found = variants([both, key_values("weather.head_wind_mean_m_s = 0, 6")])
    assert [dict(each.told) for each in found] == [
        {"exit_std_m_s": std, "weather.head_wind_mean_m_s": wind} for std in (0.3, 0.1) for wind in (0, 6)
    ]
    assert found[1].name == "exit_std_m_s 0.3, weather.head_wind_mean_m_s 6"
    tree = tomllib.loads(changed_text(TEXT, "trial.toml", found[1].changes))
    assert tree == tomllib.loads(TEXT) | {
        "weather": {"head_wind_mean_m_s": 6, "head_wind_std_m_s": 2.0},
        "position": [{"number": 2, "exit_std_m_s": 0.3}, {"number": 1, "exit_std_m_s": 0.3}],
    }


def test_without_a_key_it_is_the_trial_as_it_is() -> None:
    (only,) = variants([])
    assert only.name == ""
    assert tomllib.loads(changed_text(TEXT, "trial.toml", only.changes)) == tomllib.loads(TEXT)


def test_values_are_those_of_toml_and_other_words_are_text() -> None:
    assert key_values("a.b=1,0.5,true,pair-by-pair").values == (1, 0.5, True, "pair-by-pair")
    for word in ("1979-05-27", "9" * 5000, "[" * 5000, "[1]"):
        assert key_values(f"a.b={word}").values == (word,)


@pytest.mark.parametrize("words", ["weather", "=1", "weather.x=", f"{'a.' * 5000}b=1"])
def test_what_is_no_key_with_values_is_refused(words: str) -> None:
    with pytest.raises(InputError, match="must be a key and its values"):
        key_values(words)


@pytest.mark.parametrize(
    ("key", "said"),
    [
        ("position.first.exit_std_m_s", "its number"),
        (f"position.{'9' * 5000}.exit_std_m_s", "its number"),
        ("hump.x", "hump is no table of keys"),
    ],
)
def test_a_key_that_cannot_be_is_refused(key: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        changed_text(TEXT, "trial.toml", {key: 1.0})
