"""The commands `retarder-synth sensors …`, their arguments and their help; what they do is in modules of their own.

Annotations are not postponed here: typer would compile every one of them anew at each start.
"""

import typer

from synth.cli.guide import GUIDES
from synth.cli.listed import SENSORS
from synth.frame.command_line import add_listed, listed_group

app = typer.Typer(
    cls=listed_group(SENSORS, GUIDES["sensors"]),
    help="Point sensors along a retarder position: where they should stand, and tables for them.",
)


add_listed(app, SENSORS)
