"""Pieces of what a tune leaves: drawing in processes, names of files, the summary beside tables."""

from __future__ import annotations

from functools import partial

import pytest

from synth.frame.exhibits import Chart
from synth.frame.picture.studio import Studio, draw_chart
from synth.retarder.forms.table_file import file_stem, is_infeasible
from synth.retarder.shown.pictures import case_chart, feasibility
from tests.synth.case_factory import make_case


def test_drawings_do_not_depend_on_the_number_of_processes() -> None:
    charts = [case_chart(make_case()), case_chart(make_case("heavy", 2.0))]
    with Studio(2) as studio:
        studio.begin(charts[1])
        assert [each.result() for each in map(studio.drawing, charts)] == [draw_chart(each) for each in charts]


def test_a_fault_in_a_drawing_process_is_raised_here() -> None:
    with Studio(2) as studio, pytest.raises(ValueError, match="left cannot be"):
        studio.drawing(Chart("none", "", "", partial(feasibility, ()))).result()


def test_an_id_is_no_path() -> None:
    from dataclasses import replace

    table = make_case().table
    ids = ("../../etc/x", "a b/ц", ".hidden", "///")
    assert [file_stem(replace(table, id=name)) for name in ids] == ["etc-x", "a-b-ц", "hidden", "table"]


def test_only_the_summary_of_the_same_configuration_counts() -> None:
    table = make_case().table

    def summary(sha256: str, name: str) -> dict[str, object]:
        cases = [{"id": name, "verdict": "infeasible"}]
        return {"generator": {"config_sha256": sha256}, "tables": {"cases": cases}}

    assert is_infeasible(table, summary(table.generator.config_sha256, table.id))
    assert not is_infeasible(table, summary("0", table.id))
    assert not is_infeasible(table, summary(table.generator.config_sha256, "other"))
    assert not is_infeasible(table, None)
