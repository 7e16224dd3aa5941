"""Sphinx extension: the directive `command-line`, tables of every command's options as Typer has them."""

import inspect
import re
from itertools import groupby
from pathlib import Path
from typing import Any, get_args, get_type_hints

from docutils import nodes
from docutils.statemachine import StringList
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from cytodisk.cli import app as cytodisk_app
from cytodisk.cli.help_groups import flag_name
from cytodisk.runs.told.flag_headings import grouped


class CommandLine(SphinxDirective):
    """Sections of all commands, in the order of `cytodisk --help`."""

    def run(self) -> list[nodes.Node]:
        commands: dict[str, Any] = cytodisk_app.commands
        lines = [line for name, command in commands.items() for line in command_lines(name, command.loaded)]
        holder = nodes.section()
        holder.document = self.state.document
        self.state.nested_parse(StringList(lines, source="cytodisk --help"), 0, holder, match_titles=True)
        return holder.children


def command_lines(name: str, command: Any) -> list[str]:
    """One command in reStructuredText."""
    title = f"cytodisk {name}"
    lines = [title, "-" * len(title), "", *help_lines(command.help or ""), ""]
    types = get_type_hints(inspect.unwrap(command.callback))
    options = {flag_name(option): option for option in command.params if not option.hidden}
    is_flag = {name: option.opts[0].startswith("-") for name, option in options.items()}
    arguments = [name for name in options if not is_flag[name]]
    groups = grouped([name for name in options if is_flag[name]])
    for heading, names in [("", arguments), *groups] if arguments else groups:
        rows = [row for name in names for row in option_row(options[name], types)]
        lines += [f"*{heading}*", ""] if heading else []
        lines += [".. list-table::", "   :class: options", "   :widths: auto", "", *rows, ""]
    return lines


def help_lines(text: str) -> list[str]:
    """Paragraphs of a help text; those that are indented are commands, and become code."""
    lines: list[str] = []
    paragraphs = re.split(r"\n\s*\n", inspect.cleandoc(text))
    for is_code, group in groupby(paragraphs, key=lambda paragraph: paragraph.startswith(" ")):
        if is_code:
            commands = [f"   $ {line.strip()}" for paragraph in group for line in paragraph.splitlines()]
            lines += [".. code-block:: console", "", *commands, ""]
        else:
            lines += [line for paragraph in group for line in (*escaped(paragraph).splitlines(), "")]
    return lines


def option_row(option: Any, types: dict[str, Any]) -> list[str]:
    """Row of one argument or option: name, type, meaning."""
    flags = (*option.opts, *option.secondary_opts)
    names = ", ".join(f"``{flag if flag.startswith('-') else flag.upper()}``" for flag in flags)
    words = escaped(getattr(option, "help", None) or "")
    if option.required:
        words += " Required."
    elif getattr(option, "show_default", True) and shown_default(option.default):
        words += f" Default: ``{option.default}``."
    kind = "" if getattr(option, "is_flag", False) else plain_type(types.get(option.name))
    return [f"   * - {names}", f"     - {kind}", f"     - {words}"]


def shown_default(default: Any) -> bool:
    return default is not None and default != "" and not isinstance(default, bool)


def plain_type(hint: Any) -> str:
    """What to type for an option of this type; empty for a switch."""
    kinds = {Path: "path", float: "number", int: "whole number", str: "text"}
    found = [kinds[kind] for kind in kinds if kind is hint or kind in get_args(hint)]
    return found[0] if found else ""


def escaped(text: str) -> str:
    """Text in which reStructuredText finds no markup."""
    for character in "\\*`|_":
        text = text.replace(character, "\\" + character)
    return text


def setup(app: Sphinx) -> dict[str, Any]:
    app.add_directive("command-line", CommandLine)
    return {"parallel_read_safe": True}
