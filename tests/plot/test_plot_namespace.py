"""What `cytodisk.plot` offers."""

import re

import pytest

import cytodisk.plot as plot


@pytest.mark.parametrize("name", plot.__all__)
def test_every_name_resolves(name: str) -> None:
    found = getattr(plot, name)
    assert callable(found)
    assert found.__name__ == name


def test_names_are_listed_and_described() -> None:
    assert dir(plot) == sorted(plot.__all__)
    described = re.findall(r"\w+", plot.__doc__ or "")
    assert [name for name in plot.__all__ if described.count(name) != 1] == []
    assert [name for name in described if name.startswith("draw_") and name not in plot.__all__] == []


def test_other_names_are_refused() -> None:
    with pytest.raises(AttributeError, match="draw_nothing"):
        _ = plot.draw_nothing
