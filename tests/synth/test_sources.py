"""Sources: what is cited anywhere is an entry that a reader can look up, and nothing else is given for an origin."""

from __future__ import annotations

import re
from importlib.resources import files
from pathlib import Path

import pytest

from plant_models import PlantError
from plant_models.library import load_car, load_position, position_names, sources, sources_cited_in
from plant_models.library.source import CITATION, sources_from_toml
from plant_models.library.sourced_value import SourcedValue
from synth.retarder.configuration.config_file import default_config_toml

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "reference" / "sources.md").read_text(encoding="utf-8")
PAGES = {
    path.name: path.read_text(encoding="utf-8") for path in (ROOT / "docs").rglob("*.md") if path.parent.name != "data"
}
LIBRARY = [path for path in (ROOT / "plant_models" / "library").rglob("*.toml") if path.name != "sources.toml"]

NOBODY_CAN_OPEN = re.compile(
    r"""(?i:domain[ -]facts|yard[ -]facts|["']memory: |\bfrom memory\b|\bpilot (study|prototype)\b)|\bS[0-4]\b"""
)


def test_every_citation_is_an_entry_and_every_entry_is_cited() -> None:
    entries = {source.name for source in sources()}
    in_library = {name for path in LIBRARY for name in CITATION.findall(path.read_text(encoding="utf-8"))}
    in_init = {name for r in position_names() for name in CITATION.findall(default_config_toml(r))}
    linked = {name for text in PAGES.values() for name in re.findall(r"sources\.md#([\w-]+)", text)}
    assert len(in_library) > 5
    assert in_library | in_init | linked == entries


def test_the_page_has_the_entries_of_the_library_in_full() -> None:
    heads = re.findall(r"^### (.+)$", PAGE, re.MULTILINE)
    assert heads == [source.name for source in sources()]
    for source, text in zip(sources(), PAGE.split("\n### ")[1:], strict=True):
        words = " ".join(text.replace("*", "").split())
        for part in (source.author, source.title, source.year, source.where):
            assert part in words, source.name


def test_a_link_in_a_page_that_looks_like_a_citation_leads_to_an_entry() -> None:
    for name, text in PAGES.items():
        defined = set(re.findall(r"^\[([\w-]+)\]: \S*#\1$", text, re.MULTILINE))
        assert set(CITATION.findall(text)) == defined, name


def test_init_tells_every_source_that_it_cites() -> None:
    for retarder in position_names():
        text, listed = default_config_toml(retarder).split("# Sources, by the names in [brackets]:\n")
        cited = sources_cited_in([text])
        assert cited
        assert listed.splitlines() == [f"# [{source.name}] {source.reference}" for source in cited]


def test_nothing_shipped_gives_an_origin_that_nobody_can_open() -> None:
    folders = [ROOT / name for name in ("plant_models", "scripts", "synth", "tuning_tables", "docs")]
    shipped = [
        p for folder in folders for p in folder.rglob("*") if p.suffix in (".py", ".toml", ".md", ".c", ".h", ".st")
    ]
    assert len(shipped) > 300
    for path in (*shipped, ROOT / "README.md"):
        found = NOBODY_CAN_OPEN.search(path.read_text(encoding="utf-8"))
        assert found is None, f"{path}: {found}"


def test_a_range_that_leaves_nothing_open_is_called_fixed() -> None:
    car = {value.key: value for value in load_car("gondola-4").provenance}
    assert (car["length_m"].span, car["bogie_axle_offsets_m"].span) == ("fixed", "fixed")
    assert car["tare_t"].span == "22 to 23.5"
    for name in position_names():
        assert not any(value.fixed for value in load_position(name).provenance)
        for comment in re.findall(r"^#.*$", default_config_toml(name), re.MULTILINE):
            same = re.search(r"; (\S+) to (\S+);", comment)
            assert same is None or same[1] != same[2], comment


def test_a_list_without_numbers_has_its_range() -> None:
    value = SourcedValue("switches_m", (), "m", (1.0, 3000.0), "the user", "H")
    assert (value.fixed, value.span, value.in_range) == (False, "1 to 3000", True)


def test_a_faulty_list_of_sources_is_refused_by_name() -> None:
    good = files("plant_models.library").joinpath("sources.toml").read_text(encoding="utf-8")
    for old, new, said in (
        ('year = "2002"', "", r"sources\.toml: higham-2002: key year is missing"),
        ('year = "2002"', 'year = "2002"\nisbn = "0"', r"sources\.toml: higham-2002: unknown key isbn"),
        ('year = "2002"', "year = 2002", r"sources\.toml: higham-2002: year is 2002; it must be a non-empty string"),
    ):
        with pytest.raises(PlantError, match=said):
            sources_from_toml(good.replace(old, new))
