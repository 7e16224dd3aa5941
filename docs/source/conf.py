"""Sphinx: what the documentation is made of. Nothing here needs the network."""

import sys
import warnings
from pathlib import Path
from typing import Any

import matplotlib as mpl
from numpydoc.xref import DEFAULT_LINKS

import cytodisk
from cytodisk.plot.style import PAPER

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "extensions"))

project = "cytodisk"
author = "the cytodisk contributors"
copyright = "the cytodisk contributors, BSD-3-Clause"
version = release = cytodisk.__version__

extensions = [
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "numpydoc",
    "matplotlib.sphinxext.plot_directive",
    "sphinx_gallery.gen_gallery",
    "changelog",
    "command_line",
    "mathml",
    "public_names",
    "parameter_tables",
    "table_columns",
]
templates_path = ["_templates"]
exclude_patterns = ["gallery/**/*.ipynb", "gallery/**/*.py", "paper_remeasured/**"]
default_role = "py:obj"
html_math_renderer = "mathml"
toc_object_entries = False
suppress_warnings = ["config.cache"]  # the functions of the gallery's settings cannot be pickled

# A docstring describes each attribute of a dataclass in its section "Attributes"; its members are the rest.
autosummary_generate = True
autodoc_typehints = "none"
autodoc_class_signature = "mixed"
numpydoc_show_class_members = False
numpydoc_attributes_as_param_list = True
numpydoc_xref_param_type = True
numpydoc_xref_ignore = "all"  # but for our own classes
DEFAULT_LINKS.clear()  # of other projects, whose lists of names are not at hand without a network
numpydoc_xref_aliases = {
    name: f"{module.__name__}.{name}"
    for module in (cytodisk, cytodisk.errors, cytodisk.simulate, cytodisk.plot, cytodisk.pages)
    for name in dir(module)
    if isinstance(getattr(module, name), type)
}

mpl.use("agg")
mpl.rcParams.update(PAPER)
LOOK = PAPER | {"figure.dpi": 120}
plot_rcparams = LOOK
plot_apply_rcparams = True
plot_formats = [("png", 200)]
plot_html_show_formats = False
plot_html_show_source_link = True


def _fresh_look(_config: dict[str, Any], _name: str) -> None:
    """Every example starts with the sizes of a printed page, and without warnings that are known."""
    mpl.rcParams.update(mpl.rcParamsDefault)
    mpl.rcParams.update(LOOK)
    warnings.simplefilter("ignore", DeprecationWarning)


sphinx_gallery_conf = {
    "examples_dirs": str(HERE.parent / "gallery"),
    "gallery_dirs": "gallery",
    "backreferences_dir": "gallery/backreferences",
    "doc_module": ("cytodisk",),
    "filename_pattern": r"\.py$",
    "within_subsection_order": "FileNameSortKey",
    "reset_modules": (_fresh_look,),
    "image_srcset": ["2x"],
    "thumbnail_size": (480, 300),
    "download_all_examples": False,
    "show_signature": False,
    "show_memory": False,
    "min_reported_time": 10_000,
    "write_computation_times": False,
    "remove_config_comments": True,
    "only_warn_on_example_error": False,
    "abort_on_example_error": False,
    "plot_gallery": True,
}

html_theme = "pydata_sphinx_theme"
html_title = "cytodisk"
html_static_path = ["_static"]
html_css_files = ["cytodisk.css"]
html_show_sourcelink = False
html_copy_source = False
html_theme_options = {
    "logo": {"text": "cytodisk", "image_light": "_static/logo.svg", "image_dark": "_static/logo.svg"},
    "navbar_align": "left",
    "header_links_before_dropdown": 7,
    "show_nav_level": 1,
    "navigation_depth": 3,
    "show_toc_level": 2,
    "show_prev_next": True,
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": [],
    "pygments_light_style": "a11y-high-contrast-light",
    "pygments_dark_style": "a11y-high-contrast-dark",
}
html_sidebars = {"index": [], "changelog": []}


def setup(app: Any) -> None:
    """Called by Sphinx."""
    app.connect("autodoc-process-docstring", _magnitudes, priority=900)
    app.connect("source-read", _remeasured_if_there)


def _remeasured_if_there(_app: Any, name: str, source: list[str]) -> None:
    """List "The paper, re-measured" once `docs/remeasure.py` has written it."""
    if name == "index" and not (HERE / "paper_remeasured.rst").exists():
        source[0] = source[0].replace("   paper_remeasured\n", "")


def _magnitudes(_app: Any, _what: str, _name: str, _it: Any, _options: Any, lines: list[str]) -> None:
    """Let bars around a magnitude, as in |lag|, be bars: reStructuredText would look for a substitution."""
    for number, line in enumerate(lines):
        if "``" not in line:
            lines[number] = line.replace("|", "\\|")
