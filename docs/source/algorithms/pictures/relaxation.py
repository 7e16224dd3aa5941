import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd

mask = np.pad(cd.simulate.star(arms=5, body_radius=22, arm_length=30, arm_width=14), 2)
grid = cd.polar_windows(layers=6, sectors=24)
noisy, _ = cd.clean_mask(cd.simulate.flipped_masks(mask[None], share=0.5, seed=0)[0])
pixels = np.argwhere(mask)
stays = noisy[mask]
figure, axes = plt.subplots(2, 3, figsize=(6.4, 4.4), layout="constrained")
for column, method in zip(axes.T, ("harmonic", "newton", "newton-triangles"), strict=True):
    disk, other = cd.map_to_disk(mask, method=method), cd.map_to_disk(noisy, method=method)
    windows = grid.on(disk)
    share = windows.areas * grid.n_windows / windows.areas.sum()
    here, there = (grid.window_of(one.to_disk(pixels, outside="nearest")) for one in (disk, other))
    same = (here == there)[stays]
    for ax, values, style in (
        (column[0], np.log2(share).ravel()[here], {"cmap": "RdBu_r", "vmin": -2, "vmax": 2}),
        (column[1], np.where(here == there, 1.0, 0.0), {"cmap": "Blues", "vmin": -0.3, "vmax": 1.3}),
    ):
        image = np.full(mask.shape, np.nan)
        image[mask] = values
        if ax is column[1]:
            image[~noisy] = np.nan
        shown = ax.imshow(image, **style)
        ax.contour(mask, [0.5], colors="0.4", linewidths=0.5)
        ax.set_axis_off()
        if ax is column[0]:
            filled = shown
    column[0].set_title(f"{method}\nmean |ln λ| = {windows.area_error:.2f}", fontsize=9)
    column[1].set_title(f"with noise, {same.mean():.0%} of the\npixels stay in their window", fontsize=9)
figure.colorbar(filled, ax=axes[0], label="log₂ λ", shrink=0.8, extend="both")
