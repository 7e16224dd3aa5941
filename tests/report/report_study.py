"""Sizes and names of the small study, and correlations with known numbers."""

from dataclasses import dataclass

import numpy as np
import pandas as pd

FRAMES, GAP, LAYERS, SECTORS = 8, 6, 4, 12
NAMES = ["</script><script>document.title='broken'</script>", "a \"b\" & 'c' <b>$$x$$</b>"]
LAGS = np.arange(-3, 4)


@dataclass(frozen=True)
class Correlated:
    """Tables as a study keeps them, with numbers that are known."""

    windows: pd.DataFrame
    layers: pd.DataFrame
    curves: pd.DataFrame
    layer_curves: pd.DataFrame


def correlated() -> Correlated:
    """Window (layer, sector) peaks at lag 2 with 0.01 · sector; those of layer 0 are significant."""
    window = pd.MultiIndex.from_product(
        [[0], range(LAYERS), range(SECTORS)], names=["cell", "layer", "sector"]
    )
    windows = window.to_frame(index=False)
    windows["correlation"] = 0.01 * windows["sector"]
    windows = windows.assign(lag=2, lag_s=10.0, n=6, n_effective=5.5, low=-0.5, high=0.5, p=0.004)
    windows["q"] = np.where(windows["layer"] == 0, 0.01, 0.5)
    curves = windows[["cell", "layer", "sector"]].merge(pd.DataFrame({"lag": LAGS}), how="cross")
    curves = curves.assign(correlation=0.1 * curves["lag"], low=-0.6, high=0.6)
    layers = pd.DataFrame({"cell": 0, "layer": range(LAYERS), "threshold": 0.25})
    layer_curves = layers[["cell", "layer"]].merge(pd.DataFrame({"lag": LAGS}), how="cross")
    return Correlated(windows, layers, curves, layer_curves.assign(correlation=0.05))
