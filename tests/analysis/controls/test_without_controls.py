"""Series without controls: non-negative least squares against SciPy's, gaps, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from scipy.optimize import nnls

import cytodisk as cd
from cytodisk.errors import ParameterError

_DIMS = ("time", "layer", "sector")


def _series(seed, shape=(50, 2, 3)):
    return xr.DataArray(np.random.default_rng(seed).normal(size=shape), dims=_DIMS)


@pytest.mark.parametrize("count", [2, 3, 4])
def test_the_same_as_scipy(count):
    controls = [_series(seed) for seed in range(count)]
    controls[-1] = controls[-1] + 2.0 * controls[0]  # they go together
    values = _series(9) + 0.7 * controls[0] - 0.4 * controls[-1] + 30.0
    found = cd.without_controls(values, controls)
    signs = set()
    for layer, sector in np.ndindex(2, 3):
        y, *columns = (one[:, layer, sector].to_numpy() for one in (values, *controls))
        around = np.stack([column - column.mean() for column in columns], axis=1)
        coefficients, _ = nnls(around, y - y.mean())
        signs |= set((coefficients > 0).tolist())
        np.testing.assert_allclose(found[:, layer, sector], y - around @ coefficients, atol=1e-9)
    assert signs == {True, False}


def test_a_control_against_the_signal_is_left():
    """The mean of a still cell without the frames nearby falls where the signal rises."""
    values = _series(1)
    np.testing.assert_array_equal(cd.without_controls(values, -values), values)
    left = cd.without_controls(values, values)
    np.testing.assert_allclose(left, np.broadcast_to(values.mean("time"), values.shape), atol=1e-12)


def test_gaps_count_nowhere():
    control, noise = _series(2), _series(3)
    values = 2.0 * control + noise
    values[4], control[7] = np.nan, np.nan
    found = cd.without_controls(values, control)
    assert np.flatnonzero(~np.isfinite(found[:, 0, 0])).tolist() == [4, 7]
    keep = [frame for frame in range(50) if frame not in (4, 7)]
    alone = cd.without_controls(values[keep], control[keep])
    np.testing.assert_allclose(found[keep], alone, atol=1e-12)


def test_too_few_frames_leave_nothing():
    values, control = _series(4), _series(5)
    control[19:, 0, 0] = np.nan
    control[20:, 1, 1] = np.nan
    found = cd.without_controls(values, control)
    assert not np.isfinite(found[:, 0, 0]).any()
    assert int(np.isfinite(found[:, 1, 1]).sum()) == 20


def test_controls_that_say_the_same_or_nothing():
    control = _series(6)
    values = 2.0 * control + _series(7)
    one = cd.without_controls(values, control)
    for others in ([control, control], [control, control * 0.0 + 5.0], [control, 3.0 * control + 1.0]):
        np.testing.assert_allclose(cd.without_controls(values, others), one, atol=1e-6)
    np.testing.assert_array_equal(cd.without_controls(values, control * 0.0), values)


def test_names_and_order_of_dims_stay():
    values = _series(8).transpose("sector", "time", "layer").assign_attrs(units="a.u.")
    found = cd.without_controls(values, _series(9).isel(layer=0))
    assert found.dims == values.dims
    assert found.attrs == {"units": "a.u."}


def test_wrong_arguments():
    values = _series(0)
    with pytest.raises(ParameterError, match="values must be a DataArray with time"):
        cd.without_controls(values.to_numpy(), values)
    with pytest.raises(ParameterError, match="1 to 8"):
        cd.without_controls(values, [])
    with pytest.raises(ParameterError, match="1 to 8"):
        cd.without_controls(values, [values] * 9)
    with pytest.raises(ParameterError, match="by time"):
        cd.without_controls(values.isel(layer=0, drop=True), values)
    with pytest.raises(ParameterError, match="frames and windows"):
        cd.without_controls(values, values[:30])
