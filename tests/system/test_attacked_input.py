"""Input made to break the program: each is refused at once, by one short sentence that names the file and the key."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.system.conftest import CLASS, MEASURED, Command, changed

DIGITS = "9" * 400
LONG = "x" * 100_000

CONFIGURATIONS = {
    "thousands of digits": (CLASS.replace("degree = 2", f"degree = {DIGITS * 11}"), "thousands of digits"),
    "hexadecimal digits": (CLASS.replace("degree = 2", f"degree = 0x{'f' * 5000}"), "thousands of digits"),
    "hundreds of digits": (CLASS.replace("degree = 2", f"degree = {DIGITS}"), "fit.degree is 99999"),
    "nested lists": (f"x = {'[' * 3000}{']' * 3000}\n", "nested too deeply"),
    "nested inline tables": ("x = " + "{a=" * 3000 + "1" + "}" * 3000, "nested too deeply"),
    "nested table names": (f"[{'.'.join('a' * 2000)}]\n", "nested too deeply"),
    "some nested lists": (f"x = {'[' * 40}{']' * 40}\n", "nested too deeply"),
    "long car": (CLASS.replace("gondola-4", LONG), "cut[0].car is 'xxx"),
    "long category": (CLASS + f'category = "{LONG}"\n', "cut[0].category is"),
    "long retarder": (CLASS.replace("rnz-2m-park", LONG), "position.name is 'xxx"),
    "long key": (CLASS + f"{LONG} = 1\n", "unknown key"),
    "long stages": (
        CLASS.replace("[entry]", f"[retarder]\nstage_pressures_kpa = {[0.0] * 2000}\n[entry]"),
        "retarder.stage_pressures_kpa",
    ),
    "long zones": (
        CLASS.replace("[entry]", f"[retarder]\nzones_m = {[[1.0, 2.0]] * 2000}\n[entry]"),
        "retarder.zones_m",
    ),
    "huge stage": (CLASS + f"allowed_stage = {DIGITS}\n", "cut[0].allowed_stage is 99999"),
    "huge file": ("#" * (4 * 2**20 + 1), "more than 4194304 bytes"),
    "equal ids": (CLASS.replace("[1.5]", "[1.5, 1.5000001]"), "holds 1.5 and 1.5000001, but tables are named by six"),
    "denormal resolution": (CLASS + "[sensor]\nresolution_m_s = 5e-324\n", "resolution_m_s is 5e-324; it must be 0"),
    "NUL in the title": ('title = "a\\u0000b"\n' + CLASS, "title is 'a\\x00b'; it must be made of printable"),
    "ESC in the title": ('title = "\\u001b[31m"\n' + CLASS, "title is '\\x1b[31m'; it must be made of printable"),
}  # fmt: skip

SWEPT = CLASS.replace('[[cut]]\ncar = "gondola-4"\nmass_t = 22\n', '[[sweep.cut]]\ncar = "gondola-4"\n')
CONDITIONS = CLASS + '[[sweep.condition]]\nname = "dry"\n[[sweep.condition]]\nname = "NAME"\n'

SWEEPS = {
    "range beyond the doubles": (
        SWEPT + "mass_per_car_t = { from = -1e308, to = 1e308, step = 1 }\n", "it must be of at most 1000 values"
    ),
    "huge mass": (SWEPT + f"mass_per_car_t = {DIGITS}\n", "sweep.cut[0].mass_per_car_t is 999"),
    "huge masses": (SWEPT + f"mass_per_car_t = [22, {DIGITS}]\n", "sweep.cut[0].mass_per_car_t[1] is 999"),
    "huge range": (SWEPT + f"mass_per_car_t = {{ from = 22, to = {DIGITS}, step = 1 }}\n", "mass_per_car_t.to is 999"),
    "huge target": (CLASS + f"[sweep]\nexit_speeds_m_s = {DIGITS}\n", "sweep.exit_speeds_m_s is 999"),
    "thousands of digits": (CLASS + f"[sweep]\npasses = {DIGITS * 11}\n", "thousands of digits"),
    "nested lists": (CLASS + f"[sweep]\nx = {'[' * 3000}{']' * 3000}\n", "nested too deeply"),
    "equal ids": (CLASS + "[sweep]\nexit_speeds_m_s = [1.5, 1.5000001]\n", "but tables are named by six digits"),
    "a condition called sweep": (CONDITIONS.replace("NAME", "Sweep"), ".name is 'Sweep'; it must be another name"),
    "a condition called as a file": (CONDITIONS.replace("NAME", "report.html"), "a file or folder of the sweep"),
    "a condition called as the kept file": (
        CONDITIONS.replace("NAME", "configuration.toml"),
        "a file or folder of the sweep",
    ),
    "a condition called NUL": (CONDITIONS.replace("NAME", "NUL"), "a device of Windows"),
    "a condition called con.1": (CONDITIONS.replace("NAME", "con.1"), "a device of Windows"),
    "a dot at the end": (CONDITIONS.replace("NAME", "dry."), "with no dot at the end"),
}  # fmt: skip


@pytest.mark.parametrize("name", [*CONFIGURATIONS, *(f"sweep: {name}" for name in SWEEPS)])
def test_one_short_sentence(command: Command, tmp_path: Path, name: str) -> None:
    swept = name.startswith("sweep: ")
    text, said = SWEEPS[name.removeprefix("sweep: ")] if swept else CONFIGURATIONS[name]
    config, out = tmp_path / "bad.toml", tmp_path / "out"
    config.write_text(text)
    ran = command(*(("sweep", "run") if swept else ("tune",)), config, "-o", out)
    assert (ran.code, ran.out) == (2, "")
    assert ran.sentence.startswith(f"{config}: ")
    assert said in ran.sentence
    assert len(ran.sentence) < 900
    assert not out.exists()


def test_a_name_cannot_steer_the_terminal(command: Command, tmp_path: Path) -> None:
    trial = tmp_path / "trial.toml"
    trial.write_text('hump = "\\u001b[31mred\\u202e"')
    ran = command("hump", "simulate", trial, "-o", tmp_path / "out")
    assert ran.code == 2
    assert ran.sentence.isprintable()
    assert "/\\x1b[31mred\\u202e: there is no such file" in ran.sentence


def test_too_long_a_name_is_told_of_the_file_that_holds_it(command: Command, tmp_path: Path) -> None:
    trial = tmp_path / "trial.toml"
    trial.write_text(f'hump = "{"x" * 300}.toml"')
    ran = command("hump", "simulate", trial, "-o", tmp_path / "out")
    assert ran.code == 2
    assert ran.sentence.startswith(f"{trial}: hump: ")
    assert "there is no such file" in ran.sentence


@pytest.mark.parametrize("name", ["com10", "console", "dry.1", "sweep1", "a"])
def test_names_that_conditions_may_have(tmp_path: Path, name: str) -> None:
    from synth.retarder.sweep.sweep_file import parse_sweep

    assert [each.name for each in parse_sweep(CONDITIONS.replace("NAME", name), "x").conditions] == ["dry", name]


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="pipes with names are POSIX's")
def test_a_configuration_that_is_no_ordinary_file(tmp_path: Path) -> None:
    """In a process of its own, with little memory: it may neither wait nor read for ever."""
    pipe, large = tmp_path / "pipe", tmp_path / "10-gb"
    os.mkfifo(pipe)
    large.touch()
    os.truncate(large, 10 * 2**30)
    paths = (pipe, Path("/dev/zero"), large)
    words = (["tune"], ["sweep", "run"], ["validate", str(tmp_path / "table.json"), "--config"])
    commands = [[*each, str(path), "-o", str(tmp_path / "out")] for path in paths for each in words]
    source = (
        "import json, sys; from synth.cli import main; "
        "print([main(arguments) for arguments in json.loads(sys.argv[1])])"
    )
    ran = subprocess.run(
        ["bash", "-c", 'ulimit -v 3000000; exec "$@"', "-", sys.executable, "-c", source, json.dumps(commands)],
        capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert ran.stdout == f"{[2] * len(commands)}\n"
    told = iter(ran.stderr.splitlines())
    for path in paths:
        for _ in words:
            sentence = next(told)
            assert sentence.startswith(f"retarder-synth: {path}: ")
            assert ("not a regular file" if path != large else "more than 4194304 bytes") in sentence
    assert list(told) == []


@pytest.mark.parametrize("name", ["tune", "sweep run", "inspect", "export"])
def test_an_empty_output_is_refused(
    command: Command, tuned: Path, one_class: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.chdir(tmp_path)
    form = ["--format", "csv"] if name == "export" else []
    before = sorted(tmp_path.rglob("*"))
    ran = command(*name.split(), one_class if name in ("tune", "sweep run") else tuned / "book.h5", *form, "-o", "")
    assert (ran.code, ran.out) == (2, "")
    assert "it is empty; give a directory" in ran.sentence
    assert sorted(tmp_path.rglob("*")) == before


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("tune", "--workers", "0"), "--workers is '0'; it must be a whole number from 1 to 256"),
        (("tune", "--workers", "many"), "--workers is 'many'; it must be a whole number from 1 to 256"),
        (("sweep", "run", "x", "--workers", "1025"), "--workers is '1025'; it must be a whole number from 1 to 1024"),
        (("validate", "x.json", "--passes", "5"), "--passes is '5'; it must be a whole number from 1000 to 100000000"),
        (("validate", "x.json", "--seed", "-1"), "--seed is '-1'; it must be a whole number from 0 to"),
        (("verify", "x.json", "--passes", "1e3"), "it is '1e3'; give a whole number from 100 to 1000000"),
        (("verify", "x.json", "--seed", "9" * 5000), "give a whole number from 0 to 9223372036854775807"),
    ],
)
def test_a_number_of_the_command_line_tells_what_is_allowed(
    command: Command, arguments: tuple[str, ...], said: str
) -> None:
    ran = command(*arguments)
    assert (ran.code, ran.out) == (2, "")
    assert said in ran.sentence
    assert len(ran.sentence) < 200


def test_a_target_that_the_grid_is_too_coarse_for_is_named(command: Command, tmp_path: Path) -> None:
    config = tmp_path / "coarse.toml"
    swaps = ("csv = true", "plots = false"), ("speed_step_m_s = 0.04", "speed_step_m_s = 0.2"), ("[1.5]", "[2.5]")
    config.write_text(changed(CLASS, *swaps) + MEASURED + "[criterion]\noverspeed_factor = 1000\n")
    ran = command("tune", config, "-o", tmp_path / "out")
    assert (ran.code, ran.out) == (2, "")
    told = ran.err.splitlines()[-1]
    assert told.startswith(f"retarder-synth: {config}: no table for gondola-4-22t to 2.5 m/s: the grid is too coarse")
    assert "now grid.speed_step_m_s is 0.2 and grid.path_step_m is 1" in told


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="pipes with names are POSIX's")
@pytest.mark.parametrize("command_name", ["inspect", "verify", "validate"])
def test_what_is_no_regular_file_is_no_damaged_table(command: Command, tmp_path: Path, command_name: str) -> None:
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", Path("/dev/zero")):
        ran = command(command_name, path)
        assert (ran.code, ran.out) == (2, "")
        assert ran.sentence.startswith(f"{path}: ")
