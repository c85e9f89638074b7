"""The parts as they are wired give the simulator's pass; the documents show the parts that there are."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from plant_models import Approach, Plant
from scripts.studies.document_parts import pictures_of
from scripts.studies.documents import DATA, KEPT, result_of, stale, written
from scripts.studies.structure.study import SENSORS, WIRED_TOLERANCE_M_S, Structure, energy_rule, part_rows, passage_run
from scripts.studies.structure.wired_radar import first_time, wired_radar_pass
from synth.frame.faults import InputError
from synth.retarder.configuration.config_file import load_config
from synth.simulation.controllers import TableController
from synth.simulation.nominal_response import nominal_entry_m_s, nominal_pass, nominal_plant, response_difference
from synth.simulation.passage_loop import close_passage_loop
from synth.simulation.structure.diagram import Diagram, Part
from synth.simulation.structure.regulators import passage_diagram, radar_diagram
from tests.synth.test_control_system import table_for

ROOT = Path(__file__).parents[2]
PICTURES = Path("docs/pictures")


def apart_m_s(plant: Plant, change: Callable[[Diagram], Diagram], entry_u: float = 0.5) -> float:
    """Largest difference of speed between the simulator's pass and the parts of a changed diagram."""
    nominal, controller = nominal_plant(plant), TableController(table_for(plant))
    diagram = change(radar_diagram(nominal, controller, 0.05))
    wired = wired_radar_pass(diagram, nominal, controller, nominal_entry_m_s(nominal, entry_u))
    found = response_difference(wired, nominal_pass(nominal, controller, entry_u, 0.5))
    return max(abs(found.largest_m_s), abs(found.exit_m_s))


def with_part(diagram: Diagram, name: str, change: Callable[[Part], Part]) -> Diagram:
    return replace(diagram, parts=tuple(change(part) if part.name == name else part for part in diagram.parts))


@pytest.mark.parametrize("entry_u", [0.1, 0.9])
def test_the_parts_of_a_radar_give_the_simulators_pass(plant_52t: Plant, entry_u: float) -> None:
    assert apart_m_s(plant_52t, lambda diagram: diagram, entry_u) < WIRED_TOLERANCE_M_S


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("computing delay", lambda part: replace(part, given=(("computing_delay_s", 0.04),))),
        ("relay element of the pressure", lambda part: replace(part, given=(("band_kpa", 10.0),))),
        ("valve delay", lambda part: replace(part, takes=(*part.takes[:2], ("new_kpa", "U_P")))),
        ("dead zone of the pads", lambda part: replace(part, takes=(("pressure_kpa", "U_k"),))),
        ("relay element of the speed", lambda part: replace(part, law=lambda v, z, sensor: v + 0.3)),
    ],
)
def test_another_number_wire_or_part_gives_another_pass(
    plant_52t: Plant, name: str, change: Callable[[Part], Part]
) -> None:
    """So a pass that agrees says something of every one of them."""
    assert apart_m_s(plant_52t, lambda diagram: with_part(diagram, name, change)) > 1e-5


@pytest.mark.parametrize("entry_u", [0.1, 0.9])
def test_the_parts_of_point_sensors_give_the_simulators_pass(plant_52t: Plant, entry_u: float) -> None:
    plant = nominal_plant(replace(plant_52t, approach=Approach(-SENSORS.path_m[0])))
    sensors = replace(SENSORS, timer_noise_s=0.0, base_tolerance=0.0)
    rule = energy_rule(plant, sensors, 3.0)
    found = passage_run(close_passage_loop(plant, sensors, rule.stages), rule, entry_u)
    assert found.same_commands
    assert found.commands >= 1
    assert found.wired_apart_m_s < WIRED_TOLERANCE_M_S
    assert found.wired_m_s == pytest.approx(found.simulated_m_s, abs=WIRED_TOLERANCE_M_S)


def test_the_first_time_is_found_by_halving() -> None:
    assert first_time(lambda x: x >= 0.3, 1.0) == 0.3
    assert first_time(lambda x: x > 2.0, 1.0) == 1.0
    assert first_time(lambda x: True, 1.0) < 1e-15


def test_the_documents_show_the_parts_that_there_are() -> None:
    """The kept result against diagrams declared now, for the plant of the study; a rule is not part of what is kept."""
    found = result_of(ROOT, "structure").findings
    assert isinstance(found, Structure)
    config = load_config(None)
    _, plant = config.plants()[len(config.plants()) // 2]
    radar = radar_diagram(plant, TableController(table_for(plant)), 0.0)
    ahead = replace(plant, approach=Approach(-SENSORS.path_m[0], plant.approach.entrance_stage))
    rule = energy_rule(ahead, SENSORS, 3.0)
    points = passage_diagram(close_passage_loop(ahead, SENSORS, rule.stages), rule)
    assert found.config_sha256 == config.sha256
    assert found.radar == part_rows(radar)
    assert found.point_sensors == part_rows(points)
    assert (found.radar_sketch, found.point_sensor_sketch) == (radar.sketch, points.sketch)
    assert found.faults() == ()


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    for folder in (KEPT, DATA):
        shutil.copytree(ROOT / folder, tmp_path / folder)
    (tmp_path / PICTURES).mkdir()
    (tmp_path / "README.md").write_text("nothing\n", encoding="utf-8")
    return tmp_path


def test_a_stale_picture_is_found_and_drawn_anew(checkout: Path) -> None:
    page = checkout / "docs" / "page.md"
    page.write_text("<!-- picture structure radar -->\n![text](pictures/structure-radar.svg)\n", encoding="utf-8")
    file = checkout / PICTURES / "structure-radar.svg"
    told = [
        "docs/pictures/structure-radar.svg: this is not the picture that docs/studies/structure.json gives; "
        "'retarder-synth study --document' writes them"
    ]
    assert stale(checkout) == told
    assert written(checkout) == [file]
    assert stale(checkout) == []
    assert written(checkout) == []
    drawn = file.read_text(encoding="utf-8")
    assert drawn == (ROOT / PICTURES / "structure-radar.svg").read_text(encoding="utf-8")
    file.write_text(drawn.replace("drawn: ", "drawn: 0"), encoding="utf-8")
    assert stale(checkout) == told


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("<!-- picture structure radar -->\n![text](radar.svg)\n", "must show structure-radar.svg"),
        ("<!-- picture structure radar -->\n\n![text](structure-radar.svg)\n", "must show structure-radar.svg"),
    ],
)
def test_a_picture_that_is_not_shown_is_told(tmp_path: Path, text: str, sentence: str) -> None:
    page = tmp_path / "page.md"
    page.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=sentence):
        list(pictures_of(page))


def test_a_picture_that_a_study_has_not_is_told(checkout: Path) -> None:
    page = checkout / "docs" / "page.md"
    page.write_text("<!-- picture structure other -->\n![text](structure-other.svg)\n", encoding="utf-8")
    with pytest.raises(InputError, match="has no picture 'other'; it has radar, point-sensors"):
        written(checkout)
