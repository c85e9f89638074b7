"""Whatever is wrong with the input: one sentence, the contracted code, nothing written, nothing removed."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from synth.retarder.configuration.config_file import load_config
from tests.system.conftest import CLASS, Command, changed

ID = "gondola-4-22t-to-1.5-m-s"

CONFIGURATIONS = {
    "negative mass": (changed(CLASS, ("mass_t = 22", "mass_t = -22")), "cut[0].mass_t is -22.0"),
    "no TOML": (CLASS + "[other\n", "not valid TOML"),
    "too fine a grid": (
        changed(
            CLASS,
            ("path_step_m = 1.0\nspeed_step_m_s = 0.04", "path_step_m = 0.02\nspeed_step_m_s = 0.002"),
            ("friction_scenarios = 3", "friction_scenarios = 15\npath_levels = 9"),
            ("resistance_scenarios = 1", "resistance_scenarios = 15"),
        )
        + "[regulator]\nestimator = false\n",
        "would take about",
    ),
}  # fmt: skip


@pytest.mark.parametrize(("noise", "resolution"), [("0.002", "0.0"), ("0.0", "0.0"), ("0.0068", "0.001")])
def test_no_sensor_is_too_good(tmp_path: Path, noise: str, resolution: str) -> None:
    config = tmp_path / "quiet.toml"
    config.write_text(CLASS + f"[sensor]\nnoise_m_s = {noise}\nresolution_m_s = {resolution}\n")
    assert load_config(config).regulator.estimator is True


@pytest.mark.requirement("CMD-02")
@pytest.mark.parametrize("name", CONFIGURATIONS)
def test_a_bad_configuration_touches_nothing(command: Command, tmp_path: Path, name: str) -> None:
    text, said = CONFIGURATIONS[name]
    config, out = tmp_path / "bad.toml", tmp_path / "out"
    config.write_text(text)
    ran = command("tune", config, "-o", out)
    assert (ran.code, ran.out) == (2, "")
    assert ran.sentence.startswith(f"{config}: ")
    assert said in ran.sentence
    assert not out.exists()


@pytest.mark.requirement("CMD-02")
def test_a_refused_tune_leaves_the_last_results_alone(command: Command, tuned: Path, tmp_path: Path) -> None:
    before = {path: path.read_bytes() for path in tuned.rglob("*") if path.is_file()}
    config = tmp_path / "bad.toml"
    config.write_text(CONFIGURATIONS["too fine a grid"][0])
    assert command("tune", config, "-o", tuned).code == 2
    assert {path: path.read_bytes() for path in tuned.rglob("*") if path.is_file()} == before


def test_missing_and_odd_configuration_files(command: Command, tmp_path: Path) -> None:
    assert "there is no such file" in command("tune", tmp_path / "none.toml").sentence
    assert "this is a directory" in command("tune", tmp_path).sentence
    (tmp_path / "latin.toml").write_bytes(b'title = "\xe9"')
    assert "not UTF-8" in command("tune", tmp_path / "latin.toml").sentence
    assert command("validate", tmp_path / "none.json").code == 2


@pytest.mark.parametrize("below", ["", "sub", "sub/sub"])
def test_an_output_that_cannot_be_a_directory(command: Command, one_class: Path, tuned: Path, below: str) -> None:
    file = tuned / "report.html"
    before = file.read_bytes()
    for arguments in (
        ("tune", one_class, "-o", file / below),
        ("inspect", tuned / "book.h5", "-o", file / below),
        ("export", tuned / "book.h5", "--format", "csv", "-o", file / below),
    ):
        ran = command(*arguments)
        assert (ran.code, ran.out) == (2, "")
        assert "give a" in ran.sentence
    assert file.read_bytes() == before


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_an_output_without_permission(command: Command, one_class: Path, tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    ran = command("tune", one_class, "-o", tmp_path / "out")
    assert ran.code == 2
    assert "cannot be written" in ran.sentence


def test_a_file_in_the_place_of_a_folder(command: Command, one_class: Path, tmp_path: Path) -> None:
    (tmp_path / "tables").write_text("mine")
    ran = command("tune", one_class, "-o", tmp_path)
    assert ran.code == 2
    assert f"{tmp_path}: it holds tables, which 'tune' did not write" in ran.sentence


@pytest.mark.parametrize("epoch", ["yesterday", "1e9", "-9" * 20])
def test_a_date_that_is_none(
    command: Command, one_class: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, epoch: str
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", epoch)
    ran = command("tune", one_class, "-o", tmp_path / "out")
    assert ran.code == 2
    assert "SOURCE_DATE_EPOCH" in ran.sentence
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    "arguments",
    [("tuna",), ("sweep", "runs", "x.toml"), ("tune", "--wrokers", "2"), ("export", "x.json"), ("verify",),
     ("verify", "x.json", "--passes", "many"), ("tune", "a.toml", "b.toml")],
)  # fmt: skip
def test_faults_of_use(command: Command, arguments: tuple[str, ...]) -> None:
    ran = command(*arguments)
    assert (ran.code, ran.out) == (2, "")
    assert "see 'retarder-synth --help'" in ran.sentence


@pytest.mark.requirement("CMD-04")
@pytest.mark.parametrize("name", [f"tables/{ID}.json", "book.h5"])
def test_a_cut_off_table_or_book_is_damaged(command: Command, tuned: Path, two_classes: Path, name: str) -> None:
    whole = (tuned / name).read_bytes()
    for length in (0, 3, len(whole) // 2, len(whole) - 2):
        (tuned / name).write_bytes(whole[:length])
        for arguments in command_lines(tuned / name, two_classes, tuned / "new"):
            ran = command(*arguments)
            assert (ran.code, ran.out) == (3, ""), (arguments, length)
            assert name in ran.sentence
        assert not (tuned / "new").exists()


def test_a_long_path_is_told_by_its_beginning_and_its_end(command: Command, tmp_path: Path) -> None:
    long = tmp_path.joinpath(*["a" * 100] * 30, "end.json")
    for arguments in (
        ("watch", long, "-o", tmp_path / "out"),
        ("tune", long, "-o", tmp_path / "out"),
        *command_lines(long, long, tmp_path / "out"),
    ):
        ran = command(*arguments)
        assert ran.code == 2
        assert len(ran.sentence) < 700, arguments
        assert "aaa...aaa" in ran.sentence
        assert "end.json" in ran.sentence


def command_lines(table: Path, config: Path, output: Path) -> list[tuple[object, ...]]:
    """Every command that reads a table."""
    return [
        ("inspect", table),
        ("validate", table, "--config", config, "-o", output),
        ("inspect", table, "-o", output),
        ("export", table, "--format", "json", "-o", output),
    ]
