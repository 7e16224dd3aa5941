"""The command line: reads flags, calls the library, prints what happened."""

import sys

from typer.core import TyperGroup

from cytodisk.cli.console import damaged_part_lines, fail, out_of_memory_words
from cytodisk.cli.help_texts import HELP
from cytodisk.cli.lazy_command import LazyCommand
from cytodisk.errors import CytodiskError
from cytodisk.stopping import Stopped, is_stop, stopping_tidily

_ELSEWHERE = {
    "report": "report.report_command",
    "population": "population.population_command",
    "export": "export.export_command",
    "predict": "predict.predict_command",
    "waves": "waves.waves_command",
}
"""Modules of commands that have none of their name beside this one."""


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
    """Run the command line; errors that a user can mend end in exit code 2, and what stops it in one line."""
    try:
        with stopping_tidily(), damaged_part_lines():
            app()
    except CytodiskError as error:
        fail(str(error))
    except MemoryError as error:
        fail(out_of_memory_words(error))
    except (Stopped, KeyboardInterrupt, SystemError) as error:
        stop = is_stop(error)
        if stop is None:
            raise
        print("Stopped.", file=sys.stderr)
        raise SystemExit(stop.exit_code) from None


__all__ = ["app", "main"]
