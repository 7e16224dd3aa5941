"""Versions of what results depend on."""

from importlib.metadata import PackageNotFoundError, version

NOT_INSTALLED = "not installed"
PACKAGES = (
    "cytodisk",
    "numpy",
    "scipy",
    "numba",
    "pythoncdt",
    "qdldl",
    "shapely",
    "scikit-image",
    "tifffile",
    "xarray",
    "zarr",
    "SimpleITK",
    "laptrack",
)

# Extras of the package, with what each one brings.
PARTS = {
    "report": ("jinja2",),
    "link": ("laptrack",),
    "demons": ("SimpleITK",),
    "umap": ("umap-learn",),
    "nd2": ("nd2",),
    "czi": ("czifile",),
    "lif": ("liffile",),
    "roi": ("roifile",),
    "anndata": ("anndata",),
    "spatialdata": ("spatialdata",),
    "cluster": ("distributed", "fsspec"),
}

# What the last bits of results may depend on.
NUMERIC = ("numpy", "scipy", "numba", "pythoncdt", "qdldl", "shapely", "scikit-image", "SimpleITK")


def installed(packages: tuple[str, ...] = PACKAGES) -> dict[str, str]:
    """Version of each package, `NOT_INSTALLED` where it is missing."""
    found = {}
    for name in packages:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = NOT_INSTALLED
    return found
