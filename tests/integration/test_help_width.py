"""Help: no flag is cut in a narrow window, and its start is quick."""

import re
import subprocess
import sys

import pytest
from command_line import Run

from cytodisk.cli import app
from cytodisk.cli.help_groups import flag_name
from cytodisk.runs.told.flag_headings import grouped

COMMANDS = sorted(app.commands)


@pytest.mark.parametrize("command", COMMANDS)
def test_flags_are_whole_at_80_columns(command: str, run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    code, told, _ = run(command, "--help")
    assert code == 0
    flags = [flag for option in app.commands[command].loaded.params for flag in option.opts if "--" in flag]
    assert set(flags) <= set(re.findall(r"--[a-z0-9-]+(?=[ ,\n])", told))
    assert max(map(len, told.splitlines())) <= 80


@pytest.mark.parametrize("command", COMMANDS)
def test_every_flag_is_under_a_heading(command: str) -> None:
    params = app.commands[command].loaded.params
    flags = [flag_name(option) for option in params if option.opts[0].startswith("-")]
    found = grouped([*flags, "help"])
    assert "More" not in dict(found)
    assert sorted(flag for _, names in found for flag in names) == sorted([*flags, "help"])


def test_the_list_of_commands_loads_nothing_slow() -> None:
    code = "import sys, cytodisk.cli; print({'numpy', 'numba', 'pydantic', 'zarr'} & set(sys.modules))"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert loaded.stdout == "set()\n"
