"""The golden run asks every command, and its comparison tells every difference and no other."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import typer.main

from synth.cli.commands import app
from tests.golden.orders import INPUTS, ORDERS, Order
from tests.golden.record import Record, differences, document_of, leaves_of, recorded, records_of, write_inputs

NOT_ASKED = {"study", "bench"}
"""Studies have runs of their own, and go; a bench waits for a controller."""

BEFORE = Record(0, "a table\nof 3 rows\n", {"a.png": "01", "old/b.csv": "02"}, {"s.json: rms": 0.25, "s.json: n": 4})


def names_of(command: Any, name: str) -> set[str]:
    """Every command that can be typed."""
    children = getattr(command, "commands", None)
    if children is None:
        return {name}
    return {deep for each, child in children.items() for deep in names_of(child, f"{name} {each}".strip())}


def test_every_command_is_asked() -> None:
    names = names_of(typer.main.get_command(app), "")
    asked = {name for name in names for order in ORDERS if f"{order.words} ".startswith(f"{name} ")}
    assert names - asked == NOT_ASKED
    assert len(names) > 20


def test_every_configuration_is_read() -> None:
    words = {word for order in ORDERS for word in order.words.split()}
    assert set(INPUTS) <= words


def test_a_run_is_equal_to_itself(tmp_path: Path) -> None:
    order, runs = Order("hump export medium --format railml", "hump-railml"), []
    for name in ("first", "second"):
        (tmp_path / name).mkdir()
        write_inputs(tmp_path / name)
        runs.append({order.line: recorded(order, tmp_path / name)})
    assert runs[0][order.line].code == 0
    assert set(runs[0][order.line].files) == {"hump-railml/medium.railml"}
    assert list(differences(runs[0], runs[1], {})) == []
    assert records_of(document_of(runs[0])) == runs[0]


def test_leaves_have_places() -> None:
    document = {"cases": [{"rms": 0.1, "stalls": None}, {"rms": 0.2}], "kept": True}
    assert dict(leaves_of(document, "")) == {
        "cases.0.rms": 0.1, "cases.0.stalls": None, "cases.1.rms": 0.2, "kept": True
    }  # fmt: skip


def test_every_difference_is_told() -> None:
    changes = {
        "exit code 0 → 1": replace(BEFORE, code=1),
        "a.png: '01' → '03'": replace(BEFORE, files={**BEFORE.files, "a.png": "03"}),
        "c.csv is new": replace(BEFORE, files={**BEFORE.files, "c.csv": "04"}),
        "s.json: rms: 0.25 → 0.26": replace(BEFORE, leaves={**BEFORE.leaves, "s.json: rms": 0.26}),
        "s.json: n: 4 → 4.0": replace(BEFORE, leaves={**BEFORE.leaves, "s.json: n": 4.0}),
        "s.json: n is gone": replace(BEFORE, leaves={"s.json: rms": 0.25}),
    }
    for sentence, now in changes.items():
        assert list(differences({"tune": BEFORE}, {"tune": now}, {})) == [f"tune: {sentence}"]
    printed = replace(BEFORE, printed="a table\nof 4 rows\n")
    assert list(differences({"tune": BEFORE}, {"tune": printed}, {}))[1:] == ["tune: -of 3 rows", "tune: +of 4 rows"]
    assert list(differences({"tune": BEFORE}, {}, {})) == ["tune: only before"]


def test_what_was_renamed_is_the_same() -> None:
    now = replace(BEFORE, files={"a.png": "01", "new/b.csv": "02"})
    assert list(differences({"tune": BEFORE}, {"tune": now}, {"old/": "new/"})) == []
    assert len(list(differences({"tune": BEFORE}, {"tune": now}, {}))) == 2
