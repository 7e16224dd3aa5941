from pathlib import Path

import numpy as np
from movie_files import SMALL, write_masks

from cytodisk.runs.movie.movie_inputs import open_movie
from cytodisk.runs.movie.movie_study import movie_study


def test_a_cell_that_is_nowhere_where_it_was_is_doubted(tmp_path: Path) -> None:
    masks = np.zeros((4, 40, 90), np.uint8)
    for frame, left in enumerate((5, 7, 60, 61)):
        masks[frame, 8:30, left : left + 20] = 1
    study = movie_study(open_movie(write_masks(tmp_path / "m.tif", masks), None, SMALL), tmp_path / "out")
    remarks = study.cells["mask_remarks"].tolist()
    assert "does not touch its place in frame 1" in remarks[2]
    assert [remarks[time] for time in (0, 1, 3)] == ["", "", ""]
    assert any("does not touch" in words for words in study.provenance["warnings"])
