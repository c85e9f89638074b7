"""Commands on the command line: the Typer function of each, and what its help shows, follow from its declaration.

Only the command that is asked for is loaded; of the others the list shows name and help.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from inspect import Parameter
from pathlib import Path
from pkgutil import resolve_name
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer
from typer.core import TyperArgument, TyperGroup

if TYPE_CHECKING:
    from pydantic.fields import FieldInfo

    from synth.frame.command import Command
    from synth.frame.settings.options import Options, Words
    from synth.frame.terminal.manner import Manner

PROGRAM: Final = "retarder-synth"
PAGES: Final = "docs"
"""Where pages are in a checkout."""


@dataclass(frozen=True)
class Shown:
    """`example`: as it is typed behind the name of the program; `page`: of the documentation."""

    example: str
    page: str

    @property
    def epilog(self) -> str:
        """What stands at the end of the help."""
        return f"Example: {PROGRAM} {self.example}\n\nMore: {PAGES}/{self.page}"


@dataclass(frozen=True)
class CommandGuide:
    """Of the group that is typed `words` ("" for the program): its commands by `sections`, and what is `shown` of each;
    nothing of a group within it, which has a guide of its own."""

    words: str
    sections: Mapping[str, tuple[str, ...]]
    shown: Mapping[str, Shown]


@dataclass(frozen=True)
class Listed:
    """A command as the program lists it.

    `words`: as it is typed, "sensors"; `place` of the `Command` and `options_place` of its options alone, each
    "module:NAME"; `init`: what prints a configuration; `help`: what it does, a paragraph or two. `folder`: where its
    results go unless told; in a folder of its name in out/ if that is not given.
    """

    words: str
    place: str
    options_place: str
    init: str
    help: str
    folder: str = ""

    def load(self) -> Command[Any, Any, Any, Any]:
        """The command, imported."""
        command: Command[Any, Any, Any, Any] = resolve_name(self.place)
        return command

    def options(self) -> type[Options]:
        """The model of its options, imported."""
        options: type[Options] = resolve_name(self.options_place)
        return options

    @property
    def name(self) -> str:
        """Its last word."""
        return self.words.rpartition(" ")[2]

    @property
    def output(self) -> Path:
        """Where its results go unless told."""
        return Path(self.folder) if self.folder else Path("out") / self.words.replace(" ", "-")


def listed_group(listed: Sequence[Listed], guide: CommandGuide) -> type[TyperGroup]:
    """A group of commands that has these among its own: with their options as soon as one of them is called. Its help
    shows the sections of `guide`, and that of each command its example."""
    by_name = {each.name: each for each in listed}

    class ListedGroup(TyperGroup):
        """Commands of the frame, loaded when they are called."""

        def resolve_command(self, ctx: Any, args: list[str]) -> tuple[str | None, Any, list[str]]:
            name, found, rest = super().resolve_command(ctx, args)
            command = loaded(by_name[name]) if name in by_name else found
            if command is not None and name is not None and name in guide.shown:
                command.epilog = guide.shown[name].epilog
                for each in command.params:
                    if isinstance(each, TyperArgument):  # its metavar says what it is; the type is Python's word for it
                        each.display_type = no_type  # type: ignore[method-assign, assignment]
            return name, command, rest

        def format_commands(self, ctx: Any, formatter: Any) -> None:
            for title, names in guide.sections.items():
                with formatter.section(title):
                    formatter.write_dl([(name, first_sentence(self.commands[name].help or "")) for name in names])

    return ListedGroup


def no_type(context: Any) -> str:
    """What the help says of the type of an argument."""
    return ""


def first_sentence(text: str) -> str:
    """What a command does, in one sentence."""
    return " ".join(text.strip().partition("\n\n")[0].split())


def add_listed(app: typer.Typer, listed: Sequence[Listed]) -> None:
    """Have the help of `app` tell of these commands."""
    for each in listed:
        app.command(each.name, help=each.help)(lambda: 0)


def loaded(listed: Listed) -> Any:
    """The command with the options that it declares."""
    app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)
    options = tuple(option_parameters(listed.options()))
    help_names = {"help_option_names": ["-h", "--help"]}
    app.command(listed.name, help=listed.help, context_settings=help_names)(function(listed, options))
    return typer.main.get_command(app)


def option_parameters(options: type[Options]) -> Iterator[Parameter]:
    """A keyword for each declared option; what must be typed has no default."""
    for key, field in options.model_fields.items():
        default = Parameter.empty if field.is_required() else False if field.annotation is bool else None
        yield Parameter(key, Parameter.KEYWORD_ONLY, default=default, annotation=annotation_of(field))


def annotation_of(field: FieldInfo) -> Any:
    """What Typer is told of an option; its words are read by the declared model."""
    from synth.frame.settings.options import BY_PLACE, flag_of, metavar_of, takes_several

    flag, metavar = flag_of(field), metavar_of(field)
    word = Path if flag == BY_PLACE else str
    words: Any = list[word] if takes_several(field) else word  # type: ignore[valid-type]  # Typer reads it as a value
    if field.annotation is bool:
        return Annotated[bool, typer.Option(flag, help=field.description)]
    if flag == BY_PLACE:
        return Annotated[words | None, typer.Argument(metavar=metavar, help=field.description)]
    unsaid = field.is_required() or field.default in (None, ())
    default = "" if unsaid else f" [default: {as_typed(field.default)}]"
    return Annotated[words | None, typer.Option(flag, metavar=metavar, help=f"{field.description}{default}")]


def as_typed(value: object) -> str:
    """A default as it would be typed; a list has commas."""
    return ",".join(map(str, value)) if isinstance(value, tuple) else str(value)


def function(listed: Listed, options: tuple[Parameter, ...]) -> Callable[..., int]:
    """A function with the signature that Typer reads."""
    from synth.frame.arguments import directory, in_its_manner, with_parameters

    def run(output: Path, manner: Manner, **words: Words) -> int:
        from synth.frame.settings.options import read_options

        typed = read_options(listed.options(), words)
        from synth.frame.perform import asked_of, perform

        command = listed.load()
        asked = asked_of(command, typed, listed.init)
        return perform(command.variant(asked) if command.variant else command, asked, output, manner)

    folder = typer.Option("-o", "--output", parser=directory, metavar="DIR", help="Where the results go.")
    common = [
        Parameter("output", Parameter.KEYWORD_ONLY, default=listed.output, annotation=Annotated[Path, folder]),
        Parameter("manner", Parameter.KEYWORD_ONLY),
    ]
    return in_its_manner(with_parameters(run, [*common, *options], run))
