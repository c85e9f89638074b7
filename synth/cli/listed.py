"""The commands that are declared as a value of the frame; the others stand in `commands` and beside it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from synth.frame.command_line import Listed

if TYPE_CHECKING:
    from synth.frame.command import Command
    from synth.frame.settings.options import Options

    AnyCommand = Command[Any, Any, Any, Any]


def aim() -> AnyCommand:
    """Loaded when it is called, as all of these."""
    from synth.yard.aim.command import COMMAND

    return COMMAND


def aim_options() -> type[Options]:
    """Of it."""
    from synth.yard.aim.options import AimOptions

    return AimOptions


def computer() -> AnyCommand:
    """See `aim`."""
    from synth.computer.command import COMMAND

    return COMMAND


def computer_options() -> type[Options]:
    """Of it."""
    from synth.computer.uncertainty import ComputerOptions

    return ComputerOptions


def permissions() -> AnyCommand:
    """See `aim`."""
    from synth.book.permissions.command import COMMAND

    return COMMAND


def permissions_options() -> type[Options]:
    """Of it."""
    from synth.book.permissions.options import PermissionsOptions

    return PermissionsOptions


def sensitivity() -> AnyCommand:
    """See `aim`."""
    from synth.book.sensitivity.command import COMMAND

    return COMMAND


def sensitivity_options() -> type[Options]:
    """Of it."""
    from synth.book.sensitivity.options import SensitivityOptions

    return SensitivityOptions


def sensors_plan() -> AnyCommand:
    """See `aim`."""
    from synth.book.sensors.plan_command import COMMAND

    return COMMAND


def sensors_plan_options() -> type[Options]:
    """Of it."""
    from synth.book.sensors.plan_options import PlanOptions

    return PlanOptions


def watch() -> AnyCommand:
    """See `computer`."""
    from synth.yard.measured_passes.drift.command import COMMAND

    return COMMAND


def watch_options() -> type[Options]:
    """Of it."""
    from synth.yard.measured_passes.drift.options import WatchOptions

    return WatchOptions


def identify() -> AnyCommand:
    """See `computer`."""
    from synth.yard.measured_passes.identify_command import COMMAND

    return COMMAND


def replay() -> AnyCommand:
    """See `computer`."""
    from synth.yard.measured_passes.replay.command import COMMAND

    return COMMAND


def replay_options() -> type[Options]:
    """Of it."""
    from synth.yard.measured_passes.replay.options import ReplayOptions

    return ReplayOptions


def retune() -> AnyCommand:
    """See `computer`."""
    from synth.yard.measured_passes.retune.command import COMMAND

    return COMMAND


def retune_options() -> type[Options]:
    """Of it."""
    from synth.yard.measured_passes.retune.options import RetuneOptions

    return RetuneOptions


def log_options() -> type[Options]:
    """Of a command that only reads logs and a configuration."""
    from synth.yard.measured_passes.log_options import LogOptions

    return LogOptions


COMMANDS: Final = (
    Listed(
        "aim",
        aim,
        aim_options,
        "init --aim",
        "Make aim tables: the exit speeds at which a park position lets cuts go.\n\n"
        "Random cuts roll to the standing cars; the tables keep a required probability of coupling too fast. Exit code "
        "1 if a table misses it.",
    ),
    Listed(
        "sensitivity",
        sensitivity,
        sensitivity_options,
        "init",
        "Tell which number of a configuration to measure first.\n\n"
        "The table stays; the numbers vary over their ranges. Shares of the variance of rms, mean and over-speed by "
        "number.",
    ),
    Listed(
        "permissions",
        permissions,
        permissions_options,
        "init",
        "Tell what to ask of the hardware: what each permission would give in every case.\n\n"
        "Commands during a change of stage, with and without a pressure gauge; an estimator; the approach. Simulated "
        "on the same passes as the tables that a tune makes. Exit code 1 if one cannot be told.",
    ),
    Listed(
        "computer",
        computer,
        computer_options,
        "init --computer",
        "Size the control computer of a hump: how fast, how reliable, and what it pays.\n\n"
        "Exit code 1 if it is slower than its tasks need, or misses a limit of the configuration.",
    ),
    Listed(
        "watch",
        watch,
        watch_options,
        "init",
        "Watch measured passes of a position for drifts.\n\n"
        "What drifted, since when, what it costs, whether to retune or to repair. Exit code 1 if something drifted.",
    ),
    Listed(
        "identify",
        identify,
        log_options,
        "init",
        "Tell the numbers of a position from its measured passes, and write them as a configuration.\n\n"
        "Exit code 1 if a test says that the model does not hold for these passes.",
    ),
    Listed(
        "replay",
        replay,
        replay_options,
        "init",
        "Tell what other tables would have commanded in measured passes, and how the cuts would have left.\n\n"
        "Exit code 1 if the measured exits are not those that the configuration predicts for the tables of the log.",
    ),
    Listed(
        "retune",
        retune,
        retune_options,
        "init",
        "Make new tables for what measured passes say of the plant, and tell what they gain.\n\n"
        "Exit code 1, and no book, if the gain is within noise in every case; also 1 if a case has no new table.",
    ),
)
"""By themselves."""

SENSORS: Final = (
    Listed(
        "sensors plan",
        sensors_plan,
        sensors_plan_options,
        "init",
        "Plan where point sensors stand: the least rms for each number, and the fewest for a wanted rms.\n\n"
        "Compared with equal sections, with the rule that each change of stage ends inside its section, and with the "
        "radar. Exit code 1 if none of the numbers gives the wanted rms.",
    ),
)
"""Behind the word `sensors`."""
