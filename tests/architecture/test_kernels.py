"""Kernels: what they are compiled from names their cache, and one file alone knows numba's inside."""

from __future__ import annotations

import ast
import importlib
import importlib.util
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from importlib.metadata import version
from pathlib import Path
from types import ModuleType

import pytest

from synth.kernels.cache import kernel_sources
from tests.architecture.compiled_from import PACKAGES, ROOT, compiled_from

INTERNALS = "synth/kernels/vector/numba_internals.py"
STABLE = {"overload"}
"""What `numba.extending` offers as its high-level part."""


def kernel_modules() -> Iterator[ModuleType]:
    for name in kernel_sources(ROOT):
        if "/kernels/" in name:
            yield importlib.import_module(name.removesuffix(".py").removesuffix("/__init__").replace("/", "."))


def test_the_fingerprint_covers_what_kernels_are_compiled_from_and_nothing_else() -> None:
    found = compiled_from(kernel_modules())
    assert {"synth/kernels/sweep/bellman.py", "synth/kernels/loop/regulator.py"} <= found
    listed = set(kernel_sources(ROOT))
    assert found <= listed, "add these files to _KERNEL_SOURCES in synth/kernels/cache.py"
    assert {name for name in listed if "/kernels/" not in name} <= found, "no kernel is compiled from these any more"


@pytest.mark.parametrize(
    ("source", "file"),
    [
        ("from plant_models.cut import GRAVITY_M_S2\n@njit\ndef f(x):\n    return GRAVITY_M_S2 * x\n", "cut"),
        ("from plant_models import cut\n@njit\ndef f(x):\n    return cut.GRAVITY_M_S2 * x\n", "cut"),
        ("from plant_models.motion import cell_means\n@njit\ndef f(x):\n    return cell_means(x, x, x)\n", "motion"),
        ("from plant_models.motion import cell_means\nf = njit(cell_means)\n", "motion"),
    ],
    ids=["a constant", "a constant of a module", "a function", "a function compiled as it stands"],
)
def test_a_kernel_that_uses_another_file_is_found(tmp_path: Path, source: str, file: str) -> None:
    path = tmp_path / f"intruder_{abs(hash(source))}.py"
    path.write_text("from numba import njit\n" + source)
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None
    assert spec.loader is not None
    sys.modules[path.stem] = module = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
        assert f"plant_models/{file}.py" in compiled_from([module])
    finally:
        del sys.modules[path.stem]


CACHE_PATHS = """
import importlib, os, sys

for package in sys.argv[1:]:
    for loaded in [each for each in sys.modules if each.startswith(("scripts", "synth"))]:
        del sys.modules[loaded]
    os.environ.pop("NUMBA_CACHE_DIR", None)
    if "numba" in sys.modules:
        sys.modules["numba"].config.CACHE_DIR = ""
    for name in package.split():
        importlib.import_module(name)
    from synth.kernels.cache import kernel_fingerprint

    part = f"/retarder-synth/{kernel_fingerprint()}/"
    for name in package.split():
        caches = [each._cache for each in vars(sys.modules[name]).values() if hasattr(each, "py_func")]
        paths = [cache.cache_path for cache in caches if hasattr(cache, "cache_path")]
        print(name, {part in path for path in paths})
"""


def test_every_kernel_is_cached_in_the_directory_of_the_fingerprint() -> None:
    """Whichever package of kernels is imported first, in a process that knows nothing of the cache.

    Python imports the package before any module of it.
    """
    names = [module.__name__ for module in kernel_modules() if any(map(is_cached, vars(module).values()))]
    assert len(names) > 10
    packages: dict[str, list[str]] = {}
    for name in names:
        packages.setdefault(name.partition(".kernels.")[0], []).append(name)
    ran = subprocess.run(
        [sys.executable, "-c", CACHE_PATHS, *map(" ".join, packages.values())],
        cwd=ROOT, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert ran.returncode == 0, ran.stderr
    assert ran.stdout.splitlines() == [f"{name} {{True}}" for found in packages.values() for name in found]


def is_cached(value: object) -> bool:
    """Whether `value` is a kernel that numba keeps on the disk."""
    return hasattr(getattr(value, "_cache", None), "cache_path")


def private_parts(text: str) -> Iterator[str]:
    """What `text` takes from numba's or llvmlite's inside, one line each."""
    if not any(word in text for word in ("numba", "llvmlite", "_nrt")):
        return  # nine files of ten, and to parse them takes seconds
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ImportFrom):
            names = {alias.name for alias in node.names}
            module = node.module or ""
            inside = module.startswith(("numba.", "llvmlite")) or (module == "numba" and names & {"core", "extending"})
            if inside and not (module == "numba.extending" and names <= STABLE) and module != "numba.typed":
                yield f"line {node.lineno}: from {module} import {', '.join(sorted(names))}"
        elif isinstance(node, ast.Import):
            for alias in node.names:
                if alias.name.startswith(("numba.", "llvmlite")):
                    yield f"line {node.lineno}: import {alias.name}"
        elif isinstance(node, ast.Attribute) and ast.unparse(node) in ("numba.core", "numba.extending"):
            yield f"line {node.lineno}: {ast.unparse(node)}"
        elif isinstance(node, ast.keyword) and node.arg == "_nrt":
            yield f"line {node.lineno}: _nrt"
        elif isinstance(node, ast.Constant) and node.value in ("_nrt", "numba.core.caching"):
            yield f"line {node.lineno}: {node.value!r}"


@pytest.mark.parametrize("package", PACKAGES)
def test_one_file_alone_knows_the_inside_of_numba(package: str) -> None:
    found = {
        path.relative_to(ROOT).as_posix(): list(private_parts(path.read_text(encoding="utf-8")))
        for path in (ROOT / package).rglob("*.py")
    }
    assert {name: parts for name, parts in found.items() if parts and name != INTERNALS} == {}
    assert package != "synth" or len(found[INTERNALS]) >= 5


@pytest.mark.parametrize(
    "offence",
    [
        "from llvmlite import ir",
        "import llvmlite.binding",
        "from numba.core import cgutils",
        "from numba import extending",
        "from numba.extending import intrinsic, overload",
        "import numba\nnumba.core.types",
        "from numba import njit\nnjit(_nrt=False)",
        "OPTIONS = {'_nrt': False}",
    ],
)
def test_a_private_part_of_numba_is_found(offence: str) -> None:
    assert len(list(private_parts(offence))) == 1


@pytest.mark.parametrize("fine", ["from numba import njit, types", "from numba.extending import overload"])
def test_what_numba_promises_is_no_private_part(fine: str) -> None:
    assert list(private_parts(fine)) == []


def test_numba_is_capped_to_what_its_inside_was_tested_with() -> None:
    """The file that names numba's private parts says with what; pyproject.toml allows that minor release alone."""
    locked = {
        line.split("==")[0]: line.split("==")[1].split()[0]
        for line in (ROOT / "requirements.lock").read_text().splitlines()
        if "==" in line and not line.startswith((" ", "#"))
    }
    told = (ROOT / INTERNALS).read_text()
    needed = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["dependencies"]
    for name in ("numba", "llvmlite"):
        assert f"{name} {locked[name]}" in told
        major, minor, _ = locked[name].split(".")
        assert f"{name}>={major}.{minor},<{major}.{int(minor) + 1}" in needed
    assert version("numba")  # installed at all
