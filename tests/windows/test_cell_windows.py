import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial import cKDTree

import cytodisk as cd
from cytodisk.errors import WindowError
from cytodisk.geometry.outline import trace_outline
from cytodisk.geometry.polygon import signed_area
from cytodisk.simulate import KINDS, random_mask


def test_labels_name_the_window_with_the_largest_share(windows: cd.CellWindows) -> None:
    weights = windows.weights.toarray()
    labels = windows.labels[windows.mask]
    assert_array_equal(weights[labels, np.arange(weights.shape[1])], weights.max(axis=0))
    assert (windows.labels[~windows.mask] == -1).all()


def test_centroids_share_out_that_of_the_mask(windows: cd.CellWindows) -> None:
    together = np.einsum("ls,lsk->k", windows.areas, windows.centroids_yx) / windows.areas.sum()
    assert_allclose(together, np.argwhere(windows.mask).mean(axis=0), rtol=1e-12)


def test_linear_signal_has_about_its_value_at_the_centroid(windows: cd.CellWindows) -> None:
    """A mean takes whole pixels, a centroid their subpixels: at most half a pixel apart, mostly less."""
    for slope in ((1.0, 0.0), (0.0, 1.0)):
        signal = cd.simulate.linear_signal(windows.mask.shape, slope, 0.0)
        off = abs(cd.sample(windows, signal)["mean"].to_numpy() - windows.centroids_yx @ slope)
        assert off.max() < 0.5
        assert np.median(off) < 0.05


def test_centroids_are_those_of_the_outlines(windows: cd.CellWindows) -> None:
    """Parts of a pixel are 1/4 px wide and fall whole on one side of an outline, and at the cell's edge the
    squares of pixels stand out of the outline by up to half a pixel, over windows some 7 px across: a
    centroid moves by a fraction of that."""
    from_outline = [shapely.Polygon(polygon).centroid.coords[0] for polygon in windows.polygons()]
    assert_allclose(windows.centroids_yx.reshape(-1, 2), from_outline, atol=0.2)


def test_areas_are_those_of_the_outlines(windows: cd.CellWindows) -> None:
    """Up to the pixel squares' overhang at the edge, which is less than half a pixel along it."""
    by_outline = np.abs([signed_area(polygon) for polygon in windows.polygons()])
    inner = windows.grid.sectors  # the windows from layer 1 on do not touch the edge
    assert_allclose(windows.areas.ravel()[inner:], by_outline[inner:], rtol=0.025)  # quarters of a pixel
    assert_allclose(windows.areas.ravel()[:inner], by_outline[:inner], rtol=0.04)


def test_shapes_have_a_plain_twin(windows: cd.CellWindows) -> None:
    """From the picture of subpixels: each is a square of side 1/4."""
    for number, found in enumerate(windows.eccentricities.ravel()):
        points = (np.argwhere(windows.subpixel_labels == number) + 0.5) / 4 - 0.5
        small, large = np.linalg.eigvalsh(np.cov(points.T, ddof=0) + np.eye(2) / 192)
        assert found == pytest.approx(np.sqrt(1 - small / large), rel=1e-9)
        assert_allclose(windows.centroids_yx.reshape(-1, 2)[number], points.mean(axis=0), rtol=1e-12)


@settings(max_examples=15)
@given(
    kind=st.sampled_from(KINDS),
    seed=st.integers(0, 1000),
    layers=st.integers(1, 60),
    sectors=st.integers(1, 120),
)
def test_moments_share_out_those_of_the_mask(kind: str, seed: int, layers: int, sectors: int) -> None:
    """However finely pixels are divided: the subpixels of a square have its second moment."""
    disk = cd.map_to_disk(random_mask(kind, seed), method="harmonic")
    shares = cd.polar_windows(layers, sectors).on(disk).shares
    y, x = (np.argwhere(disk.mask) - shares.origin_yx).T
    expected = [y.sum(), x.sum(), (y * y + 1 / 12).sum(), (x * x + 1 / 12).sum(), (y * x).sum()]
    assert_allclose(shares.moments.sum(axis=0), expected, rtol=1e-11, atol=1e-11)


def test_eccentricity_of_a_rectangle_is_known() -> None:
    """A rectangle of h × w pixels has the second moments h²/12 and w²/12."""
    mask = np.zeros((12, 40), dtype=bool)
    mask[3:9, 4:34] = True
    windows = cd.polar_windows(1, 1).on(cd.map_to_disk(mask))
    assert windows.eccentricities[0, 0] == pytest.approx(np.sqrt(1 - 6**2 / 30**2), rel=1e-9)


def test_eccentricity_of_a_single_pixel_is_0() -> None:
    windows = cd.polar_windows(1, 1).on(cd.map_to_disk(np.ones((1, 1), dtype=bool)))
    assert_allclose(windows.eccentricities, 0.0, atol=1e-7)


class Bands(cd.WindowsOnCell):
    """Rows of half a pixel over a box of `height` × `width` pixels, far from the image's corner."""

    layers, sectors = 4, 1

    def __init__(self, width: int) -> None:
        self.box = np.zeros((1010, 1000 + width), dtype=bool)
        self.box[1000:1002, 1000:] = True

    @property
    def mask(self) -> np.ndarray:
        return self.box

    @property
    def outline_yx(self) -> np.ndarray:
        return trace_outline(self.box)

    def windows_of_subpixels(self, pixels_yx: np.ndarray) -> np.ndarray:
        return 2 * (pixels_yx[:, :1] - 1000) + np.repeat([0, 0, 1, 1], 4)


