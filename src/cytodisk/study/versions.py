"""Versions of what results depend on."""

from importlib.metadata import PackageNotFoundError, version

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

# What the last bits of results may depend on.
NUMERIC = ("numpy", "scipy", "numba", "pythoncdt", "qdldl", "shapely", "scikit-image", "SimpleITK")


def installed(packages: tuple[str, ...] = PACKAGES) -> dict[str, str]:
    """Version of each package, "not installed" where it is missing."""
    found = {}
    for name in packages:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = "not installed"
    return found
