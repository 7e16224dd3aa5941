"""Sizes and names of the small study of single cells, and what its page holds for its scripts."""

import json
import re
from pathlib import Path
from typing import Any

LAYERS, SECTORS = 3, 8
CHANNELS = ("</script><script>document.title='broken'</script>", "DNA")
FILES = ("a <b>&'.tif", "b.tif")


def json_in(page: Path | str, name: str) -> Any:
    """What stands in a page for its scripts."""
    text = page.read_text(encoding="utf-8") if isinstance(page, Path) else page
    found = re.search(rf'<script type="application/json" id="{name}">(.*?)</script>', text, re.DOTALL)
    assert found is not None
    return json.loads(found[1])
