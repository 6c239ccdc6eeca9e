"""How Sphinx builds these pages: ``make docs``."""

from importlib.metadata import version as version_of

project = "continuum-dyn"
author = "The continuum-dyn developers"
copyright = f"2026, {author}"  # noqa: A001
release = version = version_of(project)

extensions = [
    "myst_parser",
    "sphinx.ext.mathjax",
]

html_theme = "furo"
html_title = "continuum-dyn"
html_static_path = ["static"]
html_css_files = ["pages.css"]
html_theme_options = {
    "sidebar_hide_name": False,
    "light_css_variables": {"color-brand-primary": "#1f5a8a", "color-brand-content": "#1f5a8a"},
}
smartquotes = False
html_copy_source = False
html_show_sourcelink = False

myst_enable_extensions = ["dollarmath", "amsmath", "deflist", "colon_fence"]
myst_heading_anchors = 3
