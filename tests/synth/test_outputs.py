"""Pieces of what a tune leaves: drawing in processes, the directory, plain values of the summary."""

from __future__ import annotations

import math

import numpy as np
import pytest

from synth.book.forms.table_file import file_stem, is_infeasible
from synth.book.summary import plain
from synth.present.draw_pictures import Studio, draw_job
from tests.synth.case_factory import make_case


def test_pictures_do_not_depend_on_the_number_of_processes() -> None:
    jobs = [("case_pictures", (make_case(),)), ("class_pictures", ((make_case("heavy", 2.0),),))]
    with Studio(2) as studio:
        assert [drawn.result() for drawn in [studio.draw(job) for job in jobs]] == [draw_job(job) for job in jobs]


def test_a_fault_in_a_drawing_process_is_raised_here() -> None:
    with Studio(2) as studio, pytest.raises(AttributeError):
        studio.draw(("no_such_pictures", ())).result()


def test_few_pictures_are_drawn_here_in_the_order_of_the_book() -> None:
    with Studio(1) as studio:
        studio.case_done(make_case())
        names = [picture.name for picture in studio.book([make_case()], 0.1)]
    assert names[:2] == ["rms-by-controller", "feasibility"]
    assert names[-1] == "policy-map-gondola-36t-target-3-m-s"
    assert len(names) == 6


def test_values_of_the_summary_are_plain() -> None:
    value = {"a": (np.float64(0.5), math.nan, math.inf), "b": np.int32(3), "c": [True, None], "d": 2**60}
    assert plain(value) == {"a": [0.5, None, None], "b": 3, "c": [True, None], "d": str(2**60)}


def test_an_id_is_no_path() -> None:
    from dataclasses import replace

    table = make_case().table
    ids = ("../../etc/x", "a b/ц", ".hidden", "///")
    assert [file_stem(replace(table, id=name)) for name in ids] == ["etc-x", "a-b-ц", "hidden", "table"]


def test_only_the_summary_of_the_same_configuration_counts() -> None:
    table = make_case().table
    cases = [{"id": table.id, "feasible": False}]
    summary: dict[str, object] = {"generator": {"config_sha256": table.generator.config_sha256}, "cases": cases}
    assert is_infeasible(table, summary)
    assert not is_infeasible(table, {**summary, "generator": {"config_sha256": "0"}})
    assert not is_infeasible(table, {**summary, "cases": [{"id": "other", "feasible": False}]})
    assert not is_infeasible(table, None)
