"""No command costs a user a byte: every command, with each of its inputs in every place where its results could go.

Places of an input: inside the directory of results, in it under the name of a result, itself a result of the command,
equal to the directory, and above it. In the last place a command runs; in the others it is refused in one sentence
before anything is computed.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

import pytest

from plant_models.library import BUILT_IN
from plant_models.library.library import CARS
from synth.cli import main
from synth.frame.own_files import MARKER
from synth.frame.results_directory import results_directory
from synth.hump.hump_file import hump_text
from synth.hump.making.short_file import example_short_toml
from tests.system.conftest import CLASS, SECOND_CLASS, Command, changed

SENSORS = """\
[sensors]
path_m = [-4.5, 0.0, 4.0, 8.0, 12.0, 16.0, 22.5]
"""
SWEEP = """\
[sweep]
exit_speeds_m_s = [1.5]
[[sweep.cut]]
car = "my-gondola"
mass_per_car_t = [22]
"""
OWN_CAR = "types/cars/my-gondola.toml"
LIBRARY = 'library = ["types/"]\n'
TABLE = "gondola-4-22t-to-1.5-m-s"
INPUTS = (
    "yard.toml", "points.toml", "own.toml", "sweep.toml", "aim.toml", "computer.toml", "trial.toml", "hump.toml",
    "short.toml", "positions.toml",
    "train.csv", "book.h5", "table.json", "log.csv", "log.h5", "mapping.toml",
)  # fmt: skip
READ_BY = {"own.toml": OWN_CAR, "sweep.toml": OWN_CAR, "trial.toml": "hump.toml", "positions.toml": "log.csv"}
"""What else is read where an input is."""


@dataclass(frozen=True)
class Writing:
    """The `words` of a command, each input by its name, and the name of a `result` of it."""

    words: tuple[str, ...]
    result: str
    quick: bool = False

    @property
    def name(self) -> str:
        """The command as its directory is marked."""
        groups = ("hump", "sweep")
        words = [word for word in self.words if word in groups or word not in INPUTS]
        return " ".join(words[:2] if words[0] in groups else words[:1])

    @property
    def inputs(self) -> tuple[str, ...]:
        """The files that it reads."""
        given = [word for word in self.words if word in INPUTS]
        return (*given, *(READ_BY[word] for word in given if word in READ_BY))

    def typed(self, folder: Path, output: Path) -> list[str]:
        """What is typed where the inputs lie in `folder`."""
        words = [str(folder / word) if word in INPUTS else word for word in self.words]
        return [*words, "-o", str(output)]


DIRECTORIES = (
    Writing(("tune", "yard.toml"), "report.html", quick=True),
    Writing(("tune", "points.toml"), "report.html"),
    Writing(("sensors", "yard.toml"), "sensors-by-rule.toml"),
    Writing(("hardware", "yard.toml"), "summary.json"),
    Writing(("sensitivity", "yard.toml", "--table", "book.h5"), "sheets/overall.csv"),
    Writing(("sweep", "run", "sweep.toml"), "config.toml"),
    Writing(("aim", "aim.toml"), "report.html"),
    Writing(("computer", "computer.toml"), "report.html"),
    Writing(("hump", "simulate", "trial.toml", "--list", "train.csv"), "inputs/config.toml"),
    Writing(("hump", "speed", "trial.toml"), "sheets/program.csv"),
    Writing(("hump", "draw", "hump.toml"), "hump-hump.svg"),
    Writing(("hump", "export", "hump.toml", "--format", "railml"), "hump.railml"),
    Writing(("hump", "make", "short.toml"), "report.html"),
    Writing(("hump", "watch", "positions.toml"), "sheets/positions.csv"),
    Writing(("identify", "log.csv", "--config", "own.toml", "--mapping", "mapping.toml"), "config.toml"),
    Writing(("watch", "log.csv", "--config", "yard.toml", "--reference", "log.h5"), "sheets/passes.csv"),
    Writing(("retune", "log.csv", "--config", "yard.toml", "--table", "book.h5"), "book.h5"),
    Writing(("replay", "log.csv", "--config", "yard.toml", "--table", "book.h5"), "report.html"),
    Writing(("export", "book.h5", "--format", "c"), "retarder_table.c", quick=True),
    Writing(("export", "table.json", "--format", "json"), f"{TABLE}.json", quick=True),
    Writing(("validate", "book.h5", "--config", "yard.toml", "--passes", "1000", "--log", "new.csv"), "new.csv"),
    Writing(("inspect", "table.json", "--config", "yard.toml"), f"{TABLE}-lines.svg"),
    Writing(("loop", "table.json", "--config", "yard.toml"), "loops.json"),
    Writing(("verify", "table.json", "--passes", "100"), "report.html"),
)


def pairs(commands: Iterable[Writing]) -> list[object]:
    """Each command with each of its inputs."""
    return [pytest.param(each, name, id=f"{each.name} {name}") for each in commands for name in each.inputs]


@pytest.fixture(scope="module")
def inputs(tuned_once: tuple[Path, int], tmp_path_factory: pytest.TempPathFactory) -> Mapping[str, bytes]:
    """Every input by name."""
    folder, tuned = tmp_path_factory.mktemp("inputs"), tuned_once[0]
    texts = {
        "yard.toml": CLASS + SECOND_CLASS,
        "points.toml": CLASS + SENSORS,
        "own.toml": LIBRARY + changed(CLASS, ('car = "gondola-4"', 'car = "my-gondola"')),
        "sweep.toml": LIBRARY
        + changed(CLASS.partition("[[cut]]")[0], ("[targets]\nexit_speeds_m_s = [1.5]\n", ""))
        + SWEEP,
        "aim.toml": '[cuts]\ncategories = ["L"]\ncars = [1]\n[aim]\nfree_distances_m = [100.0]\n',
        "computer.toml": "[uncertainty]\ndraws = 200\nsobol_points = 16\n",
        "trial.toml": 'hump = "hump.toml"\n[trains]\nnumber = 2\n[aim]\ndesign_cuts = 200\n',
        "hump.toml": hump_text(Path("medium")),
        "short.toml": example_short_toml(),
        "positions.toml": 'logs = "log.csv"\n[[position]]\nname = "1"\n',
        "train.csv": "cut,cars,axles,mass_t,category,track\n1,1,4,22,Л,1\n2,1,4,22,Л,2\n",
        "mapping.toml": '[columns]\ncut_id = "cut_id"\n',
    }
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    shutil.copy(tuned / "book.h5", folder)
    table = Path(shutil.copy(tuned / "tables" / f"{TABLE}.json", folder / "table.json"))
    for log in ("log.csv", "log.h5"):
        words = (table, "--config", folder / "yard.toml", "--passes", 1000, "--log", log, "-o", folder / "validated")
        assert main(["validate", *map(str, words)]) == 0
        shutil.copy(folder / "validated" / log, folder)
    shutil.rmtree(folder / "validated")
    car = BUILT_IN.file(CARS, "gondola-4").text.encode("utf-8")
    return {**{path.name: path.read_bytes() for path in folder.iterdir()}, OWN_CAR: car}


def laid(inputs: Mapping[str, bytes], names: Iterable[str], folder: Path) -> dict[Path, bytes]:
    """The inputs `names` as files below `folder`, beside a file that has nothing to do with it; what they hold."""
    users = {folder / name: inputs[name] for name in names} | {folder / "survey.txt": b"precious"}
    for path, content in users.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    return users


def contents(folder: Path) -> dict[Path, bytes]:
    """Every file below `folder`."""
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.requirement("CMD-05")
@pytest.mark.parametrize(("each", "name"), pairs(DIRECTORIES))
def test_a_directory_that_holds_an_input_is_refused(
    command: Command, inputs: Mapping[str, bytes], tmp_path: Path, each: Writing, name: str
) -> None:
    users = laid(inputs, each.inputs, tmp_path)
    for output in dict.fromkeys((tmp_path, (tmp_path / name).parent, tmp_path / name)):
        ran = command(*each.typed(tmp_path, output))
        assert ran.code == 2
        assert f"retarder-synth: {output}: " in ran.err
        assert contents(tmp_path) == users


@pytest.mark.parametrize(("each", "name"), pairs(DIRECTORIES))
def test_an_input_that_lies_among_results_is_not_written(
    command: Command, inputs: Mapping[str, bytes], tmp_path: Path, each: Writing, name: str
) -> None:
    """It took the place of a result of an earlier run."""
    users, out = laid(inputs, each.inputs, tmp_path), tmp_path / "out"
    with results_directory(out, each.name) as results:
        results.write(each.result, b"a result")
    edited = {out / each.result: inputs[name]}
    (out / each.result).write_bytes(inputs[name])
    ran = command(*each.typed(tmp_path, out))
    assert ran.code == 2
    assert f"{out / each.result}: it was changed after retarder-synth wrote it" in ran.err
    assert contents(tmp_path).items() >= {**users, **edited}.items()


@pytest.mark.parametrize("each", DIRECTORIES, ids=lambda each: each.name)
def test_a_result_that_is_an_input_is_not_written(
    command: Command, inputs: Mapping[str, bytes], tmp_path: Path, each: Writing
) -> None:
    with results_directory(tmp_path, each.name) as results:
        results.write_all({name: inputs[name] for name in each.inputs})
    before = contents(tmp_path)
    ran = command(*each.typed(tmp_path, tmp_path))
    assert ran.code == 2
    assert ": this run reads it and would write or remove it" in ran.err
    assert {
        path: content for path, content in contents(tmp_path).items() if path.name != MARKER
    }.items() <= before.items()


@pytest.mark.requirement("CMD-05")
@pytest.mark.parametrize(
    "each",
    [
        pytest.param(each, marks=pytest.mark.long if each.name == "tune" else (), id=each.name)
        for each in DIRECTORIES
        if each.quick
    ],
)
def test_inputs_above_the_results_keep_their_bytes(
    command: Command, inputs: Mapping[str, bytes], tmp_path: Path, each: Writing
) -> None:
    users = laid(inputs, each.inputs, tmp_path)
    for _ in range(2):
        assert command(*each.typed(tmp_path, tmp_path / "out")).code in (0, 1)
        assert contents(tmp_path).items() >= users.items()
    assert (tmp_path / "out" / each.result).is_file()
