"""A command that does not come to its end, the configuration that it keeps, and the marker of its directory."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import NoReturn

import pytest

from synth.frame.command import Command, Unfinished, Work
from synth.frame.exhibits import Chapter, File
from synth.frame.faults import InputError
from synth.frame.interval import Interval
from synth.frame.own_files import LOCK, MARKER, held, is_held
from synth.frame.page.told_page import shown
from synth.frame.perform import asked_of, perform
from synth.frame.results_directory import CONFIGURATION, results_directory
from synth.frame.settings.toml_file import read_text
from synth.frame.terminal.manner import Manner
from tests.frame.small_command import COMMAND, SUMMARY, CoinFile, CoinOptions, Game, files, refused, results_in, run

Coins = Command[CoinFile, CoinOptions, Game, dict[str, Interval]]


def done(command: Coins, out: Path, config: Path | None = None) -> int:
    """Exit code of a run."""
    return perform(command, asked_of(command, CoinOptions(config=config), "init --coin"), out, Manner())


def lose_a_coin(game: Game, work: Work) -> NoReturn:
    """Stores half of the work."""
    work.directory.store("throws/1.txt", b"heads")
    raise Unfinished("throw 2: the coin is gone")


def test_what_cannot_be_done_is_one_sentence_and_what_was_done_stays(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lost = replace(COMMAND, compute=lose_a_coin)
    for _ in range(2):
        assert done(lost, tmp_path) == 1
        said = capsys.readouterr()
        (sentence,) = said.err.splitlines()[-1:]
        assert sentence.startswith("retarder-synth: throw 2: the coin is gone; what was done before is kept in ")
        assert said.out == ""
        assert results_in(tmp_path) == {"throws/1.txt": b"heads"}


def test_it_is_known_whether_a_next_run_goes_on(tmp_path: Path) -> None:
    with results_directory(tmp_path, "throw coins") as directory:
        directory.write("coins.txt", b"heads")
        told = [directory.goes_on]
        directory.store("throws/1.txt", b"heads")
        told.append(directory.goes_on)
    with results_directory(tmp_path, "throw coins") as directory:
        told.append(directory.goes_on)
    assert told == [False, True, True]


def test_a_chapter_is_written_before_the_next_one_is_made(tmp_path: Path) -> None:
    def broken(found: dict[str, Interval]) -> Iterator[Chapter]:
        yield next(iter(COMMAND.show(found)))
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        done(replace(COMMAND, show=broken), tmp_path)
    assert list(results_in(tmp_path)) == ["sheets/shares.csv"]


def test_copies_of_what_is_read_may_be_read_by_a_next_run(tmp_path: Path) -> None:
    def copying(game: Game, work: Work) -> dict[str, Interval]:
        work.directory.write("inputs/coin.toml", b"[coin]\nthrows = 150\n")
        return COMMAND.compute(game, work)

    config = tmp_path / "inputs" / "coin.toml"
    own, other = (replace(COMMAND, compute=copying, inputs=folder) for folder in ("inputs", ""))
    assert done(own, tmp_path) == 0
    assert done(own, tmp_path, config) == 0
    assert config.is_file()
    with pytest.raises(InputError, match="this run reads it and would write or remove it"):
        done(other, tmp_path, config)


def test_a_command_may_read_its_configuration_in_a_way_of_its_own(tmp_path: Path) -> None:
    named = replace(COMMAND, text=lambda path, init: f'title = "{path.name} or {init}"\n')
    assert asked_of(named, CoinOptions(config=Path("gold")), "init --coin").settings.title == "gold or init --coin"


def test_a_page_links_to_a_file_that_has_a_title() -> None:
    assert shown(File("hump.html", b"", "Play <it>"), {}) == '<p><a href="hump.html">Play &lt;it&gt;</a></p>'
    assert shown(File("trains.npz", b""), {}) == ""


TEXT = b"# \xd1\x82\xd0\xb0\xd0\xba\r\n[coin]\r\nthrows =   150\n\n[output]\nplots = false\nreport = false\n"


def kept_by(config: Path | None, output: Path, command: Command = COMMAND) -> list[str]:  # type: ignore[type-arg]
    """The files that the summary lists after a run."""
    perform(command, asked_of(command, CoinOptions(config=config), "init --coin"), output, Manner())
    return sorted(json.loads((output / "summary.json").read_bytes())["files"])


@pytest.fixture
def config(tmp_path: Path) -> Path:
    """A file of the user."""
    (tmp_path / "coin.toml").write_bytes(TEXT)
    return tmp_path / "coin.toml"


def test_it_is_kept_byte_for_byte_until_a_run_has_none(config: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert CONFIGURATION in kept_by(config, out)
    assert (out / CONFIGURATION).read_bytes() == TEXT
    assert CONFIGURATION not in kept_by(None, out)
    assert not (out / CONFIGURATION).exists()


def test_a_run_may_begin_from_the_copy(config: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    files = kept_by(config, out)
    written = (out / CONFIGURATION).stat().st_mtime_ns
    assert kept_by(out / CONFIGURATION, out) == files
    assert (out / CONFIGURATION).stat().st_mtime_ns == written


def test_a_file_of_the_user_in_its_place_stays(config: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    kept_by(None, out)
    own = out / CONFIGURATION
    own.write_bytes(TEXT + b"# mine\n")
    assert CONFIGURATION not in kept_by(own, out)
    with pytest.raises(InputError, match=f"{CONFIGURATION}: retarder-synth did not write it"):
        kept_by(config, out)
    assert own.read_bytes() == TEXT + b"# mine\n"


def test_what_is_read_in_a_way_of_its_own_is_not_kept(config: Path, tmp_path: Path) -> None:
    command = replace(COMMAND, text=lambda path, init: read_text(path, init))
    assert CONFIGURATION not in kept_by(config, tmp_path / "out", command)


def test_a_line_that_was_torn_makes_a_file_a_strangers(tmp_path: Path) -> None:
    run(tmp_path, {"a": b"a", "b": b"b"})
    marker = tmp_path / MARKER
    content = marker.read_bytes()
    marker.write_bytes(content[: content.index(b'["summary.json"')] + b'["summary.json","12')
    with refused(str(tmp_path / "summary.json"), "did not write it"):
        run(tmp_path, {"c": b"c"})
    assert files(tmp_path) == {"c": b"c", "summary.json": SUMMARY}
    (tmp_path / "summary.json").unlink()
    run(tmp_path, {"c": b"c"})
    assert files(tmp_path) == {"c": b"c", "summary.json": SUMMARY}


def test_a_marker_that_is_none_marks_nothing(tmp_path: Path) -> None:
    for content in (b"", b"notes of mine", b'{"format": "retarder-synth-results"}\n', b"[" * 100_000, b"\xff\xfe"):
        (tmp_path / MARKER).write_bytes(content)
        with refused(MARKER, "did not write"):
            run(tmp_path, {"a": b"a"})
        assert (tmp_path / MARKER).read_bytes() == content


def test_a_marker_of_somebody_else_reaches_nothing_outside(tmp_path: Path) -> None:
    """It lists files elsewhere as results that may have any content."""
    users = tmp_path / "users"
    users.mkdir()
    (users / "a").write_bytes(b"precious")
    out = tmp_path / "out"
    run(out, {"b": b"b"})
    (out / "link").symlink_to(users)
    (out / "file").symlink_to(users / "a")
    (out / "loop").symlink_to(out / "loop")
    names = ("../users/a", str(users / "a"), "link/a", "file", "loop", "loop/a", "a\0b", "c/../../users/a")
    with (out / MARKER).open("ab") as marker:
        marker.write(b"".join(json.dumps([name, "changes"]).encode() + b"\n" for name in names))
    run(out, {"c": b"c"})
    assert files(users) == {"a": b"precious"}
    for name in ("link/a", "file"):
        with refused("did not write it"):
            run(out, {name: b"ours"})
    assert files(users) == {"a": b"precious"}


def test_the_same_run_leaves_the_same_marker(tmp_path: Path) -> None:
    markers = []
    for name, names in (("first", "abc"), ("second", "cab")):
        run(tmp_path / name, {each: each.encode() for each in names})
        run(tmp_path / name, {each: each.encode() for each in reversed(names)})
        markers.append((tmp_path / name / MARKER).read_bytes())
    assert markers[0] == markers[1]


def test_the_marker_is_on_the_disk_before_a_file_has_its_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Else a machine that stops would leave a file of the command that the marker does not know."""
    synced: set[int] = set()
    to_disk, naming = os.fsync, os.replace

    def sync(descriptor: int) -> None:
        to_disk(descriptor)
        if os.fstat(descriptor).st_ino == (tmp_path / MARKER).stat().st_ino:
            synced.add((tmp_path / MARKER).stat().st_size)

    def name(source: Path, target: Path) -> None:
        if target.name != MARKER:
            assert (tmp_path / MARKER).stat().st_size in synced
        naming(source, target)

    with results_directory(tmp_path, "tune") as results:
        monkeypatch.setattr(os, "fsync", sync)
        monkeypatch.setattr(os, "replace", name)
        results.write("tables/a.json", b"abc")
        results.store("units/b", b"abc")


