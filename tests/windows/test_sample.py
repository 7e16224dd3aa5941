import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

import cytodisk as cd
from cytodisk.errors import ParameterError, SignalError

QUANTILES = (0.0, 0.25, 0.5, 0.9, 1.0)


def twin(windows: cd.CellWindows, signal: np.ndarray, nan: str) -> dict[str, np.ndarray]:
    """Every statistic by a loop over windows."""
    pixels = signal[windows.mask]
    rows = []
    for weights in windows.weights.toarray():
        missing = (weights > 0) & np.isnan(pixels)
        held = (weights > 0) & ~np.isnan(pixels)
        w, v = weights[held], pixels[held]
        row = {"n_pixels": w.sum(), "n_nan": weights[missing].sum()}
        if len(v) == 0 or (nan == "propagate" and missing.any()):
            rows.append(
                row | dict.fromkeys(("mean", "sd", "min", "max"), np.nan) | {"quantile": [np.nan] * 5}
            )
            continue
        mean = np.average(v, weights=w)
        order = np.argsort(v)
        share = np.cumsum(w[order]) / w.sum()
        rows.append(
            row
            | {
                "mean": mean,
                "sd": np.sqrt(np.average((v - mean) ** 2, weights=w)),
                "min": v.min(),
                "max": v.max(),
                "quantile": [v[order][np.argmax(share >= q * (1 - 1e-12))] for q in QUANTILES],
            }
        )
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


@pytest.mark.parametrize("nan", ["propagate", "omit"])
@given(seed=st.integers(0, 2**31), missing=st.sampled_from([0.0, 0.01, 0.5, 1.0]))
def test_statistics_have_a_plain_twin(windows: cd.CellWindows, nan: str, seed: int, missing: float) -> None:
    random = np.random.default_rng(seed)
    signal = random.normal(100.0, 30.0, windows.mask.shape)
    signal[random.random(signal.shape) < missing] = np.nan
    found = cd.sample(windows, signal, quantiles=QUANTILES, nan=nan)
    for name, expected in twin(windows, signal, nan).items():
        shape = (4, 12, 5) if name == "quantile" else (4, 12)
        assert_allclose(found[name], expected.reshape(shape), rtol=1e-10, atol=1e-12, err_msg=name)


def test_a_constant_signal_has_no_spread(windows: cd.CellWindows) -> None:
    data = cd.sample(windows, np.full(windows.mask.shape, 5.0), quantiles=[0.5])
    assert_allclose(data["mean"], 5.0)
    assert_allclose(data["sd"], 0.0, atol=1e-12)
    assert_array_equal(data["quantile"], np.full((4, 12, 1), 5.0))


def test_values_outside_the_cell_do_not_count(windows: cd.CellWindows) -> None:
    signal = np.where(windows.mask, 1.0, np.nan)
    data = cd.sample(windows, signal)
    assert_allclose(data["mean"], 1.0)
    assert float(data["n_nan"].sum()) == 0.0


def test_a_nan_pixel_makes_its_windows_nan_and_is_counted(windows: cd.CellWindows) -> None:
    signal = np.ones(windows.mask.shape)
    pixel = len(np.argwhere(windows.mask)) // 2
    signal[tuple(np.argwhere(windows.mask)[pixel])] = np.nan
    touched = windows.weights[:, [pixel]].toarray().reshape(4, 12) > 0
    data = cd.sample(windows, signal)
    assert_array_equal(np.isnan(data["mean"]), touched)
    assert float(data["n_nan"].sum()) == pytest.approx(1.0)
    left_out = cd.sample(windows, signal, nan="omit")
    assert_allclose(left_out["mean"], 1.0)
    assert_allclose(left_out["n_pixels"] + left_out["n_nan"], windows.areas)


def test_a_window_of_nan_alone_is_nan_in_both_policies(windows: cd.CellWindows) -> None:
    signal = np.full(windows.mask.shape, np.nan)
    for nan in ("propagate", "omit"):
        data = cd.sample(windows, signal, nan=nan, quantiles=[0.5])
        for name in ("mean", "sd", "min", "max", "quantile"):
            assert np.isnan(data[name]).all()
        assert_array_equal(data["n_pixels"], np.zeros((4, 12)))


def test_channels_are_sampled_each_by_itself(windows: cd.CellWindows) -> None:
    stack = np.random.default_rng(0).random((3, *windows.mask.shape))
    data = cd.sample(windows, stack, quantiles=[0.5])
    assert data["mean"].dims == ("channel", "layer", "sector")
    assert data["channel"].to_numpy().tolist() == ["0", "1", "2"]
    for number, plane in enumerate(stack):
        one = cd.sample(windows, plane, quantiles=[0.5])
        assert one["mean"].dims == ("layer", "sector")
        for name in ("mean", "sd", "min", "max", "n_pixels", "n_nan", "quantile"):
            assert_array_equal(data[name][number], one[name])


