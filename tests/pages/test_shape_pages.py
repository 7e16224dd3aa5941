from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import cytodisk as cd
from cytodisk.arrays import BoolArray
from cytodisk.pages.shape_pages import cells_to_draw, write_shape_figures


def _score() -> pd.DataFrame:
    """30 cells along a line of a plane, in a mixed order."""
    along = np.random.default_rng(0).permutation(np.linspace(-5.0, 5.0, 30))
    cells = pd.DataFrame({"cell": np.arange(100, 130), "status": "ok", "complexity": along})
    return cells.assign(umap_1=along, umap_2=0.2 * np.cos(along))


def test_pages_are_whole(tmp_path: Path, saved: list[Figure]) -> None:
    score = _score()
    masks: dict[int, BoolArray] = {
        cell: cd.simulate.random_smooth(cell - 100, radius=cell - 92) for cell in cells_to_draw(score)
    }
    paths = write_shape_figures(tmp_path, score, masks, cd.Scale(0.5))
    assert [path.name for path in paths] == ["complexity.png", "extremes.png"]
    assert len(saved) == 2
    words = [text.get_text() for figure in saved for text in figure.findobj(lambda a: hasattr(a, "get_text"))]
    assert {"least", "median", "most", "complexity"} <= set(words)
