"""Settings of the documentation site; `build.py` calls Sphinx with them."""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path[:0] = [str(HERE)]

_cargo = tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))

project = "Mascarin"
author = "Mascarin contributors"
copyright = "Mascarin contributors"
version = release = _cargo["workspace"]["package"]["version"]

extensions = [
    "myst_nb",  # the Markdown pages and the notebooks
    "sphinx.ext.autodoc",
    "numpydoc",
    "sphinx_gallery.gen_gallery",
    "sphinx_copybutton",
    "sitepages.mathml",
]
source_suffix = {".md": "myst-nb", ".ipynb": "myst-nb", ".rst": "restructuredtext"}
exclude_patterns = ["gallery/*.md5", "gallery/*.ipynb", "gallery/*.py"]

# --- Markdown and notebooks -----------------------------------------------------------------------------
myst_enable_extensions = ["dollarmath", "colon_fence", "deflist", "attrs_block"]
myst_heading_anchors = 4  # as on a forge: links such as engine.md#the-first-step
nb_execution_mode = "force"
nb_execution_in_temp = True
nb_execution_raise_on_error = True
nb_execution_timeout = 120
nb_merge_streams = True

# --- Python -----------------------------------------------------------------------------------------------
autodoc_typehints = "none"  # the docstrings have the types
autodoc_member_order = "bysource"
numpydoc_show_class_members = False
python_use_unqualified_type_names = True
toc_object_entries_show_parents = "hide"

# --- Examples ---------------------------------------------------------------------------------------------
sphinx_gallery_conf = {
    "examples_dirs": [str(HERE / "gallery")],
    "gallery_dirs": ["gallery"],
    "filename_pattern": r"/plot_",
    "within_subsection_order": "FileNameSortKey",
    "abort_on_example_error": True,
    "download_all_examples": False,
    "remove_config_comments": True,
    "show_memory": False,
    "min_reported_time": 0,
    "image_scrapers": ("matplotlib",),
    "ignore_repr_types": r"matplotlib",  # the figure itself is shown
    "write_computation_times": False,
}
# Settings of the gallery are not written to the cache.
suppress_warnings = ["config.cache"]

# --- Pages ------------------------------------------------------------------------------------------------
html_theme = "pydata_sphinx_theme"
html_title = "Mascarin"
html_static_path = [str(HERE / "static")]
html_css_files = ["site.css"]
html_js_files = [("live.js", {"defer": "defer"})]
html_math_renderer = "mathml"
html_copy_source = False
html_show_sourcelink = False
html_theme_options = {
    "navbar_align": "left",
    "header_links_before_dropdown": 4,
    "show_prev_next": True,
    "show_toc_level": 2,
    "navigation_with_keys": False,
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": ["theme-version"],
}
copybutton_prompt_text = r"\$ "
copybutton_prompt_is_regexp = True
copybutton_only_copy_prompt_lines = True
pygments_style = "a11y-high-contrast-light"

# `make docs-links` asks the sites that the pages link to; publishers refuse programs that ask for a DOI.
linkcheck_ignore = [r"https://doi\.org/.*"]
linkcheck_timeout = 20
