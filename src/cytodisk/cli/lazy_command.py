"""A command whose module is imported when it runs: the list of commands needs none of them."""

import re
import shlex
from functools import cached_property
from importlib import import_module
from typing import Any

import typer
from typer.core import TyperCommand

from cytodisk.cli.help_groups import WIDTH, GroupedCommand

_QUOTES = (
    "For several files of one movie put the pattern in quotes, as 'frames/t*.tif', or pass their folder."
)

_EXTRA = re.compile(r"unexpected extra argument(?:\(s\))? \(([^() ]+)\)$")  # one alone


class LazyCommand(TyperCommand):
    """A command that is known by its name and its help until it is called.

    Parameters
    ----------
    name : str
        The function is called so too, with `_command` behind it.
    module : str
        Where that function is.
    help : str
    """

    def __init__(self, name: str, module: str, help: str):
        super().__init__(name, help=help, rich_markup_mode="rich")
        self._module = module

    @cached_property
    def loaded(self) -> Any:
        """The command itself, with its options."""
        function = getattr(import_module(self._module), f"{str(self.name).replace('-', '_')}_command")
        alone = typer.Typer(add_completion=False, rich_markup_mode=None)  # tables would cut names of flags
        width = {"max_content_width": WIDTH}
        alone.command(self.name, cls=GroupedCommand, help=self.help, context_settings=width)(function)
        return typer.main.get_command(alone)

    def make_context(self, *call: Any, **extra: Any) -> Any:
        """Parse the arguments, as the command itself does."""
        try:
            return self.loaded.make_context(*call, **extra)
        except Exception as error:  # of which class depends on the version of typer
            words = str(getattr(error, "message", ""))
            if advice := self._advice(words, getattr(error, "param", None)):
                error.message = advice  # type: ignore[attr-defined]
            raise

    def _advice(self, words: str, param: Any) -> str:
        """A message with the remedy; empty where it has none to add."""
        if not words and getattr(param, "name", None) == "out":  # is missing, which is said before
            return "Name a folder for the results, as -o results/"
        if "unexpected extra argument" not in words:
            return ""
        one = _EXTRA.search(words)
        if one is not None and any("--signal" in option.opts for option in self.loaded.params):
            return f"{words}. For the image of the signal write --signal {shlex.quote(one[1])}. {_QUOTES}"
        return f"{words}. {_QUOTES}"
