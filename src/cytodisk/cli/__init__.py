"""The command line: reads flags, calls the library, prints what happened."""

from typer.core import TyperGroup

from cytodisk.cli.console import fail
from cytodisk.cli.help_texts import HELP
from cytodisk.cli.lazy_command import LazyCommand
from cytodisk.errors import CytodiskError

_ELSEWHERE = {"report": "correlate_command", "check": "map_command"}  # the others have a module of their own


def _command(name: str) -> LazyCommand:
    module = _ELSEWHERE.get(name, f"{name.replace('-', '_')}_command")
    return LazyCommand(name, f"cytodisk.cli.{module}", HELP[name])


app = TyperGroup(
    name="cytodisk",
    commands={name: _command(name) for name in HELP},
    no_args_is_help=True,
    rich_markup_mode="rich",
    help="Map cells one to one onto the unit disk, divide them into windows, follow them, sample signals.",
)


def main() -> None:
    """Run the command line; errors that a user can mend end in exit code 2."""
    try:
        app()
    except CytodiskError as error:
        fail(str(error))


__all__ = ["app", "main"]
