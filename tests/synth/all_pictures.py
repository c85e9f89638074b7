"""Every picture of a book, drawn in this process."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from synth.frame.exhibits import Chart
from synth.frame.picture.picture import Picture
from synth.frame.picture.studio import draw_chart
from synth.retarder.case_result import CaseResult
from synth.retarder.shown.pictures import accuracy_charts, case_pictures


def all_pictures(cases: Sequence[CaseResult], limit_m_s: float) -> Iterator[Picture]:
    """In the order of the report; each is drawn when it is asked for."""
    for each in (*accuracy_charts(cases, limit_m_s), *case_pictures(cases)):
        if isinstance(each, Chart):
            yield Picture(each.name, "", each.title, each.caption, draw_chart(each))