def test_a_directory_is_held_by_one_command(tmp_path: Path) -> None:
    with results_directory(tmp_path, "tune"), refused("another tune is writing there"):
        run(tmp_path, {}, "tune")
    with results_directory(tmp_path, "tune"), refused("another tune is writing there"):
        run(tmp_path, {}, "aim")
    run(tmp_path, {})


def test_who_only_asks_is_not_taken_for_a_run(tmp_path: Path) -> None:
    assert not is_held(tmp_path)
    with held(tmp_path) as is_ours:
        assert is_ours
        assert is_held(tmp_path)
    assert not is_held(tmp_path)
    assert list(tmp_path.iterdir()) == []


HOLD = """
import sys
from pathlib import Path
from synth.frame.own_files import held

with held(Path(sys.argv[1])) as is_ours:
    print(is_ours, flush=True)
    sys.stdin.read()
"""


def test_a_killed_process_holds_nothing(tmp_path: Path) -> None:
    command = [sys.executable, "-c", HOLD, str(tmp_path)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as holder:
        assert holder.stdout is not None
        assert holder.stdout.readline() == "True\n"
        assert is_held(tmp_path)
        with refused("another tune is writing there"):
            run(tmp_path, {}, "tune")
        holder.kill()
        holder.wait()
    assert (tmp_path / LOCK).exists()
    assert not is_held(tmp_path)
    run(tmp_path, {}, "tune")
    assert not (tmp_path / LOCK).exists()
