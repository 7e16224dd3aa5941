"""QC flags with the places where they are to be seen."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas as pd
import pytest

import cytodisk as cd
from cytodisk.napari.check.flag_points import FlagGround, flag_features
from cytodisk.napari.check.found_flags import FlagPlace, FoundFlag, flags_of_study, sector_place
from cytodisk.runs.qc_flags.qc_flag import Place, QCFlag

CELLS = pd.DataFrame(
    {
        "cell": [0, 0, 0, 7],
        "frame": [2, 3, 4, 2],
        "centroid_y": [10.0, np.nan, 12.0, 30.0],
        "centroid_x": [5.0, np.nan, 6.0, 40.0],
    }
)
FLAG = QCFlag(
    "area jumps",
    "the mask's area jumps in 2 frames",
    "The mask did.",
    "Correct it.",
    (Place(0, 3, "−40%", None, 2), Place(7, None), Place(9, 1)),
)


def found(cells: pd.DataFrame = CELLS, flag: QCFlag = FLAG) -> FoundFlag:
    study: Any = SimpleNamespace(is_movie=True, cells=cells)
    (one,) = flags_of_study(study, [flag], CELLS, None)
    return one


def test_places_are_those_of_the_cells() -> None:
    assert found().places == (
        FlagPlace(3, "0", "frames 2 and 3: −40%", (10.0, 5.0)),  # the nearest frame with a map
        FlagPlace(2, "7", "", (30.0, 40.0)),
        FlagPlace(1, "9", "", None),
    )


def test_a_cell_of_many_files_is_named_with_its_file() -> None:
    cells = CELLS.assign(source=["a.tif", "a.tif", "a.tif", "b.tif"])

    assert [place.cell for place in found(cells).places] == ["0 of a.tif", "7 of b.tif", "9"]


def test_points_have_what_the_status_bar_says() -> None:
    ground = FlagGround((5.0, 0.2, 0.2), (0.0, 1.0, 1.0), ("second", "um", "um"), -3)

    points, features = flag_features([found()], ground)

    assert points.tolist() == [[3, 10, 5], [2, 30, 40]]
    assert features["finding"].tolist() == ["frames 2 and 3: −40%", FLAG.what]
    assert features["remedy"].tolist() == ["Correct it."] * 2
    assert ground.world(found().places[0]) == pytest.approx((15.0, 3.0, 2.0))


def test_all_that_is_to_be_read_of_a_flag() -> None:
    assert found().words == (
        "area jumps: the mask's area jumps in 2 frames. The mask did. What to do: Correct it."
    )


@pytest.mark.slow
def test_a_sector_is_at_its_place_on_the_edge(tmp_path: Path) -> None:
    disk = cd.map_to_disk(cd.simulate.disk(20))
    shown = SimpleNamespace(map_at=lambda cell, frame: disk)

    y, x = sector_place(shown, Place(0, 3, "", sector=3), 16)

    uv = disk.to_disk([y, x])
    assert np.arctan2(uv[1], uv[0]) == pytest.approx(2 * np.pi * 3.5 / 16)
    assert np.hypot(*uv) == pytest.approx(0.97)
    assert sector_place(shown, Place(0, 3), 16) is None
