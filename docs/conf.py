"""How the site is built: ``python -m sphinx -W -b html docs docs/_build``."""

import sys
import tomllib
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parent.parent
sys.path[:0] = [str(ROOT), str(Path(__file__).parent)]

import from_the_code  # noqa: E402 - these lie beside this file
import names_elsewhere  # noqa: E402
import search_words  # noqa: E402

project = "mcgw"
author = "The mcgw developers"
release = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]

extensions = [
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.intersphinx",
    "plain_math",
    "numpydoc",
    "myst_parser",
    "sphinx_copybutton",
    "sphinx_design",
    "sphinx_gallery.gen_gallery",
]
myst_enable_extensions = ["dollarmath", "amsmath", "colon_fence"]
myst_heading_anchors = 3
templates_path = ["_templates"]
default_role = "py:obj"
exclude_patterns = ["_build", "paper/**", "gallery/**/*.ipynb", "gallery/**/*.py"]
suppress_warnings = ["config.cache"]  # functions in the configuration of the gallery cannot be stored

autosummary_generate = True
autosummary_imported_members = False
autodoc_typehints = "none"  # numpydoc says the types in words
numpydoc_show_class_members = False

numpydoc_xref_param_type = True
numpydoc_xref_ignore = "all"
numpydoc_xref_aliases = names_elsewhere.ALIASES
intersphinx_mapping = names_elsewhere.mapping(Path(__file__).parent / "_build" / "inventories")
copybutton_prompt_text = r">>> |\.\.\. |\$ "
copybutton_prompt_is_regexp = True

html_math_renderer = "mathml"
html_theme = "pydata_sphinx_theme"
html_title = "mcgw"
html_theme_options = {
    "show_toc_level": 2,
    "navigation_with_keys": False,
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": [],
}
html_show_sourcelink = False
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_search_scorer = str(Path(__file__).parent / "search_scorer.js")
copyright = f"{author}; BSD-3-Clause"  # noqa: A001 - Sphinx calls it so


def one_style(_: dict[str, Any], __: str) -> None:
    """The pictures of the gallery look like those of the commands."""
    import matplotlib as mpl

    from mcgw.figures.style import STYLE

    mpl.rcParams.update(
        STYLE | {"axes.axisbelow": True, "figure.figsize": (6.4, 3.8), "figure.constrained_layout.use": True}
    )


sphinx_gallery_conf = {
    "examples_dirs": str(ROOT / "runs" / "gallery"),
    "gallery_dirs": "gallery",
    "filename_pattern": r"\.py$",
    "subsection_order": [
        f"../runs/gallery/{name}" for name in ("surfaces", "joints", "specimens", "materials")
    ],
    "backreferences_dir": "gallery/backreferences",
    "doc_module": ("mcgw", "analytic"),
    "reset_modules": ("matplotlib", one_style),
    "image_scrapers": ("matplotlib",),
    "matplotlib_animations": False,
    "capture_repr": (),
    "write_computation_times": False,
    "abort_on_example_error": True,
    "download_all_examples": False,
    "show_memory": False,
    "show_signature": False,
    "min_reported_time": 10,
    "remove_config_comments": True,
    "parallel": False,
}


def of_the_theory(app: Any, env: Any, node: Any, shown: Any) -> Any:
    """Names of `mcgw` that are those of `analytic` have their page there."""
    name = f"analytic.{node['reftarget'].removeprefix('mcgw.')}"
    python = env.domains["py"]
    if node.get("refdomain") != "py" or name not in python.objects:
        return None
    return python.resolve_xref(env, node["refdoc"], app.builder, "obj", name, node, shown)


def setup(app: Any) -> None:
    """Write the pages that the code itself tells before any page is read."""
    app.connect("config-inited", lambda *_: from_the_code.write(Path(__file__).parent))
    app.connect("source-read", search_words.add_words)
    app.connect("env-get-outdated", search_words.read_all)
    app.connect("missing-reference", of_the_theory)
