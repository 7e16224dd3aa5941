"""
Harmonic map, equal areas, and between
======================================

The harmonic map keeps angles where it can, and so makes thin parts of a cell tiny on
the disk. The relaxation that follows gives every part its share of area. The paper's
own relaxation, "advection", is there to compare with.
"""

import matplotlib.pyplot as plt

import cytodisk as cd

mask = cd.simulate.star(arms=5, body_radius=14, arm_length=24, arm_width=6)
methods = ("harmonic", "advection", "newton")
disks = {method: cd.map_to_disk(mask, method=method) for method in methods}

# %%
# Above, where a map makes parts of the cell too large (red) or too small (blue) on the
# disk. Below, windows of equal area on the disk, carried into the cell: the harmonic
# map leaves the arms to the outermost windows; the others divide them fairly.
grid = cd.polar_windows(layers=6, sectors=30)
figure, axes = plt.subplots(2, 3, figsize=(6.2, 4.2), layout="constrained")
for column, (method, disk) in enumerate(disks.items()):
    cd.plot.draw_area_distortion(axes[0, column], disk, limit=4)
    axes[0, column].set_title(method)
    cd.plot.draw_windows(axes[1, column], grid.on(disk), by_layer=True)
    cd.plot.frame_cell(axes[1, column], disk)
plt.show()

# %%
# How far they keep areas (0 is perfect), and whether they are one to one. Advection can
# turn triangles over; then its certificate is not valid and says which.
for method, disk in disks.items():
    flipped = len(disk.certificate.flipped_in_disk)
    print(
        f"{method:9s}: area distortion {disk.distortion.area:.3f}, "
        f"valid {disk.certificate.valid}, turned over {flipped}"
    )

# %%
# A dial between angles and areas
# -------------------------------
# ``shape_weight`` says how much shape counts against area. Towards 0 the map keeps
# areas, towards large values it keeps angles. Area distortion is best at 0, angle
# distortion at 1.
for weight in (0.0005, 0.005, 0.05, 0.5):
    found = cd.map_to_disk(mask, shape_weight=weight).distortion
    print(f"shape_weight {weight:<6}: area {found.area:.3f}, angle {found.angle:.2f}")
found = disks["harmonic"].distortion
print(f"harmonic            : area {found.area:.3f}, angle {found.angle:.2f}")
