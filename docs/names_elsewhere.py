"""Names of other projects that pages link to, as inventories of intersphinx: no build needs a net."""

import zlib
from pathlib import Path

PLACES = {
    "numpy": ("https://numpy.org/doc/stable", {
        "numpy.ndarray": "py:class 1 reference/generated/numpy.ndarray.html",
        "numpy.random.Generator": "py:class 1 reference/random/generator.html",
        "array_like": "std:term 1 glossary.html#term-array_like",
    }),
    "scipy": ("https://docs.scipy.org/doc/scipy", {
        "scipy.stats.rv_continuous": "py:class 1 reference/generated/scipy.stats.rv_continuous.html",
    }),
    "xarray": ("https://docs.xarray.dev/en/stable", {
        "xarray.Dataset": "py:class 1 generated/xarray.Dataset.html",
    }),
    "pandas": ("https://pandas.pydata.org/docs", {
        "pandas.DataFrame": "py:class 1 reference/api/pandas.DataFrame.html",
    }),
    "python": ("https://docs.python.org/3", {
        "pathlib.Path": "py:class 1 library/pathlib.html#pathlib.Path",
        **dict.fromkeys(("str", "tuple", "list", "dict"), "py:class 1 library/stdtypes.html#$"),
        **dict.fromkeys(("float", "int"), "py:class 1 library/functions.html#$"),
        **dict.fromkeys(("None", "True", "False"), "py:data 1 library/constants.html#$"),
        **dict.fromkeys(("iterable", "sequence", "generator"), "std:term 1 glossary.html#term-$"),
        "callable": "py:function 1 library/functions.html#callable",
        "bltin-boolean-values": "std:label 1 library/stdtypes.html#boolean-type-bool",
    }),
}  # fmt: skip

# What docstrings call them.
ALIASES = {
    "ndarray": "numpy.ndarray",
    "array_like": ":term:`numpy:array_like`",
    "Generator": "numpy.random.Generator",
    "rv_continuous": "scipy.stats.rv_continuous",
    "Dataset": "xarray.Dataset",
    "DataFrame": "pandas.DataFrame",
    "Path": "pathlib.Path",
}


def mapping(folder: Path) -> dict[str, tuple[str, str]]:
    """Write the inventories, and say where they are."""
    folder.mkdir(parents=True, exist_ok=True)
    found = {}
    for project, (address, names) in PLACES.items():
        head = f"# Sphinx inventory version 2\n# Project: {project}\n# Version: \n# compressed using zlib\n"
        lines = "".join(f"{name} {rest} -\n" for name, rest in names.items())
        path = folder / f"{project}.inv"
        path.write_bytes(head.encode() + zlib.compress(lines.encode()))
        found[project] = (address, str(path))
    return found
