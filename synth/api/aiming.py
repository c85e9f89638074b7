"""Exit speeds at which a park position lets cuts go, so that they reach the standing cars softly."""

from __future__ import annotations

from pathlib import Path

from synth.aim.aim_book import aim_book
from synth.aim.configuration.aim_file import parse_aim_file
from synth.aim.resolved_aim import ResolvedAim, resolve_aim
from synth.api.as_a_command import as_a_command
from synth.frame.settings.settings_file import BUILT_IN
from synth.frame.settings.toml_file import read_text
from synth.frame.version import creation_time
from tuning_tables.aim import AimTables


def load_aim(path: Path | str | None = None, passes: int | None = None, seed: int | None = None) -> ResolvedAim:
    """Read the configuration of aim tables, as `retarder-synth init aim` writes one.

    Parameters
    ----------
    path
        A TOML file, or None for the built-in configuration.
    passes, seed
        Simulated cuts of a cell, and which, in place of those of the configuration.

    Returns
    -------
    ResolvedAim
        The configuration with every default filled in: `scene`, `members`, `cars`, `aim`, `simulation`, `sha256`.

    Raises
    ------
    InputError
        A sentence for each fault of the file.
    PlantError
        Passes or a seed that are not allowed.

    Examples
    --------
    >>> import synth
    >>> aim = synth.load_aim()
    >>> aim.position_name, [member.latin for member in aim.members]
    ('rnz-2m-park', ['L', 'LS', 'S', 'ST', 'T'])
    """
    text, place = ("", BUILT_IN) if path is None else (read_text(Path(path)), str(path))
    file = parse_aim_file(text, place)
    return resolve_aim(file.with_simulation(passes, seed))


@as_a_command
def aim_tables(aim: ResolvedAim) -> AimTables:
    """Compute the aim tables of a configuration.

    Parameters
    ----------
    aim
        What `load_aim` read.

    Returns
    -------
    tuning_tables.aim.AimTables
        One table for each weight category and kind of knowledge. `select` chooses one,
        `tuning_tables.aim.aim_exit_speed` asks it, `tuning_tables.write_json` writes it.

    Raises
    ------
    InputError
        The tables of the position do not fit it.
    TableError
        The file of the tables of the position is damaged.

    Examples
    --------
    >>> import synth
    >>> from tuning_tables.aim import aim_exit_speed
    >>> tables = synth.aim_tables(synth.load_aim(passes=1000))
    >>> table = tables.select(1, measured=False)
    >>> 1.0 < aim_exit_speed(table, cars=2, free_distance_m=120.0) < 5.0
    True
    """
    made = aim_book(aim, creation_time(), lambda sentence: None)
    return AimTables(tuple(each.table for each in made.tables))
