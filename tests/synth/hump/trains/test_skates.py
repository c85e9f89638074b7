"""Skates: they take their share of the energy of cuts that come to the standing cars, and change nothing else."""

from __future__ import annotations

import numpy as np
import pytest

from synth.hump.configuration.trial_file import parse_trial_file
from synth.hump.trains.made_trial import made_trial
from synth.hump.trains.resolved_trial import ResolvedTrial, resolve_trial

TRIAL = """hump = "dumper"
[trains]
cuts = 12
most_cars = 1
category_shares = { L = 1 }
[tracks]
skates_share = SHARE
[aim]
design_cuts = 200
"""
FIXED = "[[position]]\nnumber = 1\nexit_m_s = 3.0\n"


def trial_with(share: float, position: str = FIXED) -> ResolvedTrial:
    """The trial with skates that take this `share`."""
    return resolve_trial(parse_trial_file(TRIAL.replace("SHARE", f"{share}") + position, "trial.toml"))


def test_skates_take_their_share_of_the_energy() -> None:
    free, held = (made_trial(trial_with(share)).humped(0, 4)[2] for share in (0.0, 0.75))
    alone = ~free.caught_on_track
    assert (free.end_speed_m_s[alone] > 1.0).sum() > 20
    np.testing.assert_allclose(held.end_speed_m_s[alone], 0.5 * free.end_speed_m_s[alone], rtol=1e-12)
    np.testing.assert_array_equal(held.end_speed_m_s[~alone], free.end_speed_m_s[~alone])
    np.testing.assert_array_equal(held.time_s, free.time_s)
    np.testing.assert_array_equal(held.end_m, free.end_m)


@pytest.mark.parametrize(("position", "warned"), [(FIXED, False), ("", True)])
def test_skates_lie_where_no_position_aims(position: str, warned: bool) -> None:
    config = trial_with(0.5, position)
    assert any("tracks.skates_share" in sentence for sentence in config.warnings) is warned
    trial = made_trial(config)
    left = trial.hump_for(trial.rolls_of(trial.source.trains(0, 1))).left_share
    assert left is not None
    np.testing.assert_array_equal(left, np.full(8, 1.0 if warned else np.sqrt(0.5)))
