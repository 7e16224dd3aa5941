"""
Go on in scanpy
===============

A population is a table of cells × windows, as single-cell tools want it. ``to_anndata``
gives it to scanpy, with conditions and experiments beside the cells. Here: PCA,
neighbours and UMAP. You need ``pip install 'cytodisk[anndata]' scanpy``.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd

try:
    import scanpy as sc
except ImportError:
    sc = None
    print("scanpy is not installed: the steps that need it are left out.")
    print("Type: pip install 'cytodisk[anndata]' scanpy")

# %%
# Cells of 4 + 4 dishes. The drug raises a region of the cell. A third of the variance
# lies between dishes. Each cell lies turned on its slide, so that the cells are first
# aligned, here by the nucleus.
truth = cd.simulate.population(
    experiments=4,
    cells=40,
    between_experiments=0.3,
    effect=3.0,
    layers=6,
    sectors=24,
    turned="nucleus",
    seed=1,
)
pop = cd.Population(truth.values, truth.cells).align("nucleus")
print(pop)

# %%
# The table
# ---------
# ``X`` has a row for each cell and a column for each window. ``obs`` is the table of
# cells, ``var`` says where each window lies. ``obsm`` has numbers of whole cells, as
# the ratio of edge to centre. ``uns`` says what was done to the values.
if sc is not None:
    table = pop.to_anndata()
    print(table)
    print(table.obs[["condition", "experiment"]].iloc[::80])
    print(table.var.iloc[:3])
    print(table.uns["cytodisk"])

# %%
# PCA takes no gaps: keep the windows that all cells have. ``scale`` then gives all
# windows the same weight.
if sc is not None:
    table = table[:, table.var["cells"] == table.n_obs].copy()
    sc.pp.scale(table)
    sc.pp.pca(table, n_comps=20, random_state=0)
    sc.pp.neighbors(table, n_neighbors=15, random_state=0)
    sc.tl.umap(table, random_state=0)

# %%
# The conditions lie apart, and so do dishes of one condition: each dish is a cloud of
# its own. That is why cells of a dish do not count one by one. A UMAP is a picture, no
# test: ask `cytodisk.compare_conditions`.
if sc is not None:
    figure, axes = plt.subplots(1, 2, figsize=(6.6, 2.9), layout="constrained")
    for ax, name in zip(axes, ("condition", "experiment"), strict=True):
        groups = table.obs[name].cat.categories
        colours = plt.get_cmap("viridis")(np.linspace(0, 0.95, len(groups)))
        for group, colour in zip(groups, colours, strict=True):
            chosen = (table.obs[name] == group).to_numpy()
            ax.scatter(*table.obsm["X_umap"][chosen].T, s=6, color=colour, label=group)
        ax.set(xlabel="UMAP 1", ylabel="UMAP 2", title=name, xticks=[], yticks=[])
        ax.legend(frameon=False, fontsize=6, markerscale=1.5)
    plt.show()

# %%
# Which windows tell the conditions apart
# ---------------------------------------
# The first component as a picture of the disk: the weight of each window.
if sc is not None:
    weights = table.varm["PCs"][:, 0].reshape(6, 24)
    most = np.abs(weights).max()
    figure, ax = plt.subplots(figsize=(3.0, 2.6), layout="constrained")
    grid = cd.polar_windows(layers=6, sectors=24)
    drawn = cd.plot.draw_disk_means(
        ax, grid, weights, cmap="PuOr", limits=(-most, most)
    )
    figure.colorbar(drawn, label="weight in component 1")
    plt.show()

# %%
# Into a file and back
# --------------------
# scanpy, CELLxGENE and others read the ``.h5ad`` file. On the command line, type
# ``cytodisk population maps --h5ad -o atlas``.
if sc is not None:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "population.h5ad"
        pop.to_anndata().write_h5ad(path)
        print(sc.read_h5ad(path))
