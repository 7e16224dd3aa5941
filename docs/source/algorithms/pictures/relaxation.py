import matplotlib.pyplot as plt

import cytodisk as cd

mask = cd.simulate.migrating(seed=2)
figure, axes = plt.subplots(1, 2, figsize=(6.4, 2.6), layout="constrained")
for ax, method in zip(axes, ("harmonic", "newton"), strict=True):
    disk = cd.map_to_disk(mask, method=method)
    filled = cd.plot.draw_area_distortion(ax, disk, limit=3)
    ax.set_title(f"{method}: mean |ln λ| = {disk.distortion.area:.3f}")
figure.colorbar(filled, ax=axes, label="log₂ λ", shrink=0.8, extend="both")
