"""The commands that are declared as a value of the frame; the others stand in `commands` and beside it.

A command and its options are named as "module:NAME", as entry points of packages are: both are imported when the
command is called, and the list of commands imports neither.
"""

from __future__ import annotations

from typing import Final

from synth.frame.command_line import Listed

COMMANDS: Final = (
    Listed(
        "tune",
        "synth.retarder.tune_command:COMMAND",
        "synth.retarder.options:TuneOptions",
        "init",
        "Make a book of tables, its pictures and report.\n\n"
        "For a radar, or for point sensors where the configuration has some. Exit code 1 if the table of a feasible "
        "case misses a limit of the configuration, or a case has no table.",
        folder="out",
    ),
    Listed(
        "sensors",
        "synth.retarder.sensors.plan_command:COMMAND",
        "synth.retarder.options:PlanOptions",
        "init",
        "Plan where point sensors stand: the least rms for each number, and the fewest for a wanted rms.\n\n"
        "Compared with equal sections, with the rule that each change of stage ends inside its section, and with the "
        "radar. Exit code 1 if none of the numbers gives the wanted rms.",
    ),
    Listed(
        "aim",
        "synth.hump.aiming:COMMAND",
        "synth.hump.options:AimOptions",
        "init aim",
        "Make aim tables: the exit speeds at which a park position lets cuts go.\n\n"
        "Random cuts roll to the standing cars; the tables keep a required probability of coupling too fast. Exit code "
        "1 if a table misses it.",
    ),
    Listed(
        "validate",
        "synth.retarder.validation.command:COMMAND",
        "synth.retarder.validation.options:ValidateOptions",
        "init",
        "Simulate exported tables once more.\n\nNothing is solved. Exit code 1 if a table misses a limit of the "
        "configuration.",
    ),
    Listed(
        "qualify",
        "synth.cli.qualification.command:COMMAND",
        "synth.cli.qualification.options:QualifyOptions",
        "",
        "Check this installation, and leave a page and a JSON document for a safety case.\n\n"
        "Files against their hashes, kernels against their plain text, a small tune against kept bytes, the second "
        "program, the second simulator, and the self-tests with the compilers that are found. Exit code 1 if a check "
        "failed; what could not be checked is told.",
    ),
    Listed(
        "loop",
        "synth.retarder.loops.command:COMMAND",
        "synth.retarder.options:TablesOptions",
        "init",
        "Show exported tables as control loops.\n\n"
        "Nominal response by python-control beside the simulator's, phase portrait with the lines, predicted limit "
        "cycles. Exit code 1 if the two responses do not agree.",
    ),
    Listed(
        "bench",
        "synth.retarder.bench.command:COMMAND",
        "synth.retarder.bench.options:BenchOptions",
        "init",
        "Play the position in real time to a controller at the end of a cable, and score it.\n\n"
        "Over Modbus TCP, OPC UA, or both; a browser sees the run. Only this machine can connect unless an address "
        "says otherwise. Exit code 1 if the exits miss what the tables promise, or the run does not decide it.",
    ),
    Listed(
        "explore",
        "synth.retarder.explore.command:COMMAND",
        "synth.retarder.options:TablesOptions",
        "init",
        "Make one page on which tables brake cuts in the browser.\n\n"
        "Sliders set the cut and the plant; the page tells the exit error at once, why each command is given, and what "
        "a hundred cuts do.",
    ),
    Listed(
        "sensitivity",
        "synth.retarder.sensitivity.command:COMMAND",
        "synth.retarder.options:SensitivityOptions",
        "init",
        "Tell which number of a configuration to measure first.\n\n"
        "The table stays; the numbers vary over their ranges. Shares of the variance of rms, mean and over-speed by "
        "number.",
    ),
    Listed(
        "hardware",
        "synth.retarder.permissions.command:COMMAND",
        "synth.retarder.options:PermissionsOptions",
        "init",
        "Tell what to ask of the hardware: what each permission would give in every case.\n\n"
        "Commands during a change of stage, with and without a pressure gauge; an estimator; the approach. Simulated "
        "on the same passes as the tables that a tune makes. Exit code 1 if one cannot be told.",
    ),
    Listed(
        "computer",
        "synth.computer.command:COMMAND",
        "synth.computer.uncertainty:ComputerOptions",
        "init computer",
        "Size the control computer of a hump: how fast, how reliable, and what it pays.\n\n"
        "Exit code 1 if it is slower than its tasks need, or misses a limit of the configuration.",
    ),
    Listed(
        "watch",
        "synth.logs.drift.command:COMMAND",
        "synth.logs.log_options:WatchOptions",
        "init",
        "Watch measured passes of a position for drifts.\n\n"
        "What drifted, since when, what it costs, whether to retune or to repair. Exit code 1 if something drifted.",
    ),
    Listed(
        "identify",
        "synth.logs.identify_command:COMMAND",
        "synth.logs.log_options:LogOptions",
        "init",
        "Tell the numbers of a position from its measured passes, and write them as a configuration.\n\n"
        "Exit code 1 if a test says that the model does not hold for these passes.",
    ),
    Listed(
        "replay",
        "synth.logs.replay.command:COMMAND",
        "synth.logs.log_options:ReplayOptions",
        "init",
        "Tell what other tables would have commanded in measured passes, and how the cuts would have left.\n\n"
        "Exit code 1 if the measured exits are not those that the configuration predicts for the tables of the log.",
    ),
    Listed(
        "retune",
        "synth.logs.retune.command:COMMAND",
        "synth.logs.log_options:RetuneOptions",
        "init",
        "Make new tables for what measured passes say of the plant, and tell what they gain.\n\n"
        "Exit code 1, and no book, if the gain is within noise in every case; also 1 if a case has no new table.",
    ),
)
"""By themselves."""

