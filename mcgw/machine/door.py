"""Public names of a package and where they come from; each is imported on first use.

Compiling and file formats cost a second, for which `mcgw --help` should not wait.
"""

import ast
from pathlib import Path


def homes_of_names(file: str) -> dict[str, str]:
    """Return names and modules by the stub beside a file, which type checkers read: it is the only list."""
    stub = ast.parse(Path(file).with_suffix(".pyi").read_text(encoding="utf-8"))
    imports = (each for each in stub.body if isinstance(each, ast.ImportFrom))
    return {name.name: str(each.module) for each in imports for name in each.names}
