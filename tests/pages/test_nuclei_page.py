from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure
from numpy.testing import assert_allclose

from cytodisk.pages.nuclei_page import write_nuclei_figure

LAYERS, NUCLEUS = 4, 1


def _cells(ratios: list[float]) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "cell": np.arange(len(ratios)),
            "cytoplasm_mean_GFP": [10.0 * (k + 1) for k in range(len(ratios))],
            "nucleus_to_cytoplasm_GFP": ratios,
            "perinuclear_share_GFP": 0.5,
            "peripheral_share_GFP": 0.2,
        }
    )


def _profile(cells: pd.DataFrame) -> pd.DataFrame:
    rows = [
        {
            "cell": cell,
            "channel": "GFP",
            "layer": layer,
            "compartment": "nucleus" if layer >= LAYERS - NUCLEUS else "cytoplasm",
            "mean": mean * (1.0 + layer),
        }
        for cell, mean in zip(cells["cell"], cells["cytoplasm_mean_GFP"], strict=True)
        for layer in range(LAYERS)
    ]
    return pd.DataFrame(rows)


def test_lines_are_over_the_mean_of_the_cytoplasm(tmp_path: Path, saved: list[Figure]) -> None:
    cells = _cells([0.5, 3.0, 1.0])
    assert write_nuclei_figure(tmp_path / "nuclei.png", cells, _profile(cells)) is not None
    lines, ratios, shares = saved[0].axes
    drawn = [line.get_ydata() for line in lines.lines if len(np.asarray(line.get_xdata())) == LAYERS]
    assert len(drawn) == 4  # three cells and their mean
    for line in drawn:
        assert_allclose(np.asarray(line), [1.0, 2.0, 3.0, 4.0])
    assert ratios.get_yscale() == "log"
    assert_allclose(np.asarray(ratios.collections[0].get_offsets())[:, 1], [0.5, 3.0, 1.0])
    assert_allclose(np.asarray(shares.collections[0].get_offsets())[:, 1], 0.5)


@pytest.mark.parametrize("ratios", [[0.9, 1.2], [0.0, 5.0]])
def test_without_lines_and_with_few_or_no_times(
    tmp_path: Path, saved: list[Figure], ratios: list[float]
) -> None:
    write_nuclei_figure(tmp_path / "nuclei.png", _cells(ratios), None)
    ratio, _ = saved[0].axes
    assert ratio.get_yscale() == "linear"
    assert ratio.get_ylim()[0] == 0.0


def test_a_cell_without_a_cytoplasm_has_no_line(tmp_path: Path, saved: list[Figure]) -> None:
    cells = _cells([1.0, 2.0])
    profile = _profile(cells)
    cells.loc[0, "cytoplasm_mean_GFP"] = np.nan
    write_nuclei_figure(tmp_path / "nuclei.png", cells, profile)
    drawn = [line for line in saved[0].axes[0].lines if len(np.asarray(line.get_xdata())) == LAYERS]
    assert len(drawn) == 2


def test_a_layer_that_no_cell_has_is_left_out(tmp_path: Path, saved: list[Figure]) -> None:
    cells = _cells([1.0, 2.0])
    profile = _profile(cells)
    profile.loc[profile["layer"] == 2, "mean"] = np.nan
    write_nuclei_figure(tmp_path / "nuclei.png", cells, profile)
    cells["cytoplasm_mean_GFP"] = 0.0
    write_nuclei_figure(tmp_path / "nuclei.png", cells, profile)
    assert saved[1].axes[0].get_ylim()[0] == 0.0


def test_no_picture_without_a_ratio(tmp_path: Path) -> None:
    assert write_nuclei_figure(tmp_path / "nuclei.png", _cells([np.nan]), None) is None
    assert not list(tmp_path.iterdir())


def test_long_names_of_channels_stand_below_the_thirds(tmp_path: Path, drawn: list[Figure]) -> None:
    cells = _cells([1.5])
    longer = [
        cells.rename(columns=lambda name, k=k: name.replace("GFP", f"D7_signal {k}")) for k in (1, 2, 3)
    ]
    joined = pd.concat([longer[0], *(one.drop(columns="cell") for one in longer[1:])], axis=1)
    write_nuclei_figure(tmp_path / "nuclei.png", joined, None)
    assert "1 cell with its nucleus" in {text.get_text() for text in drawn[0].texts}
