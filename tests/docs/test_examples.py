"""Every public function has an example, and it shows what comes."""

import doctest
import inspect
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import matplotlib.pyplot as plt
import pytest

import cytodisk as cd
from cytodisk.pages.sheet import Sheet

FLAGS = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS
SLOW = {  # UMAP is compiled, processes are started
    "complexity_score",
    "open_pooled_correlation",
    "run_batch",
    "run_batch_correlate",
    "run_batch_predict",
    "run_batch_waves",
    "run_correlate",
    "run_waves",
    "write_pooled_figure",
    "write_wave_figures",
}
SPACES: tuple[ModuleType, ...] = (cd, cd.plot, cd.pages, cd.simulate)


def public() -> Iterator[Any]:
    """All public functions and classes, by the name that a user types."""
    for space in SPACES:
        for name in space.__all__:
            value = getattr(space, name)
            if inspect.isroutine(value) or inspect.isclass(value):
                marks = [pytest.mark.slow] if name in SLOW else []
                yield pytest.param(value, id=f"{space.__name__}.{name}", marks=marks)


def examples(value: Callable[..., Any]) -> list[doctest.DocTest]:
    """Those of a function, or of a class and its methods."""
    found = doctest.DocTestFinder().find(inspect.unwrap(value), value.__name__, globs={})
    return [test for test in found if test.examples]


@pytest.mark.parametrize("value", list(public()))
def test_examples_show_what_comes(
    value: Callable[..., Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)  # for what they write
    monkeypatch.setattr(Sheet.save, "__defaults__", (40,))  # dots an inch, of which no example tells
    found = examples(value)
    assert found or inspect.isclass(value), f"{value.__name__} has no example: write one in its docstring"
    said: list[str] = []
    for test in found:
        doctest.DocTestRunner(optionflags=FLAGS).run(test, out=said.append)
    plt.close("all")
    assert not said, "".join(said)


def test_the_repository_holds_no_results() -> None:
    """What examples and runs write belongs into a folder of their own."""
    root = Path(__file__).parents[2]
    if not (root / ".git").exists():
        pytest.skip("not a repository of git: what it holds is not known")
    told = subprocess.run(["git", "ls-files"], cwd=root, capture_output=True, text=True, check=True).stdout
    names = {Path(line).name for line in told.splitlines()}
    assert not {name for name in names if name.endswith((".parquet", ".npz", ".zarr.zip", ".cytodisk.run"))}
    assert not names & {"provenance.json", "parameters.toml", "report.html"}
