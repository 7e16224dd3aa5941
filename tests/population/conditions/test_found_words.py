"""What was found, as a person reads it."""

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.population.conditions.comparison_sentences import found_words
from cytodisk.population.conditions.window_words import windows_words


def _said(p: float = 0.01, p_alone: tuple[float, ...] = (), p_fwer: float = 0.0625) -> list[str]:
    dims = ("channel", "layer", "sector")
    names = ("p_fwer", "score", "difference", "difference_low", "difference_high")
    values = (p, -2.0, -67.1, -606.0, 472.0)
    windows = xr.Dataset(
        {name: (dims, np.full((1, 1, 2), value)) for name, value in zip(names, values, strict=True)}
    )
    windows = windows.assign_coords(channel=["Rac1"])
    windows["difference"].attrs["units"] = "a.u."
    rows = {"channel": ["Rac1"], "layers": ["0"], "sectors": ["0–1"], "difference": [-67.1], "p": [p]}
    numbers = {"control": 1.0, "treated": 2.0, "effect_size": 1.0, "low": 0.5, "high": 1.5, "status": "ok"}
    scalars = pd.DataFrame(
        [{"scalar": f"s{k}", "p": one, "p_fwer": p_fwer, **numbers} for k, one in enumerate(p_alone)],
        columns=["scalar", "p", "p_fwer", *numbers],
    )
    return list(found_words(("control", "drug"), windows, pd.DataFrame(rows), scalars))


def test_one_layer_and_one_cluster_are_one_and_minus_is_true() -> None:
    assert _said()[0].endswith("; cluster: layer 0, sectors 0–1 (−67.1 a.u., p = 0.01).")
    assert _said(p=0.6)[0].endswith("has p = 0.6, −67.1 (−606 to 472) a.u.")


def test_windows_words() -> None:
    assert windows_words("0, 2", "5", "sector") == "layers 0, 2, sector 5"
    assert windows_words("3", "−5 to 10 s", "lag") == "layer 3, lags −5 to 10 s"
    assert windows_words("3", "10 s", "lag") == "layer 3, lag 10 s"


def test_scalars_that_differ_alone_are_told_with_what_that_is_worth() -> None:
    words = _said(p_alone=(0.031, 0.031, 0.4))[1]
    assert words.startswith("Scalars, drug against control: 0 of 3 differ")
    assert ", the smallest corrected p = 0.062; alone" in words
    assert "s0, s1 have p ≤ 0.05, which counts for the one that you chose before you looked." in words
    assert _said(p_alone=(0.4, 0.5))[1].endswith("0 of 2 differ (max-T, p ≤ 0.05).")
    assert "1 of 1 differ (max-T, p ≤ 0.05): s0 1 → 2" in _said(p_alone=(0.01,), p_fwer=0.01)[1]
