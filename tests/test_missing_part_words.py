import tomllib
from pathlib import Path

import pytest

from cytodisk.errors import MissingPartError
from cytodisk.runs.versions import PARTS


@pytest.mark.parametrize("extra", PARTS)
def test_what_to_install_holds_with_and_without_a_clone(extra: str) -> None:
    project = tomllib.loads((Path(__file__).parents[1] / "pyproject.toml").read_text())["project"]
    assert extra in project["optional-dependencies"]
    words = str(MissingPartError.of("the page needs a package", extra))
    assert words.startswith("the page needs a package, which is not installed: ")
    assert f"pip install 'cytodisk[{extra}]'" in words
    assert f"in a clone of cytodisk, pip install -e '.[{extra}]'" in words
