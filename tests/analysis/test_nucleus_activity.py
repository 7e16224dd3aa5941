import numpy as np
import pytest

import cytodisk as cd
from cytodisk.motion.disk_movie import FrameRecord
from cytodisk.scale import Scale


def nothing() -> None:
    """In place of a tracked boundary, which samples do not need."""


@pytest.fixture(scope="module")
def movie() -> cd.DiskMovie:
    """Three frames of a cell with its nucleus; the second shows no nucleus."""
    mask, nucleus = cd.simulate.random_pair(3)
    disk = cd.map_to_disk(mask, nucleus=nucleus, pixel_size_um=0.5)
    seen = FrameRecord("ok", "", nothing)  # type: ignore[arg-type]
    records = (seen, FrameRecord("refused", "no nucleus", None), seen)
    return cd.DiskMovie(records, mask.shape, Scale(0.5), lambda frame: disk)


def test_activity_knows_compartment_and_distance_to_the_nucleus(movie: cd.DiskMovie) -> None:
    disk = movie[0]
    grid = cd.polar_windows(4, 9, nucleus_layers=2)
    assert disk.nucleus is not None
    signal = np.stack([np.where(disk.nucleus.mask, 5.0, 1.0)] * 3)
    found = cd.sample_movie(movie, grid, signal)
    assert found["compartment"].to_numpy().tolist() == ["cytoplasm"] * 4 + ["nucleus"] * 2
    by_compartment = found["mean"].isel(time=2).groupby("compartment").mean(...)
    assert float(by_compartment.sel(compartment="nucleus")) == pytest.approx(5.0)
    assert float(by_compartment.sel(compartment="cytoplasm")) == pytest.approx(1.0)
    distance = found["nucleus_distance"]
    assert distance.dims == ("time", "layer", "sector")
    assert distance.attrs["units"] == "µm"
    assert distance[1].isnull().all()
    expected = 0.5 * grid.on(disk).depth_columns["nucleus_distance"]
    np.testing.assert_allclose(distance[0], expected)
    assert found["reason"].to_numpy().tolist() == ["", "no nucleus", ""]


def test_activity_without_nucleus_has_neither() -> None:
    movie = cd.map_movie(cd.simulate.movie("growing", frames=2, radius_px=12.0).masks)
    found = cd.sample_movie(movie, cd.polar_windows(2, 4), np.ones((2, *movie.image_shape)))
    assert "compartment" not in found.coords
    assert "nucleus_distance" not in found
