"""The parts of the exports in C that no rule of Python gives: the files `c99/*.in`."""

from importlib.resources import files


def part(name: str) -> str:
    """The text of the file `name` as it stands."""
    return (files("tuning_tables") / "c99" / f"{name}.in").read_text("ascii")
