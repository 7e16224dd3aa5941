"""
What chance gives
=================

Two signals that have nothing to do with each other can correlate strongly at some lag,
because neighbouring frames are alike. Surrogates show how strongly.
"""

import warnings

import matplotlib.pyplot as plt

import cytodisk as cd

# %%
# Independent series whose neighbouring frames correlate by 0.8. Every correlation
# between them is a false positive.
activity, velocity = cd.simulate.independent_series(
    "ar1", seed=0, frames=120, layers=2, sectors=60
)
warnings.simplefilter("ignore", cd.errors.StationarityWarning)
lags = cd.cross_correlate(activity, velocity, max_lag=20, surrogates=299)
peaks = cd.peak_correlation(lags, rule="largest")

# %%
# The peaks of 120 windows. A test that treats frames as independent, and ignores the
# search over lags, calls a correlation above 0.18 significant. Here nearly all peaks
# are above it, by chance alone.
figure, ax = plt.subplots(figsize=(5, 2.6), layout="constrained")
ax.hist(abs(peaks["correlation"].to_numpy().ravel()), 30, color="0.6")
ax.axvline(0.18, color="#D55E00", label="5 % limit if frames were independent")
ax.axvline(
    float(lags["threshold"].median()),
    color="#0072B2",
    label="5 % limit of the surrogates",
)
ax.set(xlabel="|correlation| at the peak", ylabel="windows")
ax.legend(frameon=False)
plt.show()
print(f"above 0.18:           {float((abs(peaks['correlation']) > 0.18).mean()):.0%}")
print(f"p < 0.05:             {float((peaks['p'] < 0.05).mean()):.0%}")
print(f"q < 0.05:             {float((peaks['q'] < 0.05).mean()):.0%}")
