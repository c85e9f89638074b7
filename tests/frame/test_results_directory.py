"""A directory of results: what the command did not write keeps its bytes, whatever happens in between."""

from __future__ import annotations

import itertools
import random
from pathlib import Path

import pytest

from synth.frame.faults import InputError
from synth.frame.own_files import MARKER
from synth.frame.results_directory import ResultsDirectory, results_directory
from tests.effort import sized
from tests.frame.small_command import SUMMARY, files, refused, run


class Killed(BaseException):
    """The end of a process, as far as a test within one can have it."""


def test_a_new_or_empty_directory_is_taken_and_taken_again(tmp_path: Path) -> None:
    for path in (tmp_path / "new" / "deep", tmp_path):
        run(path, {"tables/a.json": b"a", "b.csv": b"b"})
        assert files(path)["tables/a.json"] == b"a"
        run(path, {"tables/c.json": b"c", "b.csv": b"other"})
        assert {name: content for name, content in files(path).items() if not name.startswith("new/")} == {
            "tables/c.json": b"c", "b.csv": b"other", "summary.json": SUMMARY,
        }  # fmt: skip
        for file in sorted(path.rglob("*"), reverse=True):
            file.rmdir() if file.is_dir() else file.unlink()


def test_a_directory_with_a_file_of_somebody_else_is_refused(tmp_path: Path) -> None:
    unfinished = f".a.json.{'0' * 16}.part"
    for name in ("survey.csv", "inputs/deep/survey.csv", ".hidden", unfinished):
        path = tmp_path / name.replace("/", "-")
        (path / name).parent.mkdir(parents=True)
        (path / name).write_bytes(b"precious")
        with refused(str(path), name, "which 'tune' did not write", "give a new or an empty directory by -o"):
            run(path, {"tables/a.json": b"a"})
        assert files(path) == {name: b"precious"}
        assert not (path / MARKER).exists()
    killed_at_once = tmp_path / "killed"
    killed_at_once.mkdir()
    (killed_at_once / unfinished.replace(".a.json", f".{MARKER}")).touch()
    run(killed_at_once, {"a.json": b"a"})
    assert files(killed_at_once) == {"a.json": b"a", "summary.json": SUMMARY}


def test_results_of_another_command_are_refused_but_may_lie_below(tmp_path: Path) -> None:
    run(tmp_path / "aim", {"report.html": b"aim"}, "aim")
    run(tmp_path, {"report.html": b"tune"}, "tune")
    run(tmp_path / "new", {"report.html": b"watch"}, "watch")
    with refused("it holds the results of 'tune'"):
        run(tmp_path, {"report.html": b"aim"}, "aim")
    assert files(tmp_path)["aim/report.html"] == b"aim"
    run(tmp_path, {}, "tune")
    assert {"aim/report.html", "new/report.html"} <= set(files(tmp_path))
    assert "report.html" not in files(tmp_path)


def test_what_a_user_adds_is_neither_removed_nor_replaced(tmp_path: Path) -> None:
    run(tmp_path, {"tables/a.json": b"a"})
    (tmp_path / "tables" / "mine.json").write_bytes(b"mine")
    (tmp_path / "notes.txt").write_bytes(b"notes")
    run(tmp_path, {"tables/b.json": b"b"})
    assert files(tmp_path) == {
        "tables/b.json": b"b", "tables/mine.json": b"mine", "notes.txt": b"notes", "summary.json": SUMMARY,
    }  # fmt: skip
    with refused(str(tmp_path / "tables" / "mine.json"), "retarder-synth did not write it", "move it away"):
        run(tmp_path, {"tables/mine.json": b"ours"})
    assert files(tmp_path)["tables/mine.json"] == b"mine"


def test_what_a_user_changes_is_refused_before_anything_is_written(tmp_path: Path) -> None:
    run(tmp_path, {"config.toml": b"a = 1", "report.html": b"page"})
    (tmp_path / "config.toml").write_bytes(b"a = 2  # mine")
    with refused(str(tmp_path / "config.toml"), "it was changed after retarder-synth wrote it"):
        run(tmp_path, {"report.html": b"other"})
    assert files(tmp_path) == {"config.toml": b"a = 2  # mine", "report.html": b"page", "summary.json": SUMMARY}
    (tmp_path / "config.toml").unlink()
    run(tmp_path, {"config.toml": b"a = 3"})
    assert files(tmp_path) == {"config.toml": b"a = 3", "summary.json": SUMMARY}


