"""Pictures of a tune.

Every picture of a book, drawn in this process.
Every picture is drawn without a warning, as PNG and SVG, with the same bytes for the same case.
"""

from __future__ import annotations

import pickle
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.patches import StepPatch
from matplotlib.text import Text

from synth.frame.exhibits import Chart
from synth.frame.picture.house_style import MATHEMATICS, draw, figure_files, logarithmic_y, new_figure
from synth.frame.picture.picture import Picture, picture_files
from synth.frame.picture.studio import draw_chart
from synth.retarder.case_result import CaseResult
from synth.retarder.pictures.accuracy import feasibility, rms_by_controller
from synth.retarder.pictures.exits import case_picture, exit_density
from synth.retarder.pictures.stage_panels import colour_of, command_image, outcome, parts_in_stage
from synth.retarder.pictures.table_picture import Passes, table_lines, table_passes, table_surfaces
from synth.retarder.shown.pictures import accuracy_charts, case_chart, case_pictures
from synth.retarder.shown_case import NEAR_M_S, bin_edges_m_s, predicted_density, shown_case
from synth.retarder.tuned_case import by_class, file_stem
from synth.simulation.passes import ExitSample
from tests.synth.case_factory import make_case, make_policy_map


def all_pictures(cases: Sequence[CaseResult], limit_m_s: float) -> Iterator[Picture]:
    """In the order of the report; each is drawn when it is asked for."""
    for each in (*accuracy_charts(cases, limit_m_s), *case_pictures(cases)):
        if isinstance(each, Chart):
            yield Picture(each.name, "", each.title, each.caption, draw_chart(each))


ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def cases() -> list[CaseResult]:
    """Two classes, one of them infeasible at its lowest target."""
    return [
        make_case("лёгкая-22t", 2.0, stages=3),
        make_case("лёгкая-22t", 3.0, stages=3),
        make_case("heavy-85t", 2.0, stages=5, feasible=False),
        make_case("heavy-85t", 3.0, stages=5, spread=0.07),
    ]


def passes_of(case: CaseResult) -> Passes:
    """The passes of a case as `plot` has them."""
    n = len(case.exit_speeds_m_s)
    speeds = case.exit_speeds_m_s.astype(float)
    sample = ExitSample(speeds, speeds == 0.0, np.zeros(n, np.int32), np.ones(n), case.exit_weight)
    return Passes(sample, case.traces)


FIGURES: dict[str, Callable[[list[CaseResult]], Figure]] = {
    "case_picture of three stages": lambda cases: case_picture(shown_case(cases[0])),
    "case_picture of an infeasible case": lambda cases: case_picture(shown_case(cases[2])),
    "table_lines of three stages": lambda cases: table_lines(cases[0].table, passes_of(cases[0])),
    "table_lines of five stages": lambda cases: table_lines(cases[2].table, None),
    "table_passes": lambda cases: table_passes(cases[0].table, passes_of(cases[0])),
    "exit_density": lambda cases: exit_density(cases[:2]),
    "exit_density of an infeasible case": lambda cases: exit_density(cases[2:3]),
    "rms_by_controller": lambda cases: rms_by_controller(cases, 0.1),
    "table_surfaces": lambda cases: table_surfaces(cases[2].table, None),
    "feasibility": feasibility,
}


@pytest.mark.parametrize("name", FIGURES)
def test_a_figure_gives_the_same_svg_twice(name: str, cases: list[CaseResult]) -> None:
    first, again = draw(FIGURES[name](cases)), draw(FIGURES[name](cases))
    assert first == again
    root = ElementTree.fromstring(first)
    assert root.tag == "{http://www.w3.org/2000/svg}svg"
    assert b"<dc:date>" not in first


PRINTABLE = "".join(map(chr, range(0x20, 0x7F))) + r" a $\frac{1}$ b $x^$, 5 $ and 6 $"


@pytest.mark.parametrize("name", FIGURES)
def test_any_text_of_a_picture_may_be_any_text(name: str, cases: list[CaseResult]) -> None:
    """Names and titles are the user's: a `$` in them is no mathematics."""
    figure = FIGURES[name](cases)
    texts = [text for text in figure.findobj(Text) if text.get_text()]
    for text in texts:
        text.set_text(PRINTABLE)
    draw(figure)
    assert len(texts) > 5
    assert not any(text.get_parse_math() for text in figure.findobj(Text))


def test_a_dollar_is_drawn_as_one() -> None:
    """Not as mathematics, which a text is only where it is marked as such."""
    drawn = [draw(new_figure(4.0, 1.0, title)) for title in ("5 $ and 6 $", "5  and 6 ")]
    assert drawn[0] != drawn[1]
    formula = new_figure(4.0, 1.0, "5 $ and 6 $")
    formula.texts[0].set_label(MATHEMATICS)
    assert draw(formula) != drawn[0]


