"""An identified configuration reads back with its numbers and their origins; what was not told stays assumed."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from plant_models.library import POSITIONS
from scripts.studies.identification.truths import text_of_classes
from synth.cli.type_template import type_toml
from synth.frame.input_error import InputError
from synth.logs import unknowns as asked
from synth.logs.estimate import Estimate
from synth.logs.fitting_passes import FittingPasses
from synth.logs.identifiability import findings_of
from synth.logs.identified_config import identified
from synth.retarder.configuration.config_file import ConfigSource, config_source, load_config, parse_config

OWN = """library = ["types/"]
[position]
name = "our-site"
[[cut]]
label = "light"
car = "gondola-4"
mass_t = 22.0
targets_m_s = [3.0]
"""


def written(source: ConfigSource, folder: Path) -> Path:
    """The configuration as files."""
    for name, content in source.files("config.toml").items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(content)
    return folder / "config.toml"


def test_numbers_come_back_with_their_origin(passes: FittingPasses, found: Estimate, tmp_path: Path) -> None:
    (tmp_path / "asked.toml").write_text(text_of_classes(), encoding="utf-8")
    source = config_source(tmp_path / "asked.toml")
    new = identified(source, found, "80 passes")
    again = load_config(written(new, tmp_path / "out"))
    known = {value.key: value for value in again.parameters}
    assert again.sha256 == new.resolved().sha256
    for finding in findings_of(found):
        if finding.key in known and finding.identified:
            value = known[finding.key]
            assert value.value == pytest.approx(finding.value, rel=1e-5)
            assert value.source.startswith("identified from 80 passes, 95 % interval ")
            assert not value.assumed
        elif finding.key in known:
            assert known[finding.key].assumed
    means = {cut.cut.category: cut.resistance.mean_n_per_kn for cut in again.cuts}
    for category, mean in means.items():
        assert mean == pytest.approx(found.values[asked.RESISTANCE + category], rel=1e-5)


def test_own_types_go_with_the_configuration(passes: FittingPasses, found: Estimate, tmp_path: Path) -> None:
    (tmp_path / "types" / "positions").mkdir(parents=True)
    (tmp_path / "types" / "positions" / "our-site.toml").write_text(type_toml(POSITIONS, None), encoding="utf-8")
    (tmp_path / "own.toml").write_text(OWN, encoding="utf-8")
    source = config_source(tmp_path / "own.toml")
    path = written(identified(source, found, "80 passes"), tmp_path / "elsewhere")
    assert load_config(path).retarder.name == "our-site"
    assert tomllib.loads(path.read_text(encoding="utf-8"))["library"] == ["types/"]


def test_a_source_of_a_number_that_the_file_does_not_set_is_refused() -> None:
    text = '[friction]\ncommon_cv = 0.2\n[sources]\n"friction.path_std" = "measured"\n'
    with pytest.raises(InputError, match=r"sources has 'friction.path_std', which this file sets to no value"):
        parse_config(text, "my.toml")


def test_a_source_takes_the_place_of_the_assumption() -> None:
    text = '[friction]\ncommon_cv = 0.2\n[sources]\n"friction.common_cv" = "our log of May"\n'
    (value,) = (v for v in parse_config(text, "my.toml").parameters if v.key == "friction.common_cv")
    assert (value.source, value.assumed) == ("our log of May", False)
