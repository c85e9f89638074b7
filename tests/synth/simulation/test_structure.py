"""Every named part of the loop alone, against its definition in the source; and the wires between them."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from plant_models import Plant
from plant_models.motion import braked_axles
from plant_models.valve_drive import ValveDrive
from synth.simulation.controllers import TableController
from synth.simulation.passage_loop import close_passage_loop
from synth.simulation.structure.diagram import Diagram, Wire
from synth.simulation.structure.part import Part
from synth.simulation.structure.passage_diagram import passage_diagram
from synth.simulation.structure.radar_diagram import radar_diagram
from tests.synth.simulation.passage_cases import CREDIBLE, SENSORS, braking_rule, with_approach
from tests.synth.test_control_system import table_for
from tuning_tables.programs.at_pulse import at_pulse
from tuning_tables.programs.passage_table import NONE, HeldPassages
from tuning_tables.programs.tracker import begin_cut
from tuning_tables.stage import Line
from tuning_tables.table import ControllerTable

VALVES = ValveDrive(700.0, 0.0, 0.1, 0.2, 0.15, 0.3, 0.4, 15.0, 50.0)


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


def test_the_impulse_element_of_a_radar_reads_once_every_period(radar: Diagram) -> None:
    times = [radar["impulse element"].run({"n": n})["tₙ"] for n in range(200)]
    assert times == pytest.approx(0.03 + 0.1 * np.arange(200), abs=1e-12)


def test_the_relay_element_of_a_radar_rounds_to_the_nearest_quantum(radar: Diagram) -> None:
    for v in np.linspace(0.0, 7.0, 1001):
        read = radar["relay element of the speed"].run({"V[n]": v, "z": 0.0})["V*[n]"]
        assert read / 0.04 == pytest.approx(round(read / 0.04), abs=1e-9)
        assert abs(read - v) <= 0.02 + 1e-12
    assert radar["relay element of the speed"].run({"V[n]": 1.0, "z": 2.0})["V*[n]"] == pytest.approx(1.12)


def test_the_path_has_the_precision_of_the_rule(radar: Diagram) -> None:
    read = radar["relay element of the path"].run({"S[n]": 12.3456789})["S*[n]"]
    assert read != 12.3456789
    assert abs(read - 12.3456789) <= 2.0**-24 * 16.0


def test_the_impulse_element_of_point_sensors_lets_through_at_both_coils(points: Diagram, plant_52t: Plant) -> None:
    """At every axle: where the first axle is when another is at a sensor."""
    places = sorted(place + behind for place in SENSORS.path_m for behind in plant_52t.cut.axle_offsets_m)
    met = [place for place in places if place < plant_52t.exit_m]
    assert given(points["impulse element"], "pulses").path_m.size == len(met) > len(SENSORS.path_m)  # type: ignore[attr-defined]
    for m, place in enumerate(met):
        found = points["impulse element"].run({"m": m, "z_b": -1.5})
        half = 0.1 * (1.0 - 1.5 * 0.002)
        assert (found["first coil"], found["second coil"]) == pytest.approx((place - half, place + half))


def test_the_relay_element_of_point_sensors_rounds_the_time(points: Diagram) -> None:
    for t in np.linspace(0.02, 0.4, 997):
        read = points["relay element of the speed"].run({"t_V[n]": t, "z": 0.0})["V*[n]"]
        counts = 0.2 / read / 1e-4
        assert counts == pytest.approx(round(counts), abs=1e-6)
        assert abs(0.2 / read - t) <= 0.5e-4 + 1e-12


def test_the_functional_converter_tells_when_a_place_is_reached(points: Diagram) -> None:
    """s(t) = v·t + a·t²/2 solved for t, in a single cell with a constant brake."""
    part = points["functional converter"]
    constants = {"edges_m": np.array([0.0, 100.0]), "free": np.array([0.05])}
    signals = {"p": 30.0, "B(S)": np.array([0.02]), "Δt": 99.0, "cell": 0, "S": 1.0, "V": 4.0, "coil": 6.0}
    a = 0.05 - 0.02 * 30.0
    assert part.run(signals, **constants)["F⁻¹(S)"] == pytest.approx((math.sqrt(16.0 + 2.0 * a * 5.0) - 4.0) / a)


def wanted_stage(table: ControllerTable, stage: int, s_m: float, v_m_s: float) -> int:
    """Stage by stage downward, or upward, as long as straight lines ask for the next."""
    lower, upper = ([None if line is None else line[0] + line[1] * s_m for line in side] for side in sides(table))
    if (above := upper[stage]) is not None and v_m_s > above:
        return next(k for k in range(stage + 1, len(upper)) if (line := upper[k]) is None or v_m_s <= line)
    if (below := lower[stage]) is not None and v_m_s < below:
        return next(k for k in range(stage - 1, -1, -1) if (line := lower[k]) is None or v_m_s >= line)
    return stage


def sides(table: ControllerTable) -> tuple[list[Line | None], list[Line | None]]:
    """The lower and the upper lines of all stages."""
    return [stage.lower for stage in table.stages], [stage.upper for stage in table.stages]


def test_the_controller_of_a_radar_compares_with_the_lines(radar: Diagram, plant_52t: Plant) -> None:
    rng, table = np.random.default_rng(3), table_for(plant_52t)
    asked = 0
    for _ in range(2000):
        s, v, k = rng.uniform(0.0, plant_52t.exit_m), rng.uniform(0.5, 7.0), int(rng.integers(0, 5))
        wanted = wanted_stage(table, k, s, v)
        asked += wanted != k
        found = radar["digital controller"].run({"U[n]": k, "S*[n]": s, "V*[n]": v})
        assert found == {"D[n]": wanted}
    assert asked > 500


def test_the_controller_of_point_sensors_counts_the_speeds_below(points: Diagram) -> None:
    """Equal rows for all stages: the stage wanted is the number of switching speeds under the reading.

    Where nothing is decided the stage in force is held.
    """
    part = points["digital controller"]
    law = given(part, "law")
    assert isinstance(law, HeldPassages)
    speeds, [heard], other = law.switching_m_s[3, 0], np.flatnonzero(law.deciding == 3), int(law.deciding.argmin())
    for v in np.linspace(0.5, 8.0, 301):
        wanted = part.run({"S*[n]": heard, "U[n]": 2, "V*[n]": v})["U[n]"]
        assert wanted == int(np.sum(np.float32(v) > speeds))
        assert part.run({"S*[n]": other, "U[n]": 2, "V*[n]": v})["U[n]"] == 2


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


def test_commands_are_delayed_made_impulses_and_held(radar: Diagram) -> None:
    """The held signal against a look-up of the last command whose delay has passed."""
    rng = np.random.default_rng(5)
    decided, stages = np.cumsum(rng.uniform(0.05, 1.0, 40)), rng.integers(0, 5, 40)
    signals: dict[str, object] = {"U*[n]": ((-math.inf, 0.0),)}
    for t, k in zip(decided.tolist(), stages.tolist(), strict=True):
        signals.update({"tₙ": t, "U_τ[n]": k})
        signals.update(radar["computing delay"].run(signals))
        signals.update(radar["ideal impulse element"].run(signals))
    for t in np.linspace(0.0, decided[-1] + 1.0, 500):
        before = np.flatnonzero(decided + 0.02 <= t)
        expected = 150.0 * stages[before[-1]] if before.size else 0.0
        assert radar["zero-order hold"].run({**signals, "t": t})["U_k"] == expected
    with pytest.raises(ValueError, match="comes after"):
        radar["ideal impulse element"].run({**signals, "tₙ + τ_c": 0.0})


def test_the_relay_of_the_pressure_has_a_dead_zone(radar: Diagram) -> None:
    shown = radar["converter"].run({"P": 250.0})["U_P"]
    assert shown == 250.0
    for stage, sign in ((300.0, 1), (265.001, 1), (265.0, 0), (250.0, 0), (235.0, 0), (234.999, -1), (0.0, -1)):
        error = radar["comparison"].run({"U_k": stage, "U_P": shown})["ε_U"]
        assert error == stage - 250.0
        assert radar["relay element of the pressure"].run({"ε_U": error})["sgn ε_U"] == sign


@pytest.mark.parametrize(("sign", "tends_to", "constant_s"), [(1, 700.0, 0.3), (-1, 0.0, 0.4), (0, 250.0, 1.0)])
def test_structure_and_link_are_an_aperiodic_link_or_an_integrator(
    radar: Diagram, sign: int, tends_to: float, constant_s: float
) -> None:
    """T·dP/dt = P_in − P by solve_ivp; closed on itself P_in is P, and nothing changes."""
    signals: dict[str, object] = {"sgn ε_U": sign, "P": 250.0}
    connection = radar["block of changing structure"].run(signals, drive=VALVES)["P_in, T"]
    assert connection == (tends_to, constant_s)
    times = [0.0, 0.1, 0.37, 0.5]
    solved = solve_ivp(
        lambda _, p: [((p[0] if sign == 0 else tends_to) - p[0]) / constant_s], (0.0, 0.5), [250.0],
        rtol=1e-10, atol=1e-9, t_eval=times,
    )  # fmt: skip
    for t, expected in zip(times, solved.y[0], strict=True):
        found = radar["pneumatic link"].run({"P": 250.0, "P_v, T": connection, "Δt": t})["P"]
        assert found == pytest.approx(expected, abs=1e-5)


@pytest.mark.parametrize(
    ("pressure", "stage", "delay"), [(51.0, 300.0, 0.1), (50.0, 300.0, 0.3), (0.0, 300.0, 0.3), (300.0, 0.0, 0.15)]
)
def test_the_valve_delay_is_that_of_the_source(radar: Diagram, pressure: float, stage: float, delay: float) -> None:
    """τ(P) = tZ2 for P > P0 and tZ2 + t00 for P ≤ P0; tZ0 to exhaust."""
    found = radar["valve delay"].run({"P": pressure, "U_k": stage}, drive=VALVES)["τ(P)"]
    assert found == pytest.approx(delay)


def test_the_pads_have_a_dead_zone_and_a_slope_by_braked_pairs(radar: Diagram, plant_52t: Plant) -> None:
    part = radar["dead zone of the pads"]
    assert [float(part.run({"P": p})["p"]) for p in (0.0, 50.0, 50.5, 300.0)] == [0.0, 0.0, 0.5, 250.0]
    slope = radar["slope of the pads"]
    path = given(slope, "path")
    middle = 0.5 * (path.edges_m[1:] + path.edges_m[:-1])  # type: ignore[attr-defined]
    pairs = braked_axles(plant_52t.position, plant_52t.cut, middle)
    signals = {"ξ_cut": np.array([0.8]), "η": np.zeros((1, 512), dtype=np.float32)}
    found = slope.run(signals)["B(S)"][0]
    expected = 0.8 * pairs * 20.0 / 550.0 / (52.0 + 0.42 * 4)
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-15)
    assert pairs.max() == 4


@pytest.mark.parametrize("name", ["radar", "points"])
def test_the_integrators_integrate(name: str, request: pytest.FixtureRequest) -> None:
    diagram: Diagram = request.getfixturevalue(name)
    constants = {"edges_m": np.array([0.0, 100.0]), "free": np.array([0.05])}
    signals = {"p": 30.0, "B(S)": np.array([0.02]), "Δt": 0.7, "cell": 0, "S": 1.0, "V": 4.0}
    a = 0.05 - 0.02 * 30.0
    assert diagram["integrator of the speed"].run(signals, **constants)["V"] == pytest.approx(4.0 + 0.7 * a)
    path = diagram["integrator of the path"].run(signals, **constants)["S"]
    assert path == pytest.approx(1.0 + 0.7 * 4.0 + 0.5 * a * 0.49)


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
