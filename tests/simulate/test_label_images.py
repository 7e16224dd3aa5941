import numpy as np
import pytest
from numpy.testing import assert_array_equal
from scipy import ndimage

from cytodisk.errors import ParameterError
from cytodisk.simulate import label_image


@pytest.mark.parametrize("cells", [1, 2, 30])
def test_every_cell_is_there_and_apart_from_the_others(cells: int) -> None:
    image = label_image(cells, seed=3)
    assert np.unique(image[image > 0]).tolist() == list(range(1, cells + 1))
    assert np.bincount(image.ravel())[1:].min() >= 50
    grown = ndimage.maximum_filter(image, footprint=np.ones((3, 3)))
    assert (grown[image > 0] == image[image > 0]).all()  # no cell has a neighbour with a larger number


def test_some_cells_are_cut_off() -> None:
    image = label_image(30)
    assert image[0].any()
    assert image[:, 0].any()


def test_the_same_seed_gives_the_same_picture() -> None:
    assert_array_equal(label_image(5, 1), label_image(5, 1))
    assert (
        label_image(5, 1).shape != label_image(5, 2).shape or (label_image(5, 1) != label_image(5, 2)).any()
    )


def test_no_cells() -> None:
    with pytest.raises(ParameterError, match="cells"):
        label_image(0)
