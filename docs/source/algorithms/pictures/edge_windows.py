import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd

disk = cd.map_to_disk(cd.simulate.migrating(seed=1, size=0.7))
layers, sectors = 5, 24
kinds = {
    "on the disk": cd.polar_windows(layers, sectors).on(disk),
    "along the edge": cd.edge_windows(disk, layers, sectors),
    "with springs": cd.spring_windows(disk, layers, sectors),
    "rings": cd.ring_windows(disk, layers, sectors),
}
order = np.random.default_rng(2).permutation(layers * sectors)
figure, axes = plt.subplots(2, 2, figsize=(4.6, 3.6), layout="constrained")
for ax, (name, windows) in zip(axes.flat, kinds.items(), strict=True):
    shown = np.where(windows.labels >= 0, order[windows.labels], np.nan)
    ax.imshow(shown, cmap="Set3", interpolation="nearest")
    cd.plot.draw_outline(ax, disk)
    cd.plot.frame_cell(ax, disk)
    ax.set_title(f"{name}: {100 * (windows.areas == 0).mean():.0f} % empty", fontsize=8)
