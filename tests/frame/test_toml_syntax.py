"""Texts that are no TOML: the mistakes that people make are told with their line and remedy, and all at once."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from synth.frame.input_error import InputError
from synth.frame.settings.toml_file import read_text, read_toml, toml_tree
from synth.frame.settings.toml_syntax import MOST_FAULTS

MISTAKES = [
    ("a = 0,6", "a = 0.6", "0,6 is no number of TOML; write 0.6, with a decimal point"),
    ("a = { b = 0,6, c = 2 }", "a = { b = 0.6, c = 2 }", "0,6 is no number"),
    ("a = { b = -1,25 }", "a = { b = -1.25 }", "-1,25 is no number of TOML; write -1.25"),
    ("a = { b = 1 c = 2 }", "a = { b = 1, c = 2 }", "a comma is missing before 'c = 2 }'"),
    ("a = [[0, 1] [2, 3]]", "a = [[0, 1], [2, 3]]", "a comma is missing before '[2, 3]]'"),
    ("a = [[0, 1], [2, 3]\nb = 3", "a = [[0, 1], [2, 3]]\nb = 3", "the list before 'b = 3' is not closed; add ]"),
    ("a = { b = 1,\nc = 2 }", "a = { b = 1, c = 2 }", "a table in { } must end on its line"),
    ("a = { b = 1, }", "a = { b = 1 }", "take the comma before } out"),
    ("a = knp-5-bunch", 'a = "knp-5-bunch"', 'words need quotes: write "knp-5-bunch"'),
    ("a = “knp-5”", 'a = "knp-5"', 'write "knp-5", with straight quotes'),
    ("a = True", "a = true", "True must be written true"),
    ("a = .5", "a = 0.5", ".5 must be written 0.5"),
    ("a = 5.", "a = 5.0", "nothing stands behind the decimal point; write .0"),
    ("a = −5", "a = -5", "the sign before this number is a dash; write -"),
    ("a = 5 m", "a = 5", "m stands behind a number; the key tells the unit"),
    ("a = 4‰", "a = 4", "‰ stands behind a number"),
    ("a == 3", "a = 3", "write one = behind a key"),
    ("a : 3", "a = 3", "write = behind a key, not a colon"),
]
"""A mistake, what is meant, and what is told."""

UNKNOWN = [
    ("a = 1\na = 2", "line 2: this key is there before; keep one of the two"),
    ("[a]\n[b]\n[a]", "line 3: this table is there before; put the two together"),
    ('a = "b\n', "line 1: a quote is missing at the end of this line"),
    ("a =\n", "this is not valid TOML: Invalid value (at line 1"),
    ("a = [1,2", "this is not valid TOML: Unclosed array"),
]
"""What nobody can mend."""


@pytest.mark.parametrize(("wrong", "meant", "words"), MISTAKES)
def test_a_mistake_is_told_with_its_remedy(wrong: str, meant: str, words: str) -> None:
    read = read_toml(f"first = 1\n{wrong}\nlast = 2\n", "my.toml")
    (sentence,) = read.faults
    line = 3 if "not closed" in words else 2
    assert sentence.startswith(f"my.toml, line {line}: {words}")
    assert read.tree == tomllib.loads(read.text) == tomllib.loads(f"first = 1\n{meant}\nlast = 2\n")
    with pytest.raises(InputError):
        toml_tree(f"{wrong}\n", "my.toml")


@pytest.mark.parametrize(("wrong", "words"), UNKNOWN)
def test_what_was_meant_is_not_guessed(wrong: str, words: str) -> None:
    read = read_toml(wrong, "my.toml")
    assert (read.tree, len(read.faults)) == (None, 1)
    assert words in read.faults[0]


def test_all_mistakes_of_a_text_are_told_at_once() -> None:
    wrong = [text.replace("a", f"a{number}", 1) for number, (text, _, _) in enumerate(MISTAKES)]
    read = read_toml("\n".join(wrong), "my.toml")
    assert len(read.faults) == len(MISTAKES)
    assert len(read_toml("a = 0,6\n" * 200, "my.toml").faults) <= MOST_FAULTS


def test_a_mark_of_an_editor_at_the_beginning_is_read_over(tmp_path: Path) -> None:
    file = tmp_path / "my.toml"
    file.write_bytes(b"\xef\xbb\xbfa = 1\n")
    assert toml_tree(read_text(file), "my.toml") == {"a": 1}
