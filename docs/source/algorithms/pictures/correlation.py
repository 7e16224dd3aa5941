import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd
from cytodisk.analysis.correlation.surrogates import surrogates

frames, count = 150, 100
here = np.ones((1, 1), dtype=bool)
signal, velocity = cd.simulate.coupled_series(
    "ar1", seed=1, frames=frames, layers=1, sectors=1, lag_frames=5, windows=here, strength=0.8
)
found = cd.cross_correlate(signal, velocity, max_lag=20, surrogates=999)
false = surrogates("phase", frames, count, seed=0).alone(velocity.to_numpy()[:, 0])
figure, axes = plt.subplots(
    1, 2, figsize=(6.2, 2.5), width_ratios=(1.7, 1), sharey=True, layout="constrained"
)
for number in range(count):
    curve = cd.cross_correlate(signal.to_numpy()[:, 0, 0], false[:, number], max_lag=20)
    axes[0].plot(curve["lag"], curve["correlation"], color="0.8", linewidth=0.4)
axes[0].plot(found["lag"], found["correlation"].squeeze(), color="#0072B2")
axes[0].axvline(-5, color="0.15", linewidth=0.6, linestyle=":")
axes[0].set(xlabel="lag (frames)", ylabel="correlation")
limit = float(found["threshold"].squeeze())
axes[1].hist(found["null"].to_numpy().ravel(), 30, orientation="horizontal", color="0.8")
for ax in axes:
    ax.axhline(limit, color="#D55E00", linewidth=0.8)
axes[1].annotate("5 % lie above\nthe line", (1, 0.02), xycoords="axes fraction", ha="right")
axes[1].set_xlabel("surrogates")
