"""
Measure the shape of cells, from plain to complex
=================================================

About a hundred features describe the shape of a cell: size, form, moments, outline,
curvature, depth and skeleton. The features of many cells give an axis from plain to
complex shapes, which the paper uses to choose cells. On the command line, type
``cytodisk shapes masks.tif -o out/``.
"""

import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd

# %%
# Forty cells, from nearly round to spiky.
steps = np.linspace(0, 1, 40)
masks = [
    cd.simulate.random_spiky(
        seed, radius=25, spikes=round(2 + 12 * step), spike_length=2 + 40 * step
    )
    for seed, step in enumerate(steps)
]

features = cd.shape_features(masks, pixel_size_um=0.16)
shown = ["area", "circularity", "solidity", "aspect_ratio"]
print(features.loc[::13, shown].round(2))
print("unit of area:", features.attrs["units"]["area"])
print("scale-free features:", len(features.attrs["scale_free"]))

# %%
# UMAP lays the cells out in a plane, by the features that do not depend on size. The
# score is the position along the plane's principal axis, the arrow.
score = cd.complexity_score(features, seed=0)
figure, ax = plt.subplots(figsize=(5, 4), layout="constrained")
_, outlines = cd.plot.draw_shape_landscape(ax, score, masks)
figure.colorbar(outlines, label="complexity", shrink=0.7)
plt.show()

# %%
# Six cells along the axis. Compare scores only among cells that were scored together.
ranked = score["complexity"].to_numpy().argsort()
chosen = ranked[np.linspace(0, len(ranked) - 1, 6).astype(int)]
figure, ax = plt.subplots(figsize=(6.2, 1.6), layout="constrained")
cd.plot.draw_shape_examples(ax, score, masks, [chosen.tolist()], scale=cd.Scale(0.16))
plt.show()
