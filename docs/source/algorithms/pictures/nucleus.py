import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection, PolyCollection

import cytodisk as cd

ORANGE, BLUE = "#FBE0C3", "#CFE3F2"
found = cd.simulate.cell_with_nucleus("off centre", seed=5, shape="spread", radius_px=20.0)
disk = cd.map_to_disk(found.mask, nucleus=found.nucleus, edge_length=1.4)
nucleus, triangles = disk.nucleus, disk.triangles
grid = cd.polar_windows(layers=4, sectors=12, nucleus_layers=1)

figure, axes = plt.subplots(1, 3, figsize=(6.6, 2.7), width_ratios=(1.15, 1.0, 1.0), layout="constrained")
ring = nucleus.corners(triangles)[..., ::-1]  # (turn, share)
places = {
    "cell": disk.vertices_yx[triangles][..., ::-1],
    "disk": disk.vertices_uv[triangles],
}
edges = {"linewidths": 0.25, "edgecolors": "0.45"}
for ax, corners in zip(axes[::2], places.values(), strict=True):
    ax.add_collection(PolyCollection(corners[~nucleus.inside], facecolors=ORANGE, **edges))
    ax.add_collection(PolyCollection(corners[nucleus.inside], facecolors=BLUE, **edges))
for turn in (-1, 0, 1):
    axes[1].add_collection(PolyCollection(np.add(ring, (turn, 0.0)), facecolors=ORANGE, **edges))

share, turn = np.linspace(0.0, 1.0, 300), np.linspace(0.0, 1.0, 1200)
along = [np.column_stack([np.full(300, k / 12), share]) for k in range(13)]
around = [np.column_stack([turn, np.full(1200, k / 4)]) for k in range(5)]
for lines, color in ((along, "0.1"), (around, "#D55E00")):
    axes[1].add_collection(LineCollection(lines, colors=color, linewidths=0.7))
    radii = [nucleus.radius_at(line[:, 1]) for line in lines]
    angles = [2 * np.pi * line[:, 0] for line in lines]
    in_disk = [
        r[:, None] * np.column_stack([np.cos(a), np.sin(a)]) for r, a in zip(radii, angles, strict=True)
    ]
    in_cell = [disk.to_cell(line)[:, ::-1] for line in in_disk]
    axes[2].add_collection(LineCollection(in_disk, colors=color, linewidths=0.7))
    axes[0].add_collection(LineCollection(in_cell, colors=color, linewidths=0.7))

for ax, title in zip(axes, ("cell", "cytoplasm on the cylinder", "disk"), strict=True):
    ax.autoscale_view()
    ax.set_title(title)
axes[1].set(xlim=(0, 1), ylim=(1, 0), xlabel="turn", ylabel="share")
axes[1].set_xticks((0, 0.5, 1))
axes[1].set_yticks((0, 1))
for ax in axes[::2]:
    ax.set_aspect("equal")
    ax.invert_yaxis()
    ax.axis("off")
