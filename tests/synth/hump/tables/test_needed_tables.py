"""What a book needs for a trial: the same text refuses a book that lacks it, and writes the configuration of one."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plant_models.library import BUILT_IN, CAR_MIXES, load_hump
from plant_models.library.hump_entry import hump_names
from synth.frame.faults import InputError
from synth.hump.book_needs import Entering, fewest_axles, fewest_classes
from synth.hump.configuration.trial_file import parse_trial_file
from synth.hump.control.train_population import TrainPopulation
from synth.hump.rolling.hump_routes import hump_routes
from synth.hump.rolling.table_hump_position import nearest_axles
from synth.hump.tables_configuration import (
    APART_ROOT_M_S,
    speeds_of,
    tables_toml,
    targets_m_s,
    without_books,
)
from synth.hump.trial.needed_tables import kinds_of_cuts
from synth.hump.trial.position_choice import HeldTables
from synth.hump.trial.resolved_trial import load_trial, resolve_trial
from synth.retarder.configuration.config_file import parse_config
from tests.effort import every, sized
from tests.synth.hump.control.test_sorting_list import drawn_list
from tests.system.conftest import changed

GRAPHS = {name: load_hump(name).graph for name in sorted(hump_names())}
POSITIONS = [
    (name, number)
    for name, graph in GRAPHS.items()
    for number in range(1, hump_routes(graph, graph.leads[0]).positions + 1)
]


def held_by(configuration: str) -> HeldTables:
    """What a book of this configuration would have."""
    config = parse_config(configuration, "tables.toml")
    kinds = frozenset((cut.cut.category, cut.cut.axles) for cut in config.cuts)
    return HeldTables(kinds, min(config.targets_m_s), max(config.targets_m_s))


@pytest.mark.parametrize(("hump", "number"), every(100, POSITIONS))
def test_the_printed_configuration_fits_its_trial(hump: str, number: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of every hump of the library: all cuts have a class, no class can be missed, and all targets are there that the
    position keeps cuts apart with below the speed of the fastest cuts."""
    monkeypatch.setattr("synth.hump.book_needs.CUTS", sized(160, 1000))
    trial, text = load_trial(Path(hump)), tables_toml(Path(hump), number)
    need, held = trial.needs[number - 1], held_by(text)
    assert need.missing_kinds(held, trial.categories) == set()
    for kind in held.kinds:
        fewer = HeldTables(held.kinds - {kind}, held.lowest_m_s, held.highest_m_s)
        assert need.missing_kinds(fewer, trial.categories)
    config = parse_config(text, "tables.toml")
    if need.lowest_m_s is None or need.highest_m_s is None:
        assert held.lowest_m_s == trial.settings.aim.lowest_m_s
    else:
        assert held.lowest_m_s == need.lowest_m_s
        assert held.highest_m_s == min(need.highest_m_s, config.entry.high_m_s - 0.1)
    assert config.retarder.name == trial.positions[number - 1].site


def test_all_cuts_that_are_drawn_are_of_the_kinds_that_are_needed(tmp_path: Path) -> None:
    """Of a mix of cars with different numbers of axles, whose cuts have all sums of them; nothing else is needed."""
    mixed = changed(BUILT_IN.file(CAR_MIXES, "usual").text, ("cars.tank-4", "cars.gondola-6"))
    (tmp_path / "mixed.toml").write_text(mixed, encoding="utf-8")
    text = 'hump = "dumper"\n[cars]\nmix = "mixed.toml"\n[trains]\ncuts = 900\nmost_cars = 2\ncars_mean = 2.0\n'
    config = resolve_trial(parse_trial_file(text, str(tmp_path / "trial.toml")))
    assert isinstance(config.trains, TrainPopulation)
    members = config.categories.members
    places = {member.number: place for place, member in enumerate(members)}
    cuts = [cut for seed in range(8) for cut in drawn_list(config.trains, seed, 900).cuts]
    drawn = {(places[cut.category], cut.axles) for cut in cuts}
    assert kinds_of_cuts(config.trains, config.people) == drawn
    assert {axles for _, axles in drawn} == {4, 6, 8, 10, 12}
    classes = list(fewest_classes(drawn, config.people))
    assert [each.label for each in classes] == [f"{member.latin}-1" for member in members]
    mass = [each.mass_t for each in classes]
    assert mass == sorted(mass)


@given(st.sets(st.integers(1, 60), min_size=1, max_size=12), st.sets(st.integers(1, 40), min_size=1, max_size=7))
def test_fewer_classes_would_not_do(needed: set[int], offered: set[int]) -> None:
    """Against every subset of what is offered."""

    def serve(held: tuple[int, ...]) -> bool:
        return all(nearest_axles(held, axles) is not None for axles in needed)

    subsets = (some for size in range(1, len(offered) + 1) for some in combinations(sorted(offered), size))
    assert fewest_axles(needed, sorted(offered)) == next((some for some in subsets if serve(some)), ())


@given(st.floats(0.7, 7.0), st.just(0.0) | st.floats(0.02, 6.0))
def test_targets_go_from_end_to_end_in_small_steps(low_m_s: float, more_m_s: float) -> None:
    found = list(targets_m_s(low_m_s, low_m_s + more_m_s))
    assert found[-1] == round(low_m_s + more_m_s, 2)
    if more_m_s > 0.0:
        assert found[0] == round(low_m_s, 2)
    steps = np.diff(np.sqrt(found))
    assert len(steps) >= 1
    assert (steps > 0.0).all()
    assert steps.max() <= APART_ROOT_M_S + 0.01


def speeds(keys: str) -> dict[str, Any]:
    """Targets and entry speeds of a first position with these `keys`, to which cuts come with 4.5 to 7 m/s and whose
    retarders take 7.1 m/s."""
    text = f'hump = "medium"\n[trains]\nnumber = 1\n[[position]]\nnumber = 1\n{keys}\n'
    config = resolve_trial(without_books(parse_trial_file(text, "trial.toml")))
    return speeds_of(0, config, Entering(1000, 4.5, 7.0, {}, None), 7.1)


@pytest.mark.parametrize(
    ("keys", "targets", "high_m_s"),
    [
        ("", [4.0, 4.88, 5.85, 6.9], 7.0),
        ("lowest_m_s = 2.0\nhighest_m_s = 3.0", [2.0, 2.47, 3.0], 7.0),
        ("exit_m_s = { L = 5.0, all = 4.8 }", [4.8, 5.0], 7.0),
        ("exit_m_s = 6.95", [5.69, 6.95], 7.05),
    ],
)
def test_targets_are_what_the_role_commands(keys: str, targets: list[float], high_m_s: float) -> None:
    entry = {"low_m_s": 4.5, "high_m_s": high_m_s}
    assert speeds(keys) == {"entry": entry, "targets": {"exit_speeds_m_s": targets}}


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        (
            "lowest_m_s = 7.0",
            "position 1 commands 7 m/s or more, but cuts come to it with 7 m/s at most: set",
        ),
        (
            "highest_m_s = 9.0",
            "position 1 commands up to 9 m/s, but its retarders take cuts of at most 7.1 m/s",
        ),
    ],
)
def test_speeds_that_cuts_cannot_have_are_refused(keys: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        speeds(keys)