def test_no_text_leaves_the_figure(cases: list[CaseResult]) -> None:
    for name, make in FIGURES.items():
        figure = make(cases)
        width, height = figure.get_size_inches() * figure.dpi
        draw(figure)
        children = [part for axes in figure.axes for part in (*axes.get_children(), axes.xaxis.label, axes.yaxis.label)]
        for text in (*figure.texts, *(part for part in children if isinstance(part, Text))):
            box = text.get_window_extent()
            if text.get_text():
                assert min(box.x0, box.y0, width - box.x1, height - box.y1) > -1.0, (name, text)


@pytest.mark.long
def test_hard_cases_are_drawn_too(cases: list[CaseResult]) -> None:
    hard = {
        "two stages, no passes, no baselines": replace(
            make_case(stages=2),
            traces=(),
            comparison=replace(cases[0].comparison, baselines=()),
        ),
        "errors wider than the picture": make_case(spread=1.5),
        "errors narrower than a cell": make_case(spread=0.0005),
        "nothing leaves": replace(
            cases[0],
            exit_speeds_m_s=np.zeros(100, np.float32),
            exit_weight=np.ones(100),
            predicted=replace(cases[0].predicted, probability=np.zeros(400), stalled=1.0),
        ),
    }
    assert {name: len(list(all_pictures([case], 0.1))) for name, case in hard.items()} == dict.fromkeys(hard, 3)


def test_a_figure_is_one_file(cases: list[CaseResult]) -> None:
    ((name, content),) = figure_files(feasibility(cases), "feasibility").items()
    assert name == "feasibility.svg"
    assert len(content) > 1000


def test_outer_panels_say_what_is_drawn(cases: list[CaseResult]) -> None:
    panels = table_lines(cases[1].table, None).axes
    stages = cases[1].plant.top_stage + 1
    assert sum(axes.get_ylabel() == "speed, m/s" for axes in panels) == 2
    assert sum(axes.get_xlabel().startswith("path") for axes in panels[:stages]) == (stages + 2) // 2


def test_the_picture_book_names_every_picture_once_and_every_case(cases: list[CaseResult]) -> None:
    pictures = list(all_pictures(cases, 0.1))
    names = [picture.name for picture in pictures]
    assert len(set(names)) == len(names) == 2 + len(cases)
    assert all(any(case.label in picture.title for picture in pictures) for case in cases)
    assert picture_files(pictures, "plots")[f"plots/{names[0]}.svg"] == pictures[0].svg


