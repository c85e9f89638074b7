"""Arrays of frozen values are read-only."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping

import pytest

from tests.architecture.test_shape import SOURCES, decorators, read

KNOWN_WRITABLE: set[str] = set()
"""What still offends; it may only become shorter."""


def array_fields(node: ast.ClassDef, words: set[str]) -> list[ast.AnnAssign]:
    """The fields of a class whose type names one of `words`, but not as what a callable takes or gives."""
    fields = [part for part in node.body if isinstance(part, ast.AnnAssign)]
    return [field for field in fields if words & set(type_names(field.annotation))]


def type_names(annotation: ast.AST) -> Iterator[str]:
    """The names in an annotation, less those inside `Callable`, and less what `Annotated` says of a type."""
    if isinstance(annotation, ast.Subscript) and ast.unparse(annotation.value) == "Callable":
        return
    if isinstance(annotation, ast.Subscript) and ast.unparse(annotation.value) == "Annotated":
        yield from type_names(next(ast.iter_child_nodes(annotation.slice)))
        return
    if isinstance(annotation, ast.Name | ast.Attribute):
        yield annotation.id if isinstance(annotation, ast.Name) else annotation.attr
    for child in ast.iter_child_nodes(annotation):
        yield from type_names(child)


def array_words(sources: Mapping[str, str]) -> set[str]:
    """The names that stand for the type of an array, aliases included."""
    aliases = {
        ast.unparse(node.targets[0])
        for text in sources.values()
        if "NDArray" in text
        for node in ast.parse(text).body
        if isinstance(node, ast.Assign) and "NDArray" in set(type_names(node.value))
    }
    return aliases | {"NDArray", "ndarray"}


def with_arrays(sources: Mapping[str, str]) -> Iterator[tuple[str, ast.ClassDef, list[ast.AnnAssign]]]:
    """(file, class, fields that are arrays) of every dataclass that has some."""
    words = array_words(sources)
    for name, text in sources.items():
        for node in read(text).dataclasses:
            if fields := array_fields(node, words):
                yield name, node, fields


def writable(sources: Mapping[str, str]) -> Iterator[str]:
    """Dataclasses with arrays that can be written to, or that cannot be compared.

    In `tuning_tables`, which knows no `plant_models`, a `__post_init__` must freeze them; there arrays that follow from
    the other fields may be left out of the comparison instead.
    """
    for name, node, fields in with_arrays(sources):
        given = decorators(node)
        frozen = given in (["frozen_arrays"], ["frozen_arrays", "dataclass(frozen=True, eq=False)"])
        if name.startswith("tuning_tables/"):
            left_out = all(field.value is not None and "compare=False" in ast.unparse(field.value) for field in fields)
            frozen = given == ["dataclass(frozen=True, eq=False)"] or (given == ["dataclass(frozen=True)"] and left_out)
            frozen = frozen and "setflags(write=False)" in ast.unparse(node)
        if not frozen:
            yield f"{name}: {node.name}"


def test_arrays_of_frozen_values_are_read_only() -> None:
    assert len(list(with_arrays(SOURCES))) > 40
    assert set(writable(SOURCES)) == KNOWN_WRITABLE


@pytest.mark.parametrize(
    ("name", "decorated", "field", "found"),
    [
        ("synth/a.py", "@frozen_arrays", "NDArray[np.float64]", 0),
        ("synth/a.py", "@frozen_arrays\n@dataclass(frozen=True, eq=False)", "NDArray[np.float64]", 0),
        ("synth/a.py", "@dataclass(frozen=True, eq=False)", "np.ndarray | None", 1),
        ("synth/a.py", "@frozen_arrays\n@dataclass(frozen=True)", "tuple[npt.NDArray[np.float64], ...]", 1),
        ("synth/a.py", "@frozen_arrays\n@dataclass", "Floats", 1),
        ("synth/a.py", "@dataclass(frozen=True)", "Callable[[Floats], Floats]", 0),
        ("synth/a.py", "@dataclass(frozen=True)", "Annotated[float, Floats()]", 0),
        ("synth/a.py", "@dataclass(frozen=True)", "Annotated[Floats, 1]", 1),
        ("tuning_tables/a.py", "@dataclass(frozen=True)", "Floats", 1),
        ("tuning_tables/a.py", "@dataclass(frozen=True)", "Floats = field(compare=False)", 1),
    ],
)
def test_a_writable_array_is_found(name: str, decorated: str, field: str, found: int) -> None:
    source = f"Floats = NDArray[np.float64]\n{decorated}\nclass A:\n    x: {field}\n    y: float\n"
    assert len(list(writable({name: source}))) == found
