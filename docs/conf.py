"""How the documentation is built: `scripts/docs` makes `docs/_build/html` of it, strictly."""

from __future__ import annotations

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "extensions"))

from ribbonopt.version import VERSION  # noqa: E402

project = "ribbonopt"
author = "The ribbonopt developers"
copyright = author
version = release = VERSION

extensions = [
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "myst_parser",
    "sphinx_gallery.gen_gallery",
    "docstrings",
    "homes",
    "mathml",
    "linked",
    "generated",
]
exclude_patterns = ["_build", "results", "examples", "notebooks", "**/sg_execution_times.rst"]
nitpicky = True
# In signatures: what is not public, or of other packages. A public name that is not there fails.
nitpick_ignore_regex = [("py:(class|data|obj)", r"(?!ribbonopt\.\w+$).*")]
smartquotes = False  # `--out` is two hyphens
default_role = "literal"  # what docstrings put in backquotes

myst_enable_extensions = ["dollarmath", "colon_fence", "deflist"]
myst_heading_anchors = 4
suppress_warnings = ["config.cache"]

napoleon_google_docstring = False
napoleon_custom_sections = [("Attributes", "params_style")]  # types are words, no references
napoleon_use_param = False
napoleon_use_rtype = False
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
autodoc_member_order = "bysource"
autodoc_preserve_defaults = True
add_module_names = False

html_theme = "pydata_sphinx_theme"
html_title = f"ribbonopt {VERSION}"
html_static_path = ["static"]
html_css_files = ["house.css"]
html_show_sphinx = False
html_show_sourcelink = False
html_copy_source = False
html_theme_options = {
    "show_prev_next": False,
    "navigation_with_keys": False,
    "secondary_sidebar_items": ["page-toc"],
    "navbar_end": ["theme-switcher"],
    "footer_start": ["copyright"],
    "footer_end": [],
    "header_links_before_dropdown": 6,
}

sphinx_gallery_conf = {
    "examples_dirs": "examples",
    "gallery_dirs": "generated/examples",
    "filename_pattern": "/",
    "download_all_examples": False,
    "show_memory": False,
    "write_computation_times": False,
    "show_signature": False,
    "remove_config_comments": True,
    "min_reported_time": 60,
    "abort_on_example_error": True,
    "image_scrapers": ("shown.figures",),
    "ignore_repr_types": r"matplotlib\.figure|ribbonopt\.views",
    "reset_modules": ("matplotlib",),
}
