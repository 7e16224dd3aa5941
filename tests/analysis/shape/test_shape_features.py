"""What holds of every shape, and the table that they come in."""

import numpy as np
import pandas as pd
import pytest
from drawn_shapes import ellipse, lopsided, rectangle, star
from hypothesis import given, settings
from hypothesis import strategies as st

import cytodisk as cd
from cytodisk.analysis.shape.distortion_features import FINE_MESH
from cytodisk.analysis.shape.features import FEATURES, GROUPS, SCALE_FREE, split_qc_flags
from cytodisk.arrays import BoolArray
from cytodisk.errors import MaskError, ParameterError
from cytodisk.simulate import random_smooth
from cytodisk.simulate.random_masks import KINDS, random_mask

NAMES = [feature.name for feature in FEATURES]
EXTREMES = ["curvature_min", "curvature_p05", "curvature_max"]  # a few pixels make them
# Such small amplitudes of harmonics come from tenths of a pixel; a tip may be a rounded corner.
FROM_PIXELS = {f"fourier_{k}": 0.0015 for k in range(12, 21)} | {"tips": 1.0}


def numbers(mask: BoolArray, pixel_size_um: float | None = None) -> pd.Series:
    return cd.shape_features([mask], pixel_size_um=pixel_size_um).iloc[0][NAMES].astype(float)


@pytest.fixture(scope="module")
def spread() -> pd.Series:
    """How much each scale-free feature differs between shapes: its standard deviation over a dozen."""
    blobs = [random_smooth(seed, radius=45, roughness=rough) for seed in (0, 1) for rough in (0.15, 0.4)]
    plain = [ellipse(40, 40), ellipse(60, 30), ellipse(90, 18, 0.4), rectangle(80, 80, 0.2), lopsided(45)]
    stars = [star(3, 80, 0.2), star(5, 70), star(5, 60, 0.6), star(8, 70, 0.3)]
    found = cd.shape_features([*blobs, *plain, *stars, rectangle(120, 40, 0.5)])[list(SCALE_FREE)].std()
    assert (found > 0).all()
    return found


def assert_alike(one: pd.Series, other: pd.Series, spread: pd.Series) -> None:
    """No scale-free feature differs by more than a third of what it differs between shapes, nor by much."""
    little = (0.06 * one[spread.index].abs() + 0.05).drop(EXTREMES)
    tolerance = np.fmin(spread / 3.0, little.reindex(spread.index)).to_dict() | FROM_PIXELS
    far = [name for name in SCALE_FREE if abs(one[name] - other[name]) > tolerance[name]]
    assert not far, pd.DataFrame({"one": one[far], "other": other[far], "spread": spread[far]}).to_string()


def test_every_feature_has_a_unit_and_a_line_of_description() -> None:
    table = cd.shape_features(ellipse(20, 12))
    assert len(set(NAMES)) == len(NAMES) >= 60
    assert list(table.columns[-len(NAMES) :]) == NAMES
    assert set(table.attrs["units"]) == set(table.attrs["description"]) == set(NAMES)
    assert all(text and "\n" not in text for text in table.attrs["description"].values())
    assert table.attrs["units"]["area"] == "px²"
    assert table.attrs["scale_free"] == list(SCALE_FREE)
    assert len(SCALE_FREE) >= 60


@pytest.mark.parametrize("group", GROUPS, ids=lambda group: group.name)
def test_a_group_measures_what_its_table_names(group) -> None:  # type: ignore[no-untyped-def]
    from cytodisk.analysis.shape.cell_shape import crop_shape

    assert list(group.measure(crop_shape(ellipse(20, 12)))) == [feature.name for feature in group.features]


def test_lengths_grow_with_the_pixel_size_and_nothing_else_does() -> None:
    pixels, micrometres = numbers(lopsided(25)), numbers(lopsided(25), pixel_size_um=0.5)
    factor = {"1": 1.0, "length": 0.5, "length²": 0.25}
    expected = [pixels[feature.name] * factor[feature.unit] for feature in FEATURES]
    np.testing.assert_allclose(micrometres, expected, rtol=1e-12)
    units = cd.shape_features(lopsided(25), pixel_size_um=0.5).attrs["units"]
    assert (units["feret_max"], units["area"], units["tips"]) == ("µm", "µm²", "1")


