"""Sample data of the plugin."""

import numpy as np
import pytest

from cytodisk.napari.sample_data import WRONG_FRAME, cells_sample, movie_sample, wrong_frame_sample

pytestmark = pytest.mark.slow


def test_the_wrong_frame_is_the_only_difference_between_the_movies() -> None:
    (right, right_look, _), (wrong, wrong_look, _) = movie_sample()[-1], wrong_frame_sample()[-1]

    differ = np.flatnonzero((right != wrong).any(axis=(1, 2)))

    assert differ.tolist() == [WRONG_FRAME]
    assert wrong[WRONG_FRAME].sum() > 1.2 * right[WRONG_FRAME].sum()
    assert right_look["axis_labels"] == ("time", "y", "x")
    assert right_look["scale"] == wrong_look["scale"] == (5.0, 0.16, 0.16)


def test_cells_have_nuclei_and_a_signal() -> None:
    (signal, _, kind), (nuclei, *_), (cells, settings, _) = cells_sample()

    assert (kind, len(np.unique(cells)), len(np.unique(nuclei))) == ("image", 17, 17)
    assert settings["units"] == ("micrometer", "micrometer")
    assert signal[(cells > 0) & (nuclei == 0)].mean() > signal[nuclei > 0].mean() > signal[cells == 0].mean()
