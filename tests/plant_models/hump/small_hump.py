"""A small hump, as a file has it."""

from __future__ import annotations

import tomllib

from plant_models.library.hump_entry import HumpEntry, hump_from

SMALL = """\
format = "hump"
version = 1
title = "Small"
source = "engineering judgement: a test"
confidence = "L"

[type.turnout]
entry_joint_m = 6
exit_joint_m = 5
throw_s = { value = 0.6, source = "a data sheet", confidence = "H" }
relay_s = 0.2
left = { turn_deg = 4.73, fouling_m = 26, length_m = 60, grade_permille = 10 }
right = { turn_deg = 4.73, fouling_m = 26, length_m = 60, grade_permille = 10 }

[type.track]
next = { length_m = 300, grade_permille = [[0, 1], [200, 0]] }

[hump]
leads = [201]
signal = [{ number = 201, next = { to = 1, length_m = 42, grade_permille = 45 } }]
switch = [
    { number = 1, type = "turnout", left = { to = 401 }, right = { to = 602 } },
]
section = [
    { number = 601, type = "track", track = 1 },
    { number = 602, type = "track", track = 2, standing_m = 20 },
]

[[hump.retarder]]
number = 401
position = "knp-5-bunch"
entry_joint_m = 1
exit_joint_m = 28
next = { to = 601, length_m = 40, grade_permille = 8, curves = [[30, 40, -14]], radars_m = [[0, 27]] }
exit_std_m_s = 0.15
"""


def read(text: str) -> HumpEntry:
    return hump_from(tomllib.loads(text), text, "small", "small.toml")
