"""Configuration of the documentation build."""

import sys
from pathlib import Path

import wearlaw

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[1])]

import rendering  # noqa: E402

project = "wearlaw"
author = "The wearlaw developers"
version = release = wearlaw.__version__
extensions = ["rendering", "myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.viewcode"]
extensions += ["sphinx.ext.intersphinx", "sphinx_copybutton"]
intersphinx_mapping = rendering.inventories()
copybutton_prompt_text = r">>> |\.\.\. |\$ "
copybutton_prompt_is_regexp = True
myst_enable_extensions = ["dollarmath", "colon_fence"]
myst_heading_anchors = 3
html_math_renderer = "mathml"
html_theme = "furo"
html_title = f"wearlaw {version}"
html_static_path = ["_static"]
html_css_files = ["wearlaw.css"]
exclude_patterns = ["_build", "examples"]
autodoc_typehints = "none"
autodoc_member_order = "bysource"
nitpicky = False
suppress_warnings = ["ref.python"]  # the word in a shape such as (tests,) is also the name of attributes
