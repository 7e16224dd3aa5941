import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

import cytodisk as cd

disk = cd.map_to_disk(cd.simulate.random_smooth(seed=1, radius=14))
broken = disk.vertices_uv.copy()
inner = np.setdiff1d(np.arange(len(broken)), disk.boundary)
vertex = inner[np.hypot(*broken[inner].T).argmin()]
broken[vertex] += (0.3, 0.1)
figure, axes = plt.subplots(1, 2, figsize=(5.6, 3), layout="constrained")
for ax, uv in zip(axes, (disk.vertices_uv, broken), strict=True):
    certificate = cd.certify(disk.vertices_yx, uv, disk.triangles, disk.boundary)
    flipped = uv[disk.triangles[list(certificate.flipped_in_disk)]]
    ax.triplot(*uv.T, disk.triangles, color="0.4", linewidth=0.3)
    ax.add_collection(PolyCollection(flipped, facecolor="#D55E00", alpha=0.7))
    faults = certificate.faults[0] if certificate.faults else "every condition holds"
    ax.set_title(f"valid: {certificate.valid}\n{faults}")
    ax.set_aspect("equal")
    ax.invert_yaxis()
    ax.axis("off")
