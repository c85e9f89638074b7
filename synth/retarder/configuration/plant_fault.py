"""What the plant says of an impossible value, and what the library does not hold, as sentences about a file."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Final

from plant_models import PlantError
from plant_models.errors import near_miss
from plant_models.library import Kind, Library, TypeFileError
from plant_models.library.data_file import keyed
from synth.frame.faults import InputError
from tuning_tables.errors import excerpt

LONGEST_SENTENCE: Final = 400
"""Characters of what the plant says of a value, which it repeats."""

KEY_OF_PLANT_MESSAGE: Final = {
    "pneumatics: ": "retarder.pneumatics.",
    "force: ": "retarder.force.",
    "retarder: ": "retarder.",
    "retarder: stages ": "retarder.pneumatics.dead_band_kpa: stages ",
    "track profile: grades_permille": "track.grade_permille",
    "track profile: starts_m": "track.grade_permille: starts_m",
    "entry: ": "entry.",
    "entry: the last of ": "entry: the last of ",
    "friction: ": "friction.",
    "sensor: ": "sensor.",
    "sensors: ": "sensors.",
    "regulator: ": "regulator.",
    "criterion: ": "criterion.",
    "targets: target_speed_m_s": "targets.exit_speeds_m_s",
    "targets: ": "targets.exit_speeds_m_s: ",
}
"""How the plant's messages begin, and the key path in a configuration file that this means."""


@contextmanager
def in_file(
    file: str, key_path: Callable[[str], str] = lambda sentence: keyed(sentence, KEY_OF_PLANT_MESSAGE)
) -> Iterator[None]:
    """Within, a `PlantError` becomes an `InputError`: of `file` with its keys, or of the type file that it names."""
    try:
        yield
    except TypeFileError as error:
        raise InputError(*(excerpt(sentence, LONGEST_SENTENCE) for sentence in error.sentences)) from None
    except PlantError as error:
        raise InputError(f"{file}: {excerpt(key_path(str(error)), LONGEST_SENTENCE)}") from None


def require_held(where: str, kind: Kind, name: str, library: Library) -> str:
    """`name`, if the library holds such a type; `InputError` that begins with `where`."""
    known = library.names(kind)
    if name not in known:
        raise InputError(f"{where} is {excerpt(name)!r}, which the library does not hold; {near_miss(name, known)}")
    return name