@given(st.sampled_from(KINDS), st.integers(0, 10_000))
@settings(max_examples=25)
def test_any_mask_is_measured_or_refused_with_a_reason(kind: str, seed: int) -> None:
    row = cd.shape_features(random_mask(kind, seed)).iloc[0]
    values = row[NAMES].astype(float)
    if row["status"] != "ok":
        assert "too few to speak of a shape" in row["reason"]
        assert values.isna().all()
        return
    assert np.isfinite(values).all()
    for ratio in ("circularity", "solidity", "extent", "roundness", "hull_circularity"):
        assert 0 < values[ratio] <= 1 + 1e-9, ratio
    for share in ("concave_share", "thin_10", "thin_20", "thin_40", "harmonic_inner", "outside_ellipse"):
        assert 0 <= values[share] <= 1, share
    assert values["feret_min"] <= values["feret_max"]


@given(st.integers(0, 3), st.booleans(), st.integers(0, 9), st.integers(0, 9), st.integers(0, 100))
@settings(max_examples=12)
def test_place_quarter_turns_and_mirror_images_change_nothing(
    turns: int, mirrored: bool, down: int, right: int, seed: int
) -> None:
    mask = lopsided(32, angle=seed / 16.0)
    moved = np.pad(np.rot90(mask, turns), ((down, 0), (right, 0)))
    moved = moved[:, ::-1] if mirrored else moved
    one, other = numbers(mask), numbers(moved)
    # Thinning and meshing go through the pixels in one direction.
    thinned = [name for name in NAMES if name.startswith("skeleton_")]
    np.testing.assert_allclose(one[thinned], other[thinned], atol=0.15 if one["skeleton_tips"] == 2 else 2)
    mapped = [name for name in NAMES if name.startswith("harmonic_")]
    np.testing.assert_allclose(one[mapped], other[mapped], rtol=0.03, atol=0.03)
    exact = [name for name in NAMES if name not in (*thinned, *mapped)]
    np.testing.assert_allclose(one[exact], other[exact], rtol=1e-7, atol=1e-9)


@pytest.mark.parametrize("angle", [0.3, 0.8])
def test_any_turn_changes_scale_free_features_little(angle: float, spread: pd.Series) -> None:
    assert_alike(numbers(lopsided(45)), numbers(lopsided(45, angle)), spread)


@pytest.mark.parametrize("size", [38, 90])  # equivalent diameters of 79 and 187 px
def test_the_same_shape_drawn_larger_has_nearly_the_same_scale_free_features(
    size: float, spread: pd.Series
) -> None:
    assert_alike(numbers(lopsided(45)), numbers(lopsided(size)), spread)


def test_curvature_and_roughness_of_a_cell_are_flagged_below_75_px() -> None:
    table = cd.shape_features([star(5, 7, 0.45), ellipse(37, 37), ellipse(38, 38)], pixel_size_um=0.1)
    small, others = split_qc_flags(table["qc_flags"])
    assert small.tolist() == [True, True, False]
    assert others.tolist() == ["", "", ""]
    diameter = 10 * table["equivalent_diameter"][0]
    assert table["qc_flags"][0].startswith("too small for curvature and roughness")
    assert f"D = {diameter:.3g} px, below 75 px" in table["qc_flags"][0]
    assert (table["tips"][0], numbers(star(5, 70, 0.45))["tips"]) == (0, 5)  # so the flag is right


def test_flags_of_size_stand_beside_others() -> None:
    inverted = np.ones((30, 30), dtype=bool)
    inverted[0, 0] = False
    small, others = split_qc_flags(cd.shape_features(inverted)["qc_flags"])
    assert small.tolist() == [True]
    assert others.tolist() == ["perhaps inverted or cut off: most of its edge is the image border"]


def test_a_finer_mesh_where_the_outline_crosses_itself_is_noted() -> None:
    random, mask = np.random.default_rng(0), np.zeros((220, 400), dtype=bool)
    mask[10:211, 2:203] = ellipse(100, 100)[3:-3, 3:-3]
    for angle in range(5):  # filopodia as thin as a pixel, in much smaller steps than those of the outline
        rows = 110 + 70 * np.cos(angle) + np.cumsum(random.integers(-1, 2, 200))
        mask[rows.astype(int).clip(0, 219), 100 + np.arange(200)] = True
    row = cd.shape_features(mask).iloc[0]
    assert np.isfinite(row[NAMES].astype(float)).all()
    assert FINE_MESH in row["notes"]
    assert FINE_MESH not in cd.shape_features(lopsided(45))["notes"][0]


