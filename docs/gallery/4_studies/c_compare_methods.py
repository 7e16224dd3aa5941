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
    "--methods newton,harmonic,edge"
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
    by_layer.groupby("method", sort=False), ("o-", "^:", "s--"), strict=True
):
    ax.plot(
        table["layer"], 100 * table["completeness"], style, markersize=3, label=method
    )
ax.set(xlabel="layer (0 at the edge)", ylabel="windows with signal (%)", ylim=(0, 105))
ax.legend(frameon=False)
plt.show()

# %%
# The command draws this, too. With ``--movie`` it compares how well windows keep their
# position over time.
print(*sorted(file.name for file in (folder / "out" / "figures").iterdir()), sep="\n")
