import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd

wave = cd.simulate.wave_series(
    "running",
    2,
    frames=90,
    sectors=36,
    mode=2,
    period_s=75.0,
    noise=2.0,
    noise_memory=0.8,
    correlation_length=2.0,
)
found = cd.edge_waves(wave, surrogates=199)
figure, axes = plt.subplots(1, 3, figsize=(6.2, 2.4), width_ratios=(1.3, 1.1, 1), layout="constrained")
seconds, sectors = wave["time_s"], wave["sector"]
limit = float(np.abs(wave).max())
image = axes[0].pcolormesh(seconds, sectors, wave.T, cmap="RdBu_r", vmin=-limit, vmax=limit, rasterized=True)
crest = np.where(np.cos(found["wave_phase"]) > 0, np.sin(found["wave_phase"]), np.nan)
axes[0].contour(seconds, sectors, crest.T, levels=[0.0], colors="0.1", linewidths=0.7)
axes[0].set(xlabel="time (s)", ylabel="sector")
shares = 100.0 * found["spectrum"]
mesh = axes[1].pcolormesh(
    shares["travelling"], 1000.0 * shares["frequency"], shares, cmap="Greys", rasterized=True
)
chosen = np.sign(found["direction"]) * found["mode"], 1000.0 / found["period_s"]
axes[1].plot(*chosen, "o", markerfacecolor="none", color="#D55E00")
axes[1].set(xlabel="waves around the cell", ylabel="frequency (mHz)")
figure.colorbar(mesh, ax=axes[1], label="share of variance (%)")
axes[2].hist(found["order_null"], 20, color="0.8")
axes[2].axvline(found["order"], color="#D55E00", linewidth=1.2)
axes[2].set(xlabel="order score", ylabel="surrogates")