@pytest.mark.parametrize("width", [1, 8, 40])
def test_a_window_may_be_thinner_than_a_pixel(width: int) -> None:
    """A rectangle of 1/2 × w pixels has the second moments 1/48 and w²/12."""
    windows = Bands(width)
    assert_allclose(windows.areas, width / 2)
    assert_allclose(windows.eccentricities, np.sqrt(1 - 0.25 / width**2), rtol=1e-12)
    assert_allclose(windows.centroids_yx[:, 0, 0], 999.75 + 0.5 * np.arange(4), rtol=1e-15)
    assert_allclose(windows.centroids_yx[:, 0, 1], 1000 + (width - 1) / 2, rtol=1e-15)


def test_a_layer_in_a_row_of_pixels_has_a_known_eccentricity() -> None:
    """One pixel thick and eight long."""
    windows = cd.polar_windows(1, 1).on(cd.map_to_disk(np.ones((1, 8), dtype=bool)))
    assert windows.eccentricities[0, 0] == pytest.approx(np.sqrt(1 - 1 / 64), rel=1e-12)


def test_shapes_of_sectors_of_a_disk_are_known() -> None:
    """A quarter of a disk of radius 1 has y² = x² = 1/4 and x y = 1 / 2 π around the middle of the disk. Its
    own lies at 4 / 3 π along both, and its axes are the diagonals."""
    square = (4.0 / (3.0 * np.pi)) ** 2
    along, across = 1 / 4 + 1 / (2 * np.pi) - 2 * square, 1 / 4 - 1 / (2 * np.pi)
    expected = np.sqrt(1 - min(along, across) / max(along, across))
    windows = cd.polar_windows(1, 4).on(cd.map_to_disk(cd.simulate.disk(60)))
    assert_allclose(windows.eccentricities, expected, rtol=0.01)


def test_shapes_do_not_depend_on_where_the_cell_is_in_its_image() -> None:
    mask = cd.simulate.disk(9)
    here = cd.polar_windows(3, 8).on(cd.map_to_disk(mask))
    there = cd.polar_windows(3, 8).on(cd.map_to_disk(np.pad(mask, ((700, 0), (300, 5)))))
    assert_array_equal(there.eccentricities, here.eccentricities)
    assert_allclose(there.centroids_yx - (700, 300), here.centroids_yx, atol=1e-9)


@pytest.mark.parametrize(("layers", "sectors"), [(1, 1), (1, 2), (4, 12), (10, 60)])
@pytest.mark.parametrize("spacing", ["area", "radius"])
def test_outlines_tile_the_cell(cell: cd.DiskMap, layers: int, sectors: int, spacing: str) -> None:
    polygons = cd.polar_windows(layers, sectors, spacing).on(cell).polygons()
    areas = [signed_area(polygon) for polygon in polygons]
    assert len(areas) == layers * sectors
    assert sum(areas) == pytest.approx(signed_area(cell.outline_yx), rel=1e-9)
    assert len(set(np.sign(areas))) == 1


def test_neighbours_share_the_points_between_them(windows: cd.CellWindows) -> None:
    sectors = windows.grid.sectors
    sets = [set(map(tuple, polygon)) for polygon in windows.polygons()]
    for number, points in enumerate(sets):
        layer, sector = divmod(number, sectors)
        beside = sets[layer * sectors + (sector + 1) % sectors]
        assert len(points & beside) >= 256 // windows.grid.layers  # a whole spoke
        if layer + 1 < windows.grid.layers:
            assert len(points & sets[number + sectors]) >= 3  # a whole arc


def test_layer_0_follows_the_cell_outline(cell: cd.DiskMap, windows: cd.CellWindows) -> None:
    points = np.concatenate(windows.polygons()[: windows.grid.sectors])
    distance, _ = cKDTree(points).query(cell.outline_yx)
    assert distance.max() < 1e-9


def test_no_point_of_an_outline_is_repeated(windows: cd.CellWindows) -> None:
    for polygon in windows.polygons():
        assert (np.diff(polygon, axis=0, append=polygon[:1]) != 0).any(axis=1).all()


def test_geojson_values_of_another_shape_are_refused(windows: cd.CellWindows) -> None:
    with pytest.raises(WindowError, match=r"values\['mean'\].*\(3,\).*\(4, 12\)"):
        windows.geojson({"mean": np.zeros(3)})


@pytest.mark.parametrize("nucleus", [None, np.pad(cd.simulate.disk(6), 14)], ids=["plain", "with a nucleus"])
def test_one_outline_is_that_among_all(nucleus: np.ndarray | None) -> None:
    disk = cd.map_to_disk(cd.simulate.disk(20), nucleus=nucleus)
    windows = cd.polar_windows(3, 7, nucleus_layers=None if nucleus is None else 2).on(disk)
    for number, polygon in enumerate(windows.polygons()):
        assert_allclose(windows.polygon(*divmod(number, windows.sectors)), polygon, atol=1e-9)
