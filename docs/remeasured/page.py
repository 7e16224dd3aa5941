"""The page: a template whose numbers come from the measurements."""

from pathlib import Path
from typing import Any

TEMPLATE = Path(__file__).parent / "page.rst.in"


def write_page(path: Path, numbers: dict[str, Any]) -> None:
    """Fill the template in; a number that is missing is an error."""
    path.write_text(TEMPLATE.read_text(encoding="utf-8").format(**numbers), encoding="utf-8")