def test_what_a_user_changes_during_a_run_is_known_to_the_next(tmp_path: Path) -> None:
    run(tmp_path, {"a.csv": b"a"})
    with results_directory(tmp_path, "tune"):
        (tmp_path / "a.csv").write_bytes(b"mine")
    with refused(str(tmp_path / "a.csv"), "it was changed after retarder-synth wrote it"):
        run(tmp_path, {"a.csv": b"b"})
    (tmp_path / "a.csv").write_bytes(b"a")
    run(tmp_path, {"a.csv": b"b"})
    assert files(tmp_path) == {"a.csv": b"b", "summary.json": SUMMARY}


def test_what_a_command_reads_it_does_not_write(tmp_path: Path) -> None:
    run(tmp_path, {"book.h5": b"book", "inputs/a.toml": b"a"})
    before = files(tmp_path)
    link = tmp_path.parent / f"{tmp_path.name}-link.h5"
    link.symlink_to(tmp_path / "book.h5")
    reads = (tmp_path / "book.h5", tmp_path / "inputs" / ".." / "book.h5", link)
    for read, inputs in itertools.product(reads, ("", "inputs")):
        with refused(str(tmp_path / "book.h5"), "this run reads it and would write or remove it"):
            run(tmp_path, {}, reads=(read,), inputs=inputs)
        assert files(tmp_path) == before


def test_a_run_may_begin_from_copies_of_its_inputs(tmp_path: Path) -> None:
    run(tmp_path, {"inputs/a.toml": b"a", "inputs/old.csv": b"old"})
    source = tmp_path / "inputs" / "a.toml"
    written = source.stat().st_mtime_ns
    with results_directory(tmp_path, "tune", [source], inputs="inputs") as results:
        results.write("inputs/a.toml", b"a")
        assert results.written.keys() == {"inputs/a.toml"}
        results.finish(SUMMARY)
    assert source.stat().st_mtime_ns == written
    assert files(tmp_path) == {"inputs/a.toml": b"a", "summary.json": SUMMARY}
    with refused("this run reads it"), results_directory(tmp_path, "tune", [source], inputs="inputs") as results:
        results.write("inputs/a.toml", b"b")
    with results_directory(tmp_path, "tune", [source], inputs="inputs") as results:
        results.finish(SUMMARY)
    assert source.read_bytes() == b"a"


def test_a_killed_run_leaves_no_summary_and_is_known_to_the_next(tmp_path: Path) -> None:
    run(tmp_path, {"a": b"old", "b": b"old"})

    def killed_run() -> None:
        with results_directory(tmp_path, "tune") as results:
            results.write("a", b"new")
            results.write("c/d", b"new")
            (tmp_path / "c" / f".e.{'0' * 16}.part").write_bytes(b"a stranger's: 'e' was never begun")
            with results.writing("c/f") as part:
                part.with_name(f".f.{'0' * 16}.part").write_bytes(b"left by a kill, which raises nothing")
                raise Killed

    with pytest.raises(Killed):
        killed_run()
    assert files(tmp_path).keys() == {"a", "b", "c/d", f"c/.e.{'0' * 16}.part", f"c/.f.{'0' * 16}.part"}
    run(tmp_path, {"b": b"newer"})
    assert files(tmp_path).keys() == {"b", "summary.json", f"c/.e.{'0' * 16}.part"}


def test_stored_results_are_replaced_where_they_are_damaged(tmp_path: Path) -> None:
    with results_directory(tmp_path, "sweep") as results:
        results.store("units/a", b"sealed")
        results.growing("ledger").write_bytes(b"line\n")
        assert results.written == {}
        results.finish(SUMMARY)
    (tmp_path / "units" / "a").write_bytes(b"damaged")
    (tmp_path / "ledger").write_bytes(b"line\nline\n")
    with results_directory(tmp_path, "sweep") as results:
        results.retain(*results.names_below("units"))
        results.store("units/a", b"sealed again")
        results.growing("ledger")
        results.finish(SUMMARY)
    assert files(tmp_path) == {"units/a": b"sealed again", "ledger": b"line\nline\n", "summary.json": SUMMARY}
    (tmp_path / "units" / "b").write_bytes(b"a stranger's")
    with refused("did not write it"), results_directory(tmp_path, "sweep") as results:
        results.store("units/b", b"ours")


