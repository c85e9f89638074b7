"""Source archive and wheel, built twice from the commit: in two folders, with two masks of permissions."""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
import tarfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from scripts.release.step import ReleaseFault, ran

MASKS: Final = (0o022, 0o077)
SUMS: Final = "SHA256SUMS"


@dataclass(frozen=True)
class Distributions:
    """The two files that are released."""

    sdist: Path
    wheel: Path


def found_in(folder: Path) -> Distributions:
    """The archive and the wheel in `folder`."""
    (sdist,), (wheel,) = folder.glob("*.tar.gz"), folder.glob("*.whl")
    return Distributions(sdist, wheel)


def commit_time(root: Path) -> str:
    """When the commit was made, in seconds since 1970: the date of every file in what is built."""
    return ran(["git", "log", "-1", "--format=%ct"], root).strip()


def exported(root: Path, folder: Path, mask: int) -> Path:
    """The files of the commit in `folder`, with the permissions that `mask` leaves."""
    folder.mkdir(parents=True)
    archive = subprocess.run(["git", "archive", "HEAD"], cwd=root, capture_output=True, check=True).stdout
    subprocess.run(["tar", "-x"], cwd=folder, input=archive, umask=mask, check=True)
    return folder


def build(source: Path, into: Path, date: str, *targets: str) -> None:
    """Build `targets` of the project in `source` by hatchling of this environment."""
    words = [word for target in targets for word in ("-t", target)]
    surroundings: Mapping[str, str] = {**os.environ, "SOURCE_DATE_EPOCH": date}
    ran([sys.executable, "-m", "hatchling", "build", *words, "-d", into], source, surroundings)


def built_twice(root: Path, work: Path, into: Path) -> str:
    """Build both twice, and the wheel once more from the archive; keep them in `into`, with their hashes."""
    date = commit_time(root)
    runs = []
    for number, mask in enumerate(MASKS):
        source = exported(root, work / f"build-{number}" / f"checkout{'-elsewhere' * number}", mask)
        build(source, work / f"dist-{number}", date, "sdist", "wheel")
        runs.append(found_in(work / f"dist-{number}"))
    first, second = runs
    require_equal(first.sdist, second.sdist)
    require_equal(first.wheel, second.wheel)
    with tarfile.open(first.sdist) as archive:
        archive.extractall(work / "unpacked", filter="data")
    (unpacked,) = (work / "unpacked").iterdir()
    build(unpacked, work / "dist-of-sdist", date, "wheel")
    (again,) = (work / "dist-of-sdist").glob("*.whl")
    require_equal(first.wheel, again)
    into.mkdir(exist_ok=True)
    for file in (first.sdist, first.wheel):
        (into / file.name).write_bytes(file.read_bytes())
    sums = "".join(f"{sha256_of(file)}  {file.name}\n" for file in (first.sdist, first.wheel))
    (into / SUMS).write_text(sums, encoding="ascii")
    return f"{first.sdist.name}, {first.wheel.name}: the same bytes twice, and the wheel from the archive too"


def sha256_of(file: Path) -> str:
    """SHA-256 of the file, hexadecimal."""
    return hashlib.sha256(file.read_bytes()).hexdigest()


def require_equal(file: Path, other: Path) -> None:
    """`ReleaseFault` unless both hold the same bytes."""
    if file.read_bytes() != other.read_bytes():
        raise ReleaseFault(f"{file} and {other} differ; diffoscope tells in what")
