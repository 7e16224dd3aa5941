"""
Compare windows on your own cells
=================================

How many windows are empty? How regular are they? How far does a map keep areas, and is
it one to one? One command answers for several methods on the same masks.
"""

import subprocess
import sys
from pathlib import Path
from tempfile import mkdtemp

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import tifffile

import cytodisk as cd

# %%
# Six simulated cells of three kinds, side by side in one label image.
masks = [cd.simulate.random_smooth(seed, radius=25) for seed in range(2)]
masks += [cd.simulate.migrating(seed, size=0.5) for seed in range(2)]
masks += [cd.simulate.random_spiky(seed, radius=20) for seed in range(2)]
height = max(mask.shape[0] for mask in masks)
columns = [
    np.pad(mask * number, ((0, height - mask.shape[0]), (0, 0)))
    for number, mask in enumerate(masks, start=1)
]
labels = np.concatenate(columns, axis=1).astype(np.uint16)
folder = Path(mkdtemp())
tifffile.imwrite(folder / "labels.tif", labels)

command = (
    "compare-windows labels.tif -o out --layers 8 --sectors 40 "
    "--methods newton,harmonic,edge,springs"
)
done = subprocess.run(
    [sys.executable, "-m", "cytodisk", *command.split(), "--quiet"],
    cwd=folder,
    check=True,
    capture_output=True,
    text=True,
)

# %%
# One row for each method, over all cells. (Here transposed.)
by_method = pd.read_csv(folder / "out" / "comparison_methods.csv").set_index("method")
print(by_method.T.to_string())

# %%
# One row for each method and layer. The picture shows the share of windows that hold a
# part of the cell, from the edge inwards.
by_layer = pd.read_csv(folder / "out" / "comparison.csv")
figure, ax = plt.subplots(figsize=(4.4, 2.6), layout="constrained")
for (method, table), style in zip(
    by_layer.groupby("method", sort=False), ("o-", "^:", "s--", "d-."), strict=True
):
    ax.plot(
        table["layer"], 100 * table["completeness"], style, markersize=3, label=method
    )
ax.set(xlabel="layer (0 at the edge)", ylabel="windows with signal (%)", ylim=(0, 105))
ax.legend(frameon=False)
plt.show()

# %%
# The command draws this, too.
print(*sorted(file.name for file in (folder / "out" / "figures").iterdir()), sep="\n")

# %%
# With ``--movie`` it compares how well windows keep their position over time. There
# ``springs`` follow the edge by line tension of their own, and ``registered`` carries
# the windows of the first frame to the others by a registration of the masks.
truth = cd.simulate.movie("bulging", seed=3, frames=6, radius_px=16.0)
options = {"photometric": "minisblack"}
tifffile.imwrite(folder / "masks.tif", truth.masks.astype(np.uint8), **options)
names = list(truth.signal["channel"].values)
axes = {"axes": "TCYX", "Channel": {"Name": names}}
tifffile.imwrite(
    folder / "signal.ome.tif", truth.signal.to_numpy(), metadata=axes, **options
)
movie = cd.run_compare_windows(
    folder / "masks.tif",
    folder / "movie",
    signal=folder / "signal.ome.tif",
    movie=True,
    methods=("newton", "edge", "springs", "registered"),
    layers=5,
    sectors=24,
)
columns = ["method", "completeness", "coverage", "folded", "carried_outside"]
print(movie.by_method[columns].round(3).to_string(index=False))

# %%
# How far windows move from a frame to the next, and how alike their signal stays:
# medians over frames of the mean over layers.
rows = movie.through_time
rows = rows[rows["layer"].isna()]
print(
    rows[["method", "channel", "correlation", "centroid_displacement"]]
    .round(3)
    .to_string(index=False)
)
