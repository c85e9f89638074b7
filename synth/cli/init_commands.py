"""The command `init`, its options and their help; what it does is in `synth.cli.init`.

Annotations are not postponed here: typer would compile every one of them anew at each start.
"""

from collections.abc import Callable
from inspect import Parameter, signature
from pathlib import Path
from typing import Annotated

import typer

from synth.frame.arguments import Json, whole_number

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
    for_trial: Annotated[
        Path | None,
        typer.Option(
            "--for",
            metavar="TRIAL.toml|HUMP",
            help="Configuration of the tables that a position needs in this hump trial.",
        ),
    ] = None,
    position_number: Annotated[
        int | None,
        typer.Option(
            parser=whole_number(1, 10),
            metavar="N",
            help="With --for: which position, 1 being the first behind the crest.",
        ),
    ] = None,
    as_json: Json = False,
    **files: str | None,
) -> int:
    """Print a commented configuration to start from, or the file of one type."""
    from synth.cli.init import init_command, schema_command, tables_command

    types = {FILES[name][0]: given for name, given in files.items()}
    if for_trial is not None or position_number is not None:
        alone = not (schema or show_list or any(given is not None for given in types.values()))
        return tables_command(for_trial, position_number, alone, as_json)
    return schema_command(types) if schema else init_command(types, show_list, as_json)
