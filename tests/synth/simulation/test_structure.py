"""The diagrams of the loop, and how they are drawn.

Parts of the loop beside the step of a controller, and the wires between them; the parts as they are wired are tested
with the study of the structure.
The drawn block diagrams: every wire has its route, no route crosses a box or lies on another signal's.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import combinations, pairwise

import numpy as np
import pytest
from matplotlib.text import Text

from plant_models import Plant
from scripts.studies.structure.signals import SIGNALS
from synth.frame.picture.house_style import draw
from synth.retarder.loops.block_diagram import block_diagram, branches, in_mathtext, parting
from synth.retarder.loops.block_layout import (
    HEIGHT_IN,
    POINT_SENSOR_ROUTES,
    RADAR_ROUTES,
    SIZE_IN,
    WIDTH_IN,
    Place,
    Route,
    centre,
    corners,
)
from synth.simulation.controllers import TableController
from synth.simulation.passage_loop import close_passage_loop
from synth.simulation.structure.diagram import Diagram, Part, Sketch, Wire
from synth.simulation.structure.regulators import passage_diagram, radar_diagram
from tests.synth.simulation.passage_cases import CREDIBLE, SENSORS, braking_rule, with_approach
from tests.synth.test_control_system import table_for
from tuning_tables.programs.at_pulse import at_pulse
from tuning_tables.programs.held import NONE, HeldPassages
from tuning_tables.programs.tracker import begin_cut


@pytest.fixture(scope="module")
def radar(plant_52t: Plant) -> Diagram:
    return radar_diagram(plant_52t, TableController(table_for(plant_52t)), 0.03)


@pytest.fixture(scope="module")
def points(plant_52t: Plant) -> Diagram:
    plant = with_approach(plant_52t, 5.0)
    controller = braking_rule(plant, SENSORS, 3.0, CREDIBLE)
    return passage_diagram(close_passage_loop(plant, SENSORS, controller.stages), controller)


def given(part: Part, argument: str) -> object:
    return dict(part.given)[argument]


def test_the_parts_of_point_sensors_are_the_step_of_a_controller(points: Diagram) -> None:
    """РЭ2, РЭ3 and D(z) one after the other against `at_pulse` in Python, on pulse pairs of which many are believed."""
    rng, believed, changed = np.random.default_rng(4), 0, 0
    rule = given(points["digital controller"], "law")
    assert isinstance(rule, HeldPassages)
    for _ in range(100):
        state, stage = np.zeros(6, dtype=np.float32), 2
        begin_cut(state)
        signals: dict[str, object] = {"believed": state.copy(), "z": 0.0, "U[n]": stage}
        for _ in range(10):
            since_s, over_s = float(rng.uniform(0.1, 2.0)), 1e-4 * int(rng.integers(250, 900))
            signals.update({"m[n]": int(rng.integers(0, 6)), "Δt[n]": since_s, "t_V[n]": over_s})
            signals.update(points["relay element of the speed"].run(signals))
            signals.update(points["relay element of the path"].run(signals))
            if signals["S*[n]"] != NONE:
                believed += 1
                signals.update(points["digital controller"].run(signals))
            before, stage = stage, at_pulse(rule, state, int(str(signals["m[n]"])), since_s, over_s, stage, True)
            changed += stage != before
            assert signals["U[n]"] == stage
            np.testing.assert_allclose(state, np.asarray(signals["believed"]), rtol=3e-7)
    assert believed > 100
    assert changed > 20


def test_without_tracker_there_is_no_diagram(plant_52t: Plant) -> None:
    plant = with_approach(plant_52t, 5.0)
    told = braking_rule(plant, SENSORS, 3.0)
    with pytest.raises(ValueError, match="told its passages"):
        passage_diagram(close_passage_loop(plant, SENSORS, told.stages), told)


def test_the_interlock_of_the_entrance(plant_52t: Plant) -> None:
    plant = with_approach(plant_52t, 4.0, entrance_stage=2)
    part = radar_diagram(plant, TableController(table_for(plant_52t)), 0.0)["interlock of the entrance"]
    found = {(k, w, s): part.run({"U[n]": k, "D[n]": w, "S*[n]": s})["U[n]"] for k, w, s in
             [(1, 2, -1.0), (2, 3, -1.0), (3, 4, -1.0), (3, 2, -1.0), (2, 3, 0.0)]}  # fmt: skip
    assert list(found.values()) == [2, 2, 3, 2, 3]


@pytest.mark.parametrize("name", ["radar", "points"])
def test_the_lock_lasts_whole_periods_that_cover_the_transient(
    name: str, plant_52t: Plant, request: pytest.FixtureRequest
) -> None:
    diagram: Diagram = request.getfixturevalue(name)
    period, delay = (0.1, 0.02) if name == "radar" else (SENSORS.scan_period_s, SENSORS.computing_delay_s)
    position = plant_52t.position
    for stage in range(1, 5):
        history = position.pneumatics.respond(0.0 + 15.0, position.stage_pressures_kpa[stage], 50.0)
        found = diagram["lock"].run({"mode": 0, "U[n]": stage})
        assert found["locked"] == math.ceil((delay + history.duration_s) / period - 1e-9)
        assert diagram["lock"].run({"mode": found["mode"], "U[n]": stage}) == {"mode": found["mode"], "locked": 0}


@pytest.mark.parametrize("name", ["radar", "points"])
def test_every_signal_comes_from_a_part_or_is_chance(name: str, request: pytest.FixtureRequest) -> None:
    diagram: Diagram = request.getfixturevalue(name)
    assert set(diagram.outside) == {"z", "η", "ξ_cut"} | ({"z_b"} if name == "points" else set())
    after: dict[str, set[str]] = {}
    for wire in diagram.wires:
        after.setdefault(wire.source, set()).add(wire.target)
    loop = ["impulse element"]  # from there the signal must come round to every part that chance does not feed
    for part in loop:
        loop += sorted(after.get(part, set()) - set(loop))
    assert {part.name for part in diagram.parts} - set(loop) == {"slope of the pads"}


def test_the_diagrams_differ_in_measuring_and_deciding_alone(radar: Diagram, points: Diagram) -> None:
    """Figure 3 of the source: the schemes differ in the measuring block; the interlock is part of the rule here."""
    laws = [{part.name: part.law_name for part in each.parts} for each in (radar, points)]
    same = {name for name in laws[0] if laws[1].get(name) == laws[0][name]}
    measuring = {"impulse element", "relay element of the speed", "relay element of the path", "functional converter"}
    integrators = {"integrator of the speed", "integrator of the path"}
    assert {*laws[0], *laws[1]} - same == {
        *measuring, *integrators, "digital controller", "interlock of the entrance"
    }  # fmt: skip


def test_a_diagram_in_which_two_parts_give_a_signal_is_refused(radar: Diagram) -> None:
    converter = radar["converter"]
    with pytest.raises(ValueError, match="2 parts of the name converter"):
        Diagram("x", (*radar.parts, converter))
    with pytest.raises(ValueError, match="2 parts that give U_P"):
        Diagram("x", (*radar.parts, replace(converter, name="second converter")))
    with pytest.raises(KeyError, match="nothing"):
        radar["nothing"]


def test_a_wire_that_is_missing_shows(radar: Diagram) -> None:
    cut = Diagram("x", tuple(part for part in radar.parts if part.name != "zero-order hold"))
    assert "U_k" in cut.outside
    assert Wire("U_k", "", "comparison") in cut.wires


Routes = Mapping[tuple[str, str], Route]


@pytest.fixture(scope="module")
def drawn(plant_52t: Plant) -> dict[str, tuple[Sketch, Routes]]:
    plant = with_approach(plant_52t, 5.0)
    controller = braking_rule(plant, SENSORS, 3.0, CREDIBLE)
    points = passage_diagram(close_passage_loop(plant, SENSORS, controller.stages), controller)
    radar = radar_diagram(plant_52t, TableController(table_for(plant_52t)), 0.0)
    return {"radar": (radar.sketch, RADAR_ROUTES), "points": (points.sketch, POINT_SENSOR_ROUTES)}


KINDS = pytest.mark.parametrize("kind", ["radar", "points"])


@KINDS
def test_every_wire_has_a_route_and_every_route_a_wire(drawn: dict[str, tuple[Sketch, Routes]], kind: str) -> None:
    diagram, routes = drawn[kind]
    assert {(wire.signal, wire.target) for wire in diagram.wires} == set(routes)
    assert len(diagram.wires) == len(routes)


@KINDS
def test_every_signal_on_a_wire_has_a_meaning(drawn: dict[str, tuple[Sketch, Routes]], kind: str) -> None:
    diagram, _ = drawn[kind]
    assert {wire.signal for wire in diagram.wires} - set(SIGNALS) == set()


def inside(a: Place, b: Place, name: str) -> float:
    """Length of the stretch from a to b within the box of a part, its border not counted."""
    x, y = centre(name)
    low = max(min(a[0], b[0]), x - 0.5 * WIDTH_IN), max(min(a[1], b[1]), y - 0.5 * HEIGHT_IN)
    high = min(max(a[0], b[0]), x + 0.5 * WIDTH_IN), min(max(a[1], b[1]), y + 0.5 * HEIGHT_IN)
    on_border = (a[0] == b[0] and abs(abs(a[0] - x) - 0.5 * WIDTH_IN) < 1e-9) or (
        a[1] == b[1] and abs(abs(a[1] - y) - 0.5 * HEIGHT_IN) < 1e-9
    )
    return 0.0 if on_border or low[0] > high[0] or low[1] > high[1] else high[0] - low[0] + high[1] - low[1]


def stretches(diagram: Sketch, routes: Routes) -> Iterator[tuple[str, str, Place, Place]]:
    """(signal, source, from, to) of every straight stretch."""
    for wire in diagram.wires:
        for a, b in pairwise(corners(wire.source, wire.target, routes[wire.signal, wire.target])):
            yield wire.signal, wire.source, a, b


@KINDS
def test_wires_run_along_the_axes_and_through_no_box(drawn: dict[str, tuple[Sketch, Routes]], kind: str) -> None:
    diagram, routes = drawn[kind]
    for signal, _, a, b in stretches(diagram, routes):
        assert a != b, signal
        assert a[0] == pytest.approx(b[0]) or a[1] == pytest.approx(b[1]), (signal, a, b)
        for x, y in (a, b):
            assert 0.0 < x < SIZE_IN[0]
            assert 0.0 < y < SIZE_IN[1] - 0.5
        for part in diagram.boxes:
            assert inside(a, b, part.name) < 1e-9, (signal, part.name)


def together(a: Place, b: Place, c: Place, d: Place) -> float:
    """Length over which the stretches a–b and c–d lie on each other."""
    for along, across in ((0, 1), (1, 0)):
        if max(abs(p[across] - a[across]) for p in (b, c, d)) < 1e-9:
            low, high = (
                max(min(a[along], b[along]), min(c[along], d[along])),
                min(max(a[along], b[along]), max(c[along], d[along])),
            )
            return max(0.0, high - low)
    return 0.0


@KINDS
def test_no_signal_runs_on_the_line_of_another(drawn: dict[str, tuple[Sketch, Routes]], kind: str) -> None:
    for (one, _, a, b), (other, _, c, d) in combinations(stretches(*drawn[kind]), 2):
        if one != other:
            assert together(a, b, c, d) < 1e-9, (one, other)


def test_what_these_rules_are_to_find_they_find() -> None:
    x, y = centre("converter")
    assert inside((x - 3.0, y), (x + 3.0, y), "converter") == pytest.approx(WIDTH_IN)
    assert together((0.0, 1.0), (5.0, 1.0), (3.0, 1.0), (9.0, 1.0)) == 2.0
    assert together((0.0, 1.0), (5.0, 1.0), (3.0, 2.0), (9.0, 2.0)) == 0.0


@KINDS
def test_a_diagram_is_drawn_the_same_again(drawn: dict[str, tuple[Sketch, Routes]], kind: str) -> None:
    first, second = (draw(block_diagram(*drawn[kind], "subject")) for _ in range(2))
    assert first == second
    assert b"<svg" in first[:500]
    shown = block_diagram(*drawn[kind]).findobj(Text)
    texts = {each.get_text() for each in shown if isinstance(each, Text)}
    for part in drawn[kind][0].boxes:
        assert any(part.name in text.replace("\n", " ") for text in texts), part.name
    for wire in drawn[kind][0].wires:
        assert in_mathtext(wire.signal) in texts, wire


def test_wires_of_one_signal_branch_with_a_dot(drawn: dict[str, tuple[Sketch, Routes]]) -> None:
    diagram, routes = drawn["radar"]
    found = branches(diagram, routes)
    assert len(found) == 2  # of U[n] behind the interlock and of P under the drive
    assert parting([(0.0, 0.0), (2.0, 0.0), (2.0, 1.0)], [(0.0, 0.0), (3.0, 0.0)]) == (2.0, 0.0)
    assert parting([(0.0, 0.0), (2.0, 0.0), (2.0, 1.0)], [(0.0, 0.0), (2.0, 0.0), (2.0, -1.0)]) == (2.0, 0.0)


@pytest.mark.parametrize(
    ("symbol", "shown"),
    [
        ("РЭ1", "РЭ1"),
        ("locked", "locked"),
        ("V*[n]", "$V^{*}[n]$"),
        ("P_in, T", r"$P_{\mathrm{in}},\ T$"),
        ("ε_U", r"$\varepsilon_{U}$"),
        ("φ{F⁻¹(S)}", r"$φ\{F^{-1}(S)\}$"),
    ],
)
def test_symbols_are_set_as_mathematics(symbol: str, shown: str) -> None:
    assert in_mathtext(symbol) == shown