def test_a_data_array_keeps_its_channel_names_whatever_the_order_of_dims(windows: cd.CellWindows) -> None:
    stack = np.random.default_rng(0).random((2, *windows.mask.shape))
    named = xr.DataArray(stack, dims=("channel", "y", "x"), coords={"channel": ["Rac1", "RhoA"]})
    data = cd.sample(windows, named.transpose("y", "x", "channel"))
    assert data["channel"].to_numpy().tolist() == ["Rac1", "RhoA"]
    assert_array_equal(data["mean"], cd.sample(windows, stack)["mean"])


def test_a_data_array_without_channel_is_put_in_order_too() -> None:
    square = np.random.default_rng(0).random((30, 30))
    windows = cd.polar_windows(2, 5).on(cd.map_to_disk(np.ones((30, 30), dtype=bool)))
    turned = xr.DataArray(square.T.copy(), dims=("x", "y"))
    assert_array_equal(cd.sample(windows, turned)["mean"], cd.sample(windows, square)["mean"])


@pytest.mark.parametrize("dtype", ["uint8", "uint16", "int32", "bool", "float32"])
def test_every_number_type_is_read(windows: cd.CellWindows, dtype: str) -> None:
    signal = np.random.default_rng(0).integers(0, 2, windows.mask.shape)
    found = cd.sample(windows, signal.astype(dtype))["mean"]
    assert_array_equal(found, cd.sample(windows, signal.astype(float))["mean"])


@pytest.mark.parametrize(
    ("signal", "message"),
    [
        (np.zeros((3, 3)), r"signal has shape \(3, 3\), mask \(20, 20\): pass \(H, W\) or \(channel, H, W\)"),
        (np.zeros((2, 2, 20, 20)), r"signal has shape \(2, 2, 20, 20\), mask"),
        (np.zeros((0, 20, 20)), r"signal has shape \(0, 20, 20\), mask"),
        (np.zeros((20, 20), dtype=complex), "signal must be numeric, got dtype complex128"),
        (np.full((20, 20), "a"), "signal must be numeric, got dtype <U1"),
        (
            xr.DataArray(np.zeros((2, 20, 20)), dims=("time", "y", "x")),
            r"signal has the dims \['time'\] beside channel, y, x: pass one frame",
        ),
        (
            xr.DataArray(np.zeros((20, 20)), dims=("channel", "y")),
            r"signal has the dims \['channel', 'y'\]: it needs y and x",
        ),
    ],
)
def test_a_signal_that_does_not_fit_is_refused(signal: object, message: str) -> None:
    windows = cd.polar_windows(2, 3).on(cd.map_to_disk(np.ones((20, 20), dtype=bool)))
    with pytest.raises(SignalError, match=message):
        cd.sample(windows, signal)


def test_parameters_out_of_range_are_refused(windows: cd.CellWindows) -> None:
    signal = np.zeros(windows.mask.shape)
    with pytest.raises(ParameterError, match="quantiles must"):
        cd.sample(windows, signal, quantiles=[-0.1, 0.5, 2])
    with pytest.raises(ParameterError, match=r"nan.*'drop'"):
        cd.sample(windows, signal, nan="drop")


def test_infinite_and_masked_pixels_count_as_missing() -> None:
    mask = cd.simulate.disk(12.0)
    windows = cd.polar_windows(2, 4).on(cd.map_to_disk(mask))
    signal = np.ones(mask.shape)
    row, column = np.argwhere(mask)[40]
    signal[row, column] = np.inf
    for values in (signal, np.ma.masked_invalid(signal)):
        data = cd.sample(windows, values, nan="omit")
        assert float(data["n_nan"].sum()) == pytest.approx(1.0)
        np.testing.assert_allclose(data["mean"], 1.0)


@pytest.mark.parametrize("quantiles", [0.5, ["a"]])
def test_quantiles_that_are_none_are_refused(quantiles: object) -> None:
    windows = cd.polar_windows(1, 2).on(cd.map_to_disk(cd.simulate.disk(6.0)))
    with pytest.raises(ParameterError, match="quantiles must be a sequence of numbers"):
        cd.sample(windows, np.zeros(windows.mask.shape), quantiles=quantiles)  # type: ignore[arg-type]


def test_swapped_arguments_are_told_their_order(windows: cd.CellWindows) -> None:
    signal = np.zeros(windows.mask.shape)
    with pytest.raises(ParameterError, match=r"windows must be .*, got ndarray: .*sample\(windows, signal\)"):
        cd.sample(signal, windows)


def test_two_channels_of_one_name_are_refused(windows: cd.CellWindows) -> None:
    values = np.zeros((2, *windows.mask.shape))
    signal = xr.DataArray(values, {"channel": ["Rac1", "Rac1"]}, ("channel", "y", "x"))
    with pytest.raises(SignalError, match="two channels have one name"):
        cd.sample(windows, signal)
