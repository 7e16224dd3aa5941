import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd

mask = cd.simulate.star(arms=5, body_radius=22, arm_length=30, arm_width=14)
grid = cd.polar_windows(layers=6, sectors=24)
pixels = np.argwhere(mask).astype(float)
mirrored = np.column_stack([pixels[:, 0], mask.shape[1] - 1 - pixels[:, 1]])
figure, axes = plt.subplots(2, 3, figsize=(6.4, 4.4), layout="constrained")
for column, method in zip(axes.T, ("harmonic", "newton", "newton-triangles"), strict=True):
    disk, other = cd.map_to_disk(mask, method=method), cd.map_to_disk(mask[:, ::-1], method=method)
    windows = grid.on(disk)
    share = windows.areas * grid.n_windows / windows.areas.sum()
    here = grid.window_of(disk.to_disk(pixels))
    same = here == grid.window_of(other.to_disk(mirrored) * [-1, 1])
    for ax, values, style in (
        (column[0], np.log2(share).ravel()[here], {"cmap": "RdBu_r", "vmin": -2, "vmax": 2}),
        (column[1], np.where(same, 1.0, 0.0), {"cmap": "Blues", "vmin": -0.3, "vmax": 1.3}),
    ):
        image = np.full(mask.shape, np.nan)
        image[mask] = values
        shown = ax.imshow(image, **style)
        ax.set_axis_off()
        if ax is column[0]:
            filled = shown
    column[0].set_title(f"{method}\nmean |ln λ| = {windows.area_error:.2f}", fontsize=9)
    column[1].set_title(f"mirrored: {same.mean():.0%} of the pixels\nin the same window", fontsize=9)
figure.colorbar(filled, ax=axes[0], label="log₂ λ", shrink=0.8, extend="both")