def test_the_map_shows_command_and_indifference_where_they_are(cases: list[CaseResult]) -> None:
    case = cases[1]
    policy = make_policy_map(case.plant, case.target_speed_m_s)
    image = command_image(policy, 1, (case.plant.start_m, case.plant.exit_m), (2.0, 6.9), (240, 200))
    up, down = image[-1, -1], image[0, -1]
    assert up[0] > up[2], "up is reddish"
    assert down[2] > down[0], "down is bluish"
    assert len(np.unique(image[:, : image.shape[1] // 4].reshape(-1, 4), axis=0)) == 4, "three commands and stripes"
    assert len(np.unique(image[:, image.shape[1] // 2 :].reshape(-1, 4), axis=0)) == 3


def test_every_part_of_a_pass_is_drawn_in_exactly_one_stage(cases: list[CaseResult]) -> None:
    trace = cases[0].traces[1]
    shown = [parts_in_stage((trace,), stage)[1][:-1] for stage in range(3)]
    segments = sum(int(np.count_nonzero(np.isfinite(v[1:]) & np.isfinite(v[:-1]))) for v in shown)
    assert segments == trace.speed_m_s.size - 1


def test_the_picture_of_a_case_shows_the_run_in_the_stages_in_force(cases: list[CaseResult]) -> None:
    """Every event of the run is drawn once, in the colour of its stage, beside the lines of that stage there."""
    case = cases[2]
    run, exits = case_picture(shown_case(case)).axes
    trace = case.traces[1]
    parts = shown_case(case).run
    events = trace.stage[:-1]
    assert [part.stage for part in parts] == [k for i, k in enumerate(events) if i == 0 or k != events[i - 1]]
    assert all(one.path_m[-1] == next_one.path_m[0] for one, next_one in pairwise(parts))
    assert [speed for part in parts for speed in part.speed_m_s[:-1]] == trace.speed_m_s[:-1].tolist()
    lines = case.table_lines
    for part in parts:
        lower = np.interp(part.lower.path_m, lines.nodes_m, lines.lower_m_s[part.stage])
        assert part.lower.speed_m_s == pytest.approx(lower)
        assert all(part.path_m[0] <= s <= part.path_m[-1] for s in part.upper.path_m + part.lower.path_m)
    drawn = [line for line in run.get_lines() if line.get_linewidth() == 2.2]
    assert [line.get_color() for line in drawn] == [colour_of(part.stage) for part in parts]
    assert exits.get_ylim() == pytest.approx((2.0 - NEAR_M_S, 2.0 + NEAR_M_S))


def test_the_picture_of_a_case_has_the_density_on_the_speed_axis(cases: list[CaseResult]) -> None:
    """The simulated histogram has the share of the cuts that leave where it is drawn; the line is the prediction."""
    case = cases[1]
    exits = case_picture(shown_case(case)).axes[1]
    (bars,) = (each for each in exits.patches if isinstance(each, StepPatch))
    values, edges, _ = bars.get_data()
    error = np.abs(case.exit_speeds_m_s - case.target_speed_m_s)
    share = case.exit_weight[error < edges[-1] - case.target_speed_m_s].sum() / case.exit_weight.sum()
    assert float((values * np.diff(edges)).sum()) == pytest.approx(share, abs=2e-3)
    speed, density = predicted_density(case.predicted)
    (line,) = (each for each in exits.get_lines() if len(np.asarray(each.get_xdata())) > 2)
    assert np.interp(3.0, np.asarray(line.get_ydata()), np.asarray(line.get_xdata())) == pytest.approx(
        np.interp(3.0, speed, density)
    )


def test_a_predicted_density_is_one_line_over_the_peak(cases: list[CaseResult]) -> None:
    """Its area is 1, its height that of the normal law of 0.04 m/s that it was made from; no gap within 3 of these."""
    target = cases[1].target_speed_m_s
    speed, density = predicted_density(cases[1].predicted)
    assert np.trapezoid(density, speed) == pytest.approx(1.0, abs=1e-3)
    assert density.max() == pytest.approx(1.0 / (0.04 * np.sqrt(2.0 * np.pi)), rel=0.02)
    for axes in exit_density(cases[1:2]).axes:
        drawn = [line for line in axes.get_lines() if len(np.asarray(line.get_xdata())) > 2]
        (line,) = drawn
        x, y = np.asarray(line.get_xdata()), np.asarray(line.get_ydata())
        assert np.isfinite(y[np.abs(x - target) < 3 * 0.04]).all()


def test_bins_and_limits_are_the_same_in_every_panel(cases: list[CaseResult]) -> None:
    edges = bin_edges_m_s(3.0, 6.6)
    assert np.all(np.diff(edges) > 0.0)
    assert edges[0] == 0.0
    assert edges[-1] > 6.6
    assert np.abs(edges - 3.0).min() == 0.0
    for axes in exit_density(cases[:2]).axes:
        dashed = sorted(
            float(np.asarray(line.get_xdata())[0]) for line in axes.get_lines() if line.get_linestyle() == "--"
        )
        assert len(dashed) == 2
        assert dashed[1] - dashed[0] == pytest.approx(0.6)
        assert axes.get_xlim()[0] < dashed[0] < dashed[1] < axes.get_xlim()[1]


def test_roles_and_names(cases: list[CaseResult]) -> None:
    found = cases[0].comparison
    assert found.best_baseline is not None
    assert found.best_baseline.name == "energy rule"
    assert [len(group) for group in by_class(cases)] == [2, 2]
    assert cases[2].unavoidable.obstacle == "brake saturated"
    assert file_stem("exit-density", "Four tanks, 3.5 m/s") == "exit-density-four-tanks-3.5-m-s"


@pytest.mark.parametrize("low", [0.01, 0.0197, 0.0201, 0.031, 0.0501, 0.07])
@pytest.mark.parametrize("ratio", [1.6, 2.9, 3.1, 3.7, 4.9, 20.0, 500.0])
def test_a_logarithmic_axis_has_two_marks_at_least(low: float, ratio: float) -> None:
    """One mark alone leaves the reader without a scale."""
    axes = Figure().subplots()
    logarithmic_y(axes, [low / 0.8, low * ratio / 1.25])
    marks = axes.yaxis.get_majorticklocs()
    assert 2 <= len(marks) <= 13
    assert low * (1.0 - 1e-9) <= marks.min() < marks.max() <= low * ratio * (1.0 + 1e-9)


def test_a_stalled_pass_is_called_so(cases: list[CaseResult]) -> None:
    assert outcome(replace(cases[0].traces[0], stalled=True)) == "stopped in the position"


def test_drawing_needs_neither_pyplot_nor_kernels(cases: list[CaseResult], tmp_path: Path) -> None:
    """Not even a chart that is handed to the process that draws it."""
    heavy = ("matplotlib.pyplot", "numba", "scipy", "pydantic", "control", "h5py")
    (tmp_path / "chart").write_bytes(pickle.dumps(case_chart(cases[0])))
    loaded = f"any(each in sys.modules for each in {heavy})"
    drawn = f"draw_chart(pickle.loads(pathlib.Path({str(tmp_path / 'chart')!r}).read_bytes()))"
    command = (
        "import pathlib, pickle, sys; from synth.frame.picture.studio import draw_chart; "
        f"{drawn}; raise SystemExit({loaded})"
    )
    assert subprocess.run([sys.executable, "-c", command], cwd=ROOT, timeout=60, check=False).returncode == 0