SWEEP: Final = (
    Listed(
        "sweep run",
        "synth.retarder.sweep.command:COMMAND",
        "synth.retarder.options:SweepOptions",
        "init sweep",
        "Make books over a grid of cut classes, targets and conditions; resumable.\n\n"
        "The table [sweep] of CONFIG.toml says what is swept. The same command goes on after an end of any kind. Exit "
        "code 1 if a unit failed or a target has no table; 'sweep failed DIR' tells why, 'sweep status DIR' how far a "
        "sweep is.",
        folder="out/sweep",
    ),
)
"""Behind the word `sweep`, beside those that tell of a sweep."""

HUMP: Final = (
    Listed(
        "hump make",
        "synth.hump.making.make_command:COMMAND",
        "synth.hump.options:MakeOptions",
        "init short-hump",
        "Make a hump file, and its picture, from a short file: tracks, profile, places of switches and positions.",
    ),
    Listed(
        "hump simulate",
        "synth.hump.trains.simulate_command:COMMAND",
        "synth.hump.options:SimulateOptions",
        "init trial",
        "Hump whole trains: catch-ups, couplings, gaps and cars an hour, with intervals; resumable.\n\n"
        "The same command goes on after an end of any kind. Exit code 1 if a limit of the configuration is missed.",
    ),
    Listed(
        "hump capacity",
        "synth.hump.capacity.command:COMMAND",
        "synth.hump.options:CapacityOptions",
        "init trial",
        "Tell how many cars an hour a hump can hump at an allowed share of catch-ups.\n\n"
        "A curve for the trial as it is, or one for each accuracy of the positions and each value of a key; all hump "
        "the same trains. Resumable.",
    ),
    Listed(
        "hump design",
        "synth.hump.design.command:COMMAND",
        "synth.hump.design.options:DesignOptions",
        "init trial",
        "Test the design of a hump: fall, brakes, entry speeds and intervals of a bad, a good and a bad runner.\n\n"
        "Every two tracks are tried; up to which hump speed they do is told. Exit code 1 if the test is not passed.",
    ),
    Listed(
        "hump compare",
        "synth.hump.compare_command:COMMAND",
        "synth.hump.options:CompareOptions",
        "init trial",
        "Compare runs of 'hump simulate' on the same trains: every figure, and by how much it differs.\n\n"
        "Differences from the first run are paired by train, so they are known better than the figures themselves.",
    ),
    Listed(
        "hump watch",
        "synth.hump.watching.command:COMMAND",
        "synth.hump.options:YardWatchOptions",
        "init yard",
        "Watch all positions of a yard, night by night: what to repair first, and what it costs.\n\n"
        "Goes on from the run before, so a timer can start it. Exit code 1 if a position has drifted, or has no new "
        "passes.",
    ),
    Listed(
        "hump speed",
        "synth.hump.trains.speed_program:COMMAND",
        "synth.hump.options:SpeedOptions",
        "init trial",
        "Plan one train: hump speeds for the locomotive, and the uncoupler's sheet.",
    ),
)
"""Behind the word `hump`."""
