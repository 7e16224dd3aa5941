"""Sizes and names of the small study, and correlations with known numbers."""

import numpy as np
import pandas as pd

FRAMES, GAP, LAYERS, SECTORS = 8, 6, 4, 12
NAMES = ["</script><script>document.title='broken'</script>", "a \"b\" & 'c' <b>$$x$$</b>"]
LAGS = np.arange(-3, 4)


def correlated() -> dict[str, pd.DataFrame]:
    """Window (layer, sector) peaks at lag 2 with 0.01 · sector; those of layer 0 are significant."""
    window = pd.MultiIndex.from_product(
        [[0], range(LAYERS), range(SECTORS)], names=["cell", "layer", "sector"]
    )
    windows = window.to_frame(index=False)
    windows["correlation"] = 0.01 * windows["sector"]
    windows = windows.assign(
        lag=2, lag_s=10.0, n=6, n_effective=5.5, low=-0.5, high=0.5, p=0.004, threshold=0.4
    )
    windows["q"] = np.where(windows["layer"] == 0, 0.01, 0.5)
    curves = windows[["cell", "layer", "sector"]].merge(pd.DataFrame({"lag": LAGS}), how="cross")
    curves = curves.assign(correlation=0.1 * curves["lag"], low=-0.6, high=0.6)
    layers = pd.DataFrame({"cell": 0, "layer": range(LAYERS), "threshold": 0.25})
    layers = layers.assign(correlation=0.05, lag=-1, p=0.001, q=0.002)
    layer_curves = layers[["cell", "layer"]].merge(pd.DataFrame({"lag": LAGS}), how="cross")
    layer_curves["correlation"] = 0.05
    cells = pd.DataFrame({"cell": [0], "status": "ok", "reason": "", "frames": FRAMES, "jitter": 0.0})
    cells = cells.assign(drifting_signal=0.0, drifting_with=0.0)
    tables = {
        "cells": cells,
        "windows": windows,
        "layers": layers,
        "curves": curves,
        "layer_curves": layer_curves,
    }
    for table in tables.values():
        table.attrs["units"] = dict.fromkeys(table, "")
    return tables