def test_what_is_below_a_folder_has_its_name_before_the_slash(tmp_path: Path) -> None:
    names = ("tables/a.json", "tables/deep/b.json")
    run(tmp_path, dict.fromkeys([*names, "tables-of-others/c.json", "tables.csv", "deep/tables/d.json"], b"x"))
    with results_directory(tmp_path, "tune") as results:
        assert results.names_below("tables") == names
        results.write(names[1], b"y")
        results.write("tables.csv", b"y")
        assert [*results.written_below("tables")] == ["deep/b.json"]


def test_what_is_no_directory_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(b"mine")
    for path, words in ((tmp_path / "file", "this is a file"), (tmp_path / "file" / "below", "a part of this path")):
        with refused(str(path), words):
            run(path, {})
    assert files(tmp_path) == {"file": b"mine"}


NAMES = ("a", "b", "tables/a", "tables/b", "inputs/a", "units/a", "summary.json", MARKER + "-2")


def act(results: ResultsDirectory, rng: random.Random) -> None:
    """Something that a command does with a file, now and then a kill."""
    name, content = rng.choice(NAMES[:5]), rng.choice((b"ours", b"ours too"))
    match rng.randrange(7):
        case 0:
            raise Killed
        case 1:
            results.store("units/a", content)
        case 2:
            results.remove(name)
        case 3:
            with results.writing(name) as part:
                part.write_bytes(content)
                if rng.random() < 0.3:
                    raise Killed
        case _:
            results.write(name, content)


HISTORIES = sized(100, 400)


@pytest.mark.requirement("CMD-05")
def test_no_order_of_events_costs_a_byte_of_the_users(tmp_path: Path) -> None:
    """Histories of a user and two commands at one directory, drawn at random."""
    ran = 0
    for seed in range(HISTORIES):
        rng, path, mine = random.Random(seed), tmp_path / str(seed), {}
        for _ in range(6):
            if rng.random() < 0.4:  # the user, who makes a file or edits one
                name = rng.choice(NAMES)
                if name == "units/a" and (path / name).exists():
                    continue  # what a command stores is sealed, and counts as damaged where it was edited
                mine[name] = f"{seed} mine {rng.random()}".encode()
                (path / name).parent.mkdir(parents=True, exist_ok=True)
                (path / name).write_bytes(mine[name])
            else:
                reads = [path / name for name in NAMES if rng.random() < 0.1]
                kept = {each: each.read_bytes() for each in reads if each.is_file()}
                try:
                    with results_directory(path, rng.choice(("tune", "aim")), reads) as results:
                        for _ in range(rng.randrange(6)):
                            act(results, rng)
                        results.finish(b"ours")
                        ran += 1
                except (InputError, Killed):
                    pass
                assert {each: each.read_bytes() for each in kept} == kept
            found = files(path) if path.exists() else {}
            assert {name: found[name] for name in mine} == mine
    assert ran > 0.15 * HISTORIES


def test_an_unfinished_file_of_an_unfinished_file_goes_too(tmp_path: Path) -> None:
    """As a book that is written to the part of its name leaves one where it is interrupted."""
    run(tmp_path, {"book.h5": b"x"})
    mine, other = (tmp_path / f"..{name}.{'a' * 16}.part.{'b' * 16}.part" for name in ("book.h5", "users.h5"))
    for part in (mine, other):
        part.write_bytes(b"half")
    run(tmp_path, {"book.h5": b"x"})
    assert (mine.exists(), other.exists()) == (False, True)


def test_a_disk_that_keeps_other_bytes_is_found_before_the_file_has_its_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = Path.write_bytes
    monkeypatch.setattr(Path, "write_bytes", lambda path, content: whole(path, content[:-1]))
    with pytest.raises(OSError, match="does not read back"):
        run(tmp_path, {"tables/a.json": b"abc"})
    assert not (tmp_path / "tables" / "a.json").exists()
