import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes

from cytodisk.errors import ParameterError, WindowError
from cytodisk.plot.nucleus.layer_profile import LayerProfile
from cytodisk.plot.nucleus.nucleus_profile import draw_nucleus_profile
from cytodisk.windows.polar_windows import CellWindows


def test_values_are_the_means_of_layers(sampled: xr.Dataset) -> None:
    profile = LayerProfile.of(sampled)
    total = (sampled["mean"] * sampled["n_pixels"]).sum("sector") / sampled["n_pixels"].sum("sector")
    assert profile.values == pytest.approx(total.transpose("channel", "layer").to_numpy())
    assert (profile.low <= profile.high).all()
    assert profile.cytoplasm_layers == 4
    assert profile.relative.values[1] == pytest.approx(np.ones(6))  # a flat signal is 1 everywhere
    assert profile.units == {"mean": "a.u.", "depth": "µm"}


def test_nucleus_is_left_and_the_membrane_right(ax: Axes, sampled: xr.Dataset) -> None:
    lines = draw_nucleus_profile(ax, sampled)
    assert [line.get_label() for line in lines] == ["GFP", "flat"]
    values = np.asarray(lines[0].get_ydata())
    assert (values[:2] < 45).all()  # both layers of the nucleus; its last subpixels mix with the cytoplasm
    assert (np.diff(values[2:]) < 0).all()  # falls towards the membrane
    assert ax.get_xlim() == (0.0, 6.0)
    assert [text.get_text().split("\n")[0] for text in ax.get_xticklabels()] == ["0", "1", "2", "3", "4", "5"]
    assert {"nucleus", "cytoplasm", "membrane"} <= {text.get_text() for text in ax.texts}


@pytest.mark.parametrize("along", ["layer", "share", "distance"])
def test_the_outline_parts_the_compartments(ax: Axes, sampled: xr.Dataset, along: str) -> None:
    (line, _) = draw_nucleus_profile(ax, sampled, along=along)  # type: ignore[arg-type]
    places = np.asarray(line.get_xdata(), dtype=float)
    outline, membrane = (float(border.get_xdata()[0]) for border in ax.lines[:2])  # type: ignore[index,arg-type]
    assert (np.diff(places) > 0).all()
    assert ((places < outline) == [True, True, False, False, False, False]).all()
    assert (places < membrane).all()
    if along == "share":
        areas = sampled["area"].sum("sector").to_numpy()
        assert outline == pytest.approx(100 * areas[4:].sum() / areas.sum())


def test_frames_are_averaged(sampled: xr.Dataset) -> None:
    movie = xr.concat([sampled, sampled.assign(mean=3 * sampled["mean"])], "time")
    assert LayerProfile.of(movie).values == pytest.approx(2 * LayerProfile.of(sampled).values)


def test_other_data_are_refused(ax: Axes, sampled: xr.Dataset, nucleus_windows: CellWindows) -> None:
    with pytest.raises(WindowError, match="data has no layers of a nucleus: pass nucleus to"):
        draw_nucleus_profile(ax, sampled.drop_vars("compartment"))
    with pytest.raises(ParameterError, match="data must be a Dataset"):
        draw_nucleus_profile(ax, nucleus_windows)  # type: ignore[arg-type]
    with pytest.raises(ParameterError, match="2 channels for 1 colours"):
        draw_nucleus_profile(ax, sampled, colors=["red"])
    with pytest.raises(ParameterError, match="along must be"):
        draw_nucleus_profile(ax, sampled, along="depth")  # type: ignore[arg-type]
