"""Steps of studies that are small enough to be known: cases by name, the order of work side by side, criteria."""

from __future__ import annotations

import pytest

from scripts.studies.cases import class_cases, named_cases, of_masses
from scripts.studies.criteria.study import criteria
from scripts.studies.side_by_side import side_by_side
from synth.frame.input_error import InputError
from synth.problem.criterion import SQUARED_ERROR_CRITERION
from synth.retarder.configuration.config_file import load_config


def test_cases_are_found_by_mass_and_target() -> None:
    config = load_config(None)
    (light, heavy) = named_cases(config, ("22:2", "85:3.5"))
    assert (light.name, heavy.name) == ("22 t to 2 m/s", "85 t to 3.5 m/s")
    assert light.plant.cut.mass_t == 22.0
    assert [case.name for case in class_cases(config, (52.0,), ())] == [f"52 t to {v} m/s" for v in (2, 3, 4)]
    assert len(class_cases(config, (), (1.5,))) == 5


@pytest.mark.parametrize("word", ["22", "22:", ":2", "23:2", "22:2:2", "a:b"])
def test_a_wrong_case_is_told_with_the_masses_known(word: str) -> None:
    with pytest.raises(InputError, match=r"give MASS:TARGET as in 22:2, the mass one of 22, 36, 52, 66, 85 t"):
        named_cases(load_config(None), (word,))
    with pytest.raises(InputError, match=r"no cut of the configuration has 23 t; its masses are 22, 36, 52, 66, 85 t"):
        of_masses(load_config(None), (22.0, 23.0))


def test_work_side_by_side_keeps_its_order() -> None:
    assert side_by_side(lambda x: x * x, range(20), threads=3) == tuple(x * x for x in range(20))


def test_every_criterion_differs_from_the_default_in_one_thing() -> None:
    asked = criteria(SQUARED_ERROR_CRITERION)
    assert asked["default"] is SQUARED_ERROR_CRITERION
    for name, each in asked.items():
        changed = [key for key in vars(each) if getattr(each, key) != getattr(SQUARED_ERROR_CRITERION, key)]
        assert changed == {"default": [], "over-speed ×4": ["terminal"]}.get(name, ["requirement"])
