"""The command line: reads flags, calls the library, prints what happened."""

import typer

from cytodisk.cli.batch_command import BATCH_HELP, batch_command
from cytodisk.cli.compare_windows_command import COMPARE_WINDOWS_HELP, compare_windows_command
from cytodisk.cli.console import fail
from cytodisk.cli.correlate_command import CORRELATE_HELP, REPORT_HELP, correlate_command, report_command
from cytodisk.cli.demo_command import demo_command, info_command
from cytodisk.cli.map_command import MAP_HELP, check_command, map_command
from cytodisk.cli.movie_command import MOVIE_HELP, movie_command
from cytodisk.cli.shapes_command import SHAPES_HELP, shapes_command
from cytodisk.errors import CytodiskError

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
    help="Map cells one to one onto the unit disk, divide them into windows, follow them, sample signals.",
)
app.command("map", help=MAP_HELP)(map_command)
app.command("movie", help=MOVIE_HELP)(movie_command)
app.command("batch", help=BATCH_HELP)(batch_command)
app.command("correlate", help=CORRELATE_HELP)(correlate_command)
app.command("shapes", help=SHAPES_HELP)(shapes_command)
app.command("report", help=REPORT_HELP)(report_command)
app.command("compare-windows", help=COMPARE_WINDOWS_HELP)(compare_windows_command)
app.command("check")(check_command)
app.command("info")(info_command)
app.command("demo")(demo_command)


def main() -> None:
    """Run the command line; errors that a user can mend end in exit code 2."""
    try:
        app()
    except CytodiskError as error:
        fail(str(error))


__all__ = ["app", "main"]
