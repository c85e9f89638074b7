"""Roles of positions: which aim unless told, and that each command is that of the role."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from synth.hump.configuration.trial_file import parse_trial_file
from synth.hump.trains.made_trial import made_trial
from synth.hump.trains.resolved_trial import ResolvedTrial, resolve_trial
from tests.synth.hump.trains.uneven_humps import SHORT_TRACKS, bunch_without_park

FEW = "[trains]\ncuts = 10\ntrack_shares = { 1 = 1, 2 = 1, 9 = 1 }\n[aim]\ndesign_cuts = 200\n"
BUNCH, PARK = 1, 2
"""Places of the second and the third position."""


@pytest.fixture(scope="module")
def hump(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The large hump, but behind its second position tracks 1 to 8 have switches and no retarder."""
    path = tmp_path_factory.mktemp("roles") / "mine.toml"
    path.write_text(bunch_without_park(), encoding="utf-8")
    return path


def resolved(hump: Path, roles: str) -> ResolvedTrial:
    """The trial on it."""
    return resolve_trial(parse_trial_file(f'hump = "{hump.name}"\n{FEW}{roles}', str(hump.with_name("trial.toml"))))


def test_the_last_position_aims_unless_a_switch_is_behind_it(hump: Path) -> None:
    trial = resolved(hump, "")
    short = np.isin(trial.routes.tracks, SHORT_TRACKS)
    assert not trial.roles.aims[:PARK].any()
    np.testing.assert_array_equal(trial.roles.aims[PARK], ~short)
    told = resolved(hump, '[[position]]\nnumber = 2\nrole = "aim"\n')
    np.testing.assert_array_equal(told.roles.aims[BUNCH], short)
    assert told.warnings[0].startswith(
        "position 2 aims at the standing cars of tracks 1 to 8, and switches are behind it"
    )
    assert not trial.warnings
    none = resolved(hump, '[[position]]\nnumber = 3\nrole = "spacing"\n')
    assert not none.roles.aims.any()
    assert none.roles.not_of_all == (0, 1, 2)


@pytest.mark.parametrize("feedback", ["true", "false"])
def test_each_position_is_commanded_by_its_role(hump: Path, feedback: str) -> None:
    """Fixed speeds to the bit; chosen ones within their range; what aims is slower than that on the whole."""
    roles = "[[position]]\nnumber = 1\nexit_m_s = { T = 5.1, all = 5.3 }\n[[position]]\nnumber = 2\nlowest_m_s = 3.0\n"
    trial = made_trial(resolved(hump, f"[exit_speeds]\nchoices = 3\nfeedback = {feedback}\n{roles}"))
    trains, _, memory = trial.humped(0, 6)
    passed = np.isfinite(memory.command_m_s)
    alone = np.asarray(passed & ~memory.unseparated.max(axis=2)[:, :, None])
    places = trains.category.reshape(passed.shape[:2])
    commanded = np.where(places == len(trains.population.categories.members) - 1, 5.1, 5.3)
    np.testing.assert_array_equal(memory.command_m_s[..., 0][alone[..., 0]], commanded[alone[..., 0]])
    chosen, aimed = memory.command_m_s[..., BUNCH][alone[..., BUNCH]], memory.command_m_s[..., PARK][alone[..., PARK]]
    assert len(chosen) >= 40
    assert len(aimed) >= 5
    assert chosen.min() >= 2.0  # a cut that comes slower is let go with its own speed
    assert np.median(chosen) >= 3.0 > np.median(aimed)
