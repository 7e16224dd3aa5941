"""Templates, styles and scripts of the pages, put together."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from importlib.resources import files
from typing import Any

from cytodisk.errors import MissingPartError

_FOLDERS = {"html": "templates", "css": "styles", "js": "scripts"}


def jinja() -> Any:
    """The template engine.

    Raises
    ------
    MissingPartError
        It is not installed.
    """
    try:
        import jinja2
    except ImportError as error:
        raise MissingPartError.of("the report page needs Jinja2", "report") from error
    return jinja2


def rendered(page: str, styles: Iterable[str], scripts: Iterable[str], words: Mapping[str, Any]) -> str:
    """A page as text.

    Parameters
    ----------
    page : str
        Name of its template.
    styles, scripts : iterable of str
        Names of the files that stand in it, in their order.
    words : dict
        What the template writes; text is escaped.

    Returns
    -------
    str
    """
    engine = jinja()
    loader = engine.FunctionLoader(_asset)
    environment = engine.Environment(autoescape=True, undefined=engine.StrictUndefined, loader=loader)
    return str(
        environment.get_template(f"{page}.html").render(
            {
                **words,
                "style": "\n".join(_asset(f"{name}.css") for name in styles),
                "scripts": [_code(_asset(f"{name}.js")) for name in scripts],
            }
        )
    )


def _code(script: str) -> str:
    """A script without indentation and lines of comment; no text in it goes over several lines."""
    lines = [line.strip() for line in script.splitlines()]
    return "\n".join(line for line in lines if line and not line.startswith("//"))


def _asset(name: str) -> str:
    folder = _FOLDERS[name.rpartition(".")[2]]
    return (files("cytodisk.pages.report") / "assets" / folder / name).read_text(encoding="utf-8")
