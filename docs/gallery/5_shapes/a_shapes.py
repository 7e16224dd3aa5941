"""
Measure the shape of cells, from plain to complex
=================================================

Some hundred numbers say what the shape of a cell is: size, form, moments, outline,
curvature, depth and skeleton. Of many cells together they give an axis from plain to
complex shapes, as the paper uses it to choose cells.
"""

import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd

# %%
# Cells of four kinds.
seeds = range(8)
masks = [cd.simulate.random_smooth(seed, radius=30) for seed in seeds]
masks += [cd.simulate.migrating(seed, size=0.5) for seed in seeds]
masks += [cd.simulate.random_spiky(seed, radius=22, spike_length=25) for seed in seeds]
masks += [cd.simulate.branching(seed, process_length=45) for seed in seeds]
kinds = np.repeat(["smooth", "migrating", "spiky", "branching"], len(seeds))

features = cd.shape_features(masks, pixel_size_um=0.16)
shown = ["area", "circularity", "solidity", "aspect_ratio"]
print(features[shown].groupby(kinds).mean().round(2))
print("unit of area:", features.attrs["units"]["area"])

# %%
# The features that do not depend on size are laid out in a plane (UMAP). The score is
# the position along the plane's principal axis.
score = cd.complexity_score(features, seed=0)
markers = {"smooth": "o", "migrating": ">", "spiky": "*", "branching": "s"}
figure, ax = plt.subplots(figsize=(5, 3.2), layout="constrained")
for kind, marker in markers.items():
    these = score[kinds == kind]
    points = ax.scatter(
        these["umap_1"],
        these["umap_2"],
        c=these["complexity"],
        vmin=score["complexity"].min(),
        vmax=score["complexity"].max(),
        marker=marker,
        s=22,
        label=kind,
    )
ax.axline((0, 0), tuple(score.attrs["axis"]), color="0.7", linewidth=0.8, zorder=0)
ax.set(xlabel="UMAP 1", ylabel="UMAP 2")
ax.legend(frameon=False)
figure.colorbar(points, label="complexity")
plt.show()

# %%
# Six cells along the axis. The score belongs to the cells that were scored together.
ranked = score["complexity"].to_numpy().argsort()
chosen = ranked[np.linspace(0, len(ranked) - 1, 6).astype(int)]
figure, axes = plt.subplots(1, 6, figsize=(6.2, 1.5), layout="constrained")
for ax, number in zip(axes, chosen, strict=True):
    ax.imshow(masks[number], cmap="Greys")
    ax.set_title(f"{score['complexity'].iloc[number]:.1f}")
    ax.axis("off")
plt.show()
