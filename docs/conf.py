"""Configuration of the manual (`make docs`). The build needs no network and runs all code of the pages."""

import sys
from pathlib import Path

import rocking

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE / "_ext"), str(HERE.parent)]  # the second for benchmarks

project = "rocking"
author = "The rocking developers"
copyright = "the rocking developers, BSD-3-Clause"
release = version = rocking.__version__

extensions = [
    "myst_nb",
    "numpydoc",
    "sphinx.ext.autodoc",
    "sphinx_copybutton",
    "sphinx_gallery.gen_gallery",
    "gallery_pictures",
    "mathml",
    "equations",
    "commands",
    "tables",
    "reference",
    "section_search",
    "notebooks",
    "scripts_as_files",
    "verified",
]
exclude_patterns = ["gallery/**.py", "gallery/**.ipynb", "gallery/**.zip", "**/README.md", "_ext"]
nitpicky = False

smartquotes = False  # options such as --set must stay as they are typed
html_theme = "furo"
html_title = f"rocking {release}"
html_static_path = ["_static"]
templates_path = ["_templates"]
html_favicon = "../workbench/src/rocking_workbench/static/style/icon.svg"
html_css_files = ["manual.css"]
html_copy_source = False
html_show_sphinx = False
html_math_renderer = "mathml"
html_theme_options = {"navigation_with_keys": True}

# Pages with {code-cell}s are notebooks: they run during the build and can be downloaded.
nb_execution_mode = "cache"
nb_execution_cache_path = str(HERE.parent / "build" / "notebooks")
nb_execution_in_temp = True
nb_execution_raise_on_error = True
nb_execution_timeout = 1200  # only a guard against hanging
nb_merge_streams = True
nb_render_markdown_format = "myst"  # results in Markdown contain tables
myst_enable_extensions = ["dollarmath", "colon_fence", "deflist", "attrs_inline"]
myst_heading_anchors = 3
myst_dmath_double_inline = True

default_role = "code"
autodoc_member_order = "bysource"
autodoc_typehints = "none"  # the sections of numpydoc contain them
numpydoc_show_class_members = False
numpydoc_xref_param_type = False

sphinx_gallery_conf = {
    "examples_dirs": str(HERE.parent / "build" / "examples"),  # a copy, into which the scripts write
    "gallery_dirs": "gallery",
    "filename_pattern": r"\.py$",
    "subsection_order": "gallery_pictures.section_order",
    "within_subsection_order": "gallery_pictures.script_order",
    "image_scrapers": ("gallery_pictures.scraper",),
    "capture_repr": (),
    "download_all_examples": False,
    "abort_on_example_error": True,
    "remove_config_comments": True,
    "show_memory": False,
    "write_computation_times": False,
    "show_signature": False,
    "min_reported_time": 10**6,
}
