import matplotlib.pyplot as plt

import cytodisk as cd

found = cd.simulate.cell_with_nucleus("centred", seed=7, shape="branched")
counts = {"layers": 8, "sectors": 24, "nucleus_layers": 3}
disk = cd.map_to_disk(found.mask, nucleus=found.nucleus)
interpolated = cd.interpolated_ring_windows(found.mask, found.nucleus, **counts)
kinds = {
    "on the disk": cd.polar_windows(**counts).on(disk),
    "by distance": cd.nucleus_ring_windows(found.mask, found.nucleus, **counts),
    f"interpolated: {interpolated.n_turned_over} turned over": interpolated,
}
figure, axes = plt.subplots(1, 3, figsize=(6.4, 2.3), layout="constrained")
for ax, (name, windows) in zip(axes, kinds.items(), strict=True):
    cd.plot.draw_window_labels(ax, windows)
    ax.contour(found.nucleus, [0.5], colors="black", linewidths=0.6)
    outer = windows.areas[0].sum() / windows.areas[:8].sum()
    ax.set_title(f"{name}\n{100 * outer:.0f} % of the cytoplasm in layer 0", fontsize=7)
