import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd

pair = cd.simulate.predicting_series("ar1", seed=2, frames=150, layers=1, sectors=60)
source, target = pair["source"].isel(layer=0), pair["target"]
there, back = (cd.predict(*both) for both in ((source, target), (target, source)))
figure, axes = plt.subplots(1, 2, figsize=(6.2, 2.5), width_ratios=(1.3, 1), layout="constrained")
for found, colour, words in (
    (there, "#D55E00", "source → target"),
    (back, "#0072B2", "target → source"),
):
    axes[0].hist(found["gain_null"], np.geomspace(1e-5, 0.3, 46), color=colour, histtype="step")
    axes[0].axvline(found["gain"], color=colour, label=words)
axes[0].set(xlabel="gain (nat)", ylabel="surrogates", xscale="log", xlim=(1e-5, 0.3))
figure.legend(loc="outside upper left", ncols=2, frameon=False)
axes[1].axhline(0.0, color="0.15", linewidth=0.6)
low, high = (there[f"coefficient_{end}"] for end in ("low", "high"))
axes[1].vlines(there["lag"], low, high, color="#D55E00")
axes[1].plot(there["lag"], there["coefficient"], "o", color="#D55E00", markersize=3.5)
axes[1].set(xlabel="lag (frames)", ylabel="coefficient", xlim=(0.5, 8.5), xticks=range(1, 9))