def test_lengths_of_a_shape_drawn_twice_as_large_are_twice_as_long() -> None:
    small, large = numbers(lopsided(40)), numbers(lopsided(80))
    for feature in FEATURES:
        if not feature.scale_free:
            factor = 2.0 if feature.unit == "length" else 4.0
            assert large[feature.name] == pytest.approx(factor * small[feature.name], rel=0.03), feature.name


def test_a_label_image_has_a_row_for_each_label() -> None:
    image = np.zeros((80, 200), dtype=np.int64)
    big, small = ellipse(30, 20), rectangle(30, 18)
    image[: big.shape[0], : big.shape[1]][big] = 7
    image[-small.shape[0] :, -small.shape[1] :][small] = 4_000_000_000
    table = cd.shape_features(image)
    assert table["label"].tolist() == [7, 4_000_000_000]
    assert table["cell"].tolist() == [0, 1]
    assert table["area"].tolist() == [big.sum(), small.sum()]
    alone = numbers(big)
    np.testing.assert_allclose(table.loc[0, NAMES].astype(float), alone, rtol=1e-9, atol=1e-12)


def test_touching_labels_are_measured_apart() -> None:
    image = np.ones((20, 40), dtype=np.uint8)
    image[:, 20:] = 2
    table = cd.shape_features(np.pad(image, 3))
    assert table["area"].tolist() == [400, 400]
    assert table["notes"].tolist() == ["", ""]


def test_a_stack_and_a_list_have_a_row_for_each_mask() -> None:
    disk, bar = np.pad(ellipse(10, 10), 5), np.zeros((37, 37), dtype=bool)
    stack = np.stack([disk, bar])
    table = cd.shape_features(stack)
    assert table["frame"].tolist() == [0, 1]
    assert table["status"].tolist() == ["ok", "refused"]
    assert "empty" in table["reason"][1]
    assert table[NAMES].loc[1].isna().all()
    pd.testing.assert_frame_equal(cd.shape_features([disk, bar]), table)
    pd.testing.assert_frame_equal(cd.shape_features(stack.astype(float)), table)


def test_what_cleaning_changed_and_the_image_border_are_noted() -> None:
    mask = np.zeros((40, 40), dtype=bool)
    mask[0:20, 5:30] = True
    mask[8:10, 8:10] = False
    mask[30:33, 30:33] = True
    row = cd.shape_features(mask).iloc[0]
    assert row["touches_border"]
    assert row["area"] == 500
    assert "1 fragment dropped (9 px" in row["notes"]
    assert "1 hole filled (4 px" in row["notes"]


def test_a_mask_with_several_labels_in_a_list_is_refused() -> None:
    image = np.arange(16).reshape(4, 4).repeat(4, 0)
    table = cd.shape_features([image, ellipse(12, 9)])
    assert table["status"].tolist() == ["refused", "ok"]
    assert "labels" in table["reason"][0]


@pytest.mark.parametrize(
    ("masks", "words"),
    [
        (np.zeros((5, 5), dtype=int), "holds no cell"),
        (np.full((5, 5), -1), "negative labels"),
        (np.zeros(5), r"shape \(5,\)"),
        (np.zeros((2, 3, 4, 5)), r"shape \(2, 3, 4, 5\)"),
        (np.ones((40, 50, 3), dtype=np.uint8), r"shape \(40, 50, 3\).* pass one channel"),
        (np.ones((40, 50, 4), dtype=bool), "pass one channel"),
        ([np.ones((40, 50, 3)), np.ones((30, 50, 3))], "a list of masks"),
    ],
)
def test_what_holds_no_masks_is_an_error(masks: object, words: str) -> None:
    with pytest.raises(MaskError, match=words):
        cd.shape_features(masks)


@pytest.mark.parametrize("size", [0, -1.0, np.nan, np.inf, "0.1", True])
def test_a_pixel_size_must_be_a_positive_number(size: object) -> None:
    with pytest.raises(ParameterError, match="pixel_size_um"):
        cd.shape_features(star(5, 20), pixel_size_um=size)  # type: ignore[arg-type]


def test_few_narrow_masks_are_a_stack() -> None:
    assert cd.shape_features(np.ones((3, 9, 4), dtype=bool))["area"].tolist() == [36, 36, 36]
