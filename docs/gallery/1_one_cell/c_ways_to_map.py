"""
Harmonic map, equal areas, and between
======================================

The harmonic map keeps angles where it can, and so makes thin parts of a cell tiny on
the disk. The relaxation that follows gives every part its share of area.
"""

import matplotlib.pyplot as plt

import cytodisk as cd

mask = cd.simulate.star(arms=5)
harmonic = cd.map_to_disk(mask, method="harmonic")
newton = cd.map_to_disk(mask)

# %%
# Windows of equal area on the disk, carried into the cell by both maps: the harmonic
# map leaves the arms to the outermost windows; the equiareal one divides them fairly.
grid = cd.polar_windows(layers=8, sectors=40)
figure, axes = plt.subplots(2, 2, figsize=(6.2, 6), layout="constrained")
for column, (disk, name) in enumerate(((harmonic, "harmonic"), (newton, "newton"))):
    cd.plot.draw_area_distortion(axes[0, column], disk, limit=4)
    axes[0, column].set_title(f"{name}: area distortion {disk.distortion.area:.2f}")
    cd.plot.draw_windows(axes[1, column], grid.on(disk), by_layer=True)
    cd.plot.frame_cell(axes[1, column], disk)
    axes[1, column].set_title("its windows")
plt.show()

# %%
# The dial between them
# ---------------------
# ``shape_weight`` says how much shape counts against area. Towards 0 the map keeps
# areas, towards large values it keeps angles. Area distortion is best at 0, angle
# distortion at 1.
for weight in (0.0005, 0.005, 0.05, 0.5):
    found = cd.map_to_disk(mask, shape_weight=weight).distortion
    print(f"shape_weight {weight:<6}: area {found.area:.3f}, angle {found.angle:.2f}")
found = harmonic.distortion
print(f"harmonic            : area {found.area:.3f}, angle {found.angle:.2f}")
