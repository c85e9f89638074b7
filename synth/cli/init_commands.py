"""The command `init`, its options and their help; what it does is in `synth.cli.init`.

Annotations are not postponed here: typer would compile every one of them anew at each start.
"""

from collections.abc import Callable
from inspect import Parameter, signature
from typing import Annotated

import typer

from synth.frame.arguments import Json

FILES = {
    "retarder": ("retarders", "File of a retarder type. With the name of a position: its configuration."),
    "position": ("positions", "File of a position."),
    "car": ("cars", "File of a car type."),
    "sensor": ("sensors", "File of a radar."),
    "wheel_sensor": ("wheel_sensors", "File of a point speed sensor."),
    "sensors": ("point sensors", "Configuration with point sensors, of a position or a file."),
    "weight_categories": ("weight_categories", "File of a set of weight categories."),
    "aim": ("aim", "Aim configuration. With the name of a track or car mix: its file."),
    "hump": ("hump", "Hump trial configuration. With the name of a hump: its file."),
    "short_hump": ("short hump", "Short file that hump make turns into a hump file."),
    "computer": ("computer", "Configuration of a control computer."),
    "sweep": ("sweep", "Table [sweep] of a configuration: what a sweep is over."),
}
"""Options that ask for a file: what `init_command` calls it, and the help."""


def add_init_command(app: typer.Typer) -> None:
    """Add the command to `app`."""
    app.command()(with_file_options(init))


def with_file_options(command: Callable[..., int]) -> Callable[..., int]:
    """`command`, whose keywords are those of `FILES` for the parser; each may stand without a name
    (`arguments.with_names`)."""
    options = [
        Parameter(
            name,
            Parameter.KEYWORD_ONLY,
            default=None,
            annotation=Annotated[str | None, typer.Option(metavar="[NAME]", help=words)],
        )
        for name, (_, words) in FILES.items()
    ]
    own = [each for each in signature(command).parameters.values() if each.kind is not Parameter.VAR_KEYWORD]
    own = [each.replace(kind=Parameter.KEYWORD_ONLY) for each in own]
    parameters = [*options, *own]
    # mypy knows no such attribute, though every callable may have it
    command.__signature__ = signature(command).replace(parameters=parameters)  # type: ignore[attr-defined]
    command.__annotations__ = {each.name: each.annotation for each in parameters}
    return command


def init(
    show_list: Annotated[bool, typer.Option("--list", help="Only list what the library holds.")] = False,
    schema: Annotated[
        bool, typer.Option("--schema", help="The JSON Schema of such a configuration instead, for editors.")
    ] = False,
    as_json: Json = False,
    **files: str | None,
) -> int:
    """Print a commented configuration to start from, or the file of one type."""
    from synth.cli.init import init_command, schema_command

    if schema:
        return schema_command({FILES[name][0]: given for name, given in files.items()})
    return init_command({FILES[name][0]: given for name, given in files.items()}, show_list, as_json)
