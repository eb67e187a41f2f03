"""The picture of the packages on the page on architecture, made from the imports when the site is built."""

import ast
from pathlib import Path

ROOT = Path(__file__).parent.parent
WIDTH, HEIGHT, GAP, MARGIN = 132, 40, 30, 20  # px, of a box, between boxes, around the picture


def rooms() -> dict[str, list[Path]]:
    """Return the files of each package, by its name; those of the door itself are left out."""
    folders = [ROOT / "analytic", *(path.parent for path in (ROOT / "mcgw").glob("*/__init__.py"))]
    return {folder.name: sorted(folder.rglob("*.py")) for folder in folders}


def arrows() -> dict[str, set[str]]:
    """Return the packages that each package imports, wherever in its files that is."""
    found = {name: set[str]() for name in rooms()}
    for name, paths in rooms().items():
        for path in paths:
            for module in imported(ast.parse(path.read_text(encoding="utf-8"))):
                first, *rest = module.split(".")
                target = rest[0] if first == "mcgw" and rest else first
                if target in found and target != name:
                    found[name].add(target)
    return found


def imported(tree: ast.AST) -> list[str]:
    """Return the modules that a file imports by name."""
    nodes = list(ast.walk(tree))
    whole = [alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names]
    return whole + [node.module for node in nodes if isinstance(node, ast.ImportFrom) and node.module]


def levels(graph: dict[str, set[str]]) -> dict[str, int]:
    """Return the floor of each package: one above the highest that it imports."""
    floors: dict[str, int] = {}

    def floor(name: str) -> int:
        if name not in floors:
            floors[name] = 1 + max(map(floor, graph[name]), default=-1)
        return floors[name]

    for name in graph:
        floor(name)
    return floors


def needed(graph: dict[str, set[str]]) -> list[tuple[str, str]]:
    """Return the arrows that do not follow from others."""

    def below(name: str) -> set[str]:
        return graph[name].union(*(below(other) for other in graph[name]))

    return [
        (name, other)
        for name, others in sorted(graph.items())
        for other in sorted(others)
        if not any(other in below(between) for between in others - {other})
    ]


def svg() -> str:
    """Return the picture: a floor for each level, an arrow from what imports to what is imported."""
    graph = arrows()
    floors, at = levels(graph), {}
    top = max(floors.values())
    for level in range(top + 1):
        for k, name in enumerate(sorted(name for name in graph if floors[name] == level)):
            at[name] = (MARGIN + k * (WIDTH + GAP), MARGIN + (top - level) * (HEIGHT + GAP))
    parts = [line(at[name], at[other]) for name, other in needed(graph)]
    lines = {name: sum(len(p.read_text().splitlines()) for p in paths) for name, paths in rooms().items()}
    parts += [box(name, lines[name], *at[name]) for name in graph]
    width = max(x for x, _ in at.values()) + WIDTH + MARGIN
    height = MARGIN * 2 + (top + 1) * (HEIGHT + GAP) - GAP
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif">'
    marker = (
        '<defs><marker id="tip" viewBox="0 0 8 8" refX="8" refY="4" markerWidth="7" markerHeight="7"'
        ' orient="auto"><path d="M0 0 8 4 0 8z" fill="#666"/></marker></defs>'
    )
    return "\n".join([head, marker, *parts, "</svg>", ""])


def line(start: tuple[int, int], end: tuple[int, int]) -> str:
    """Return an arrow from the foot of one box to the head of another."""
    (x, y), (u, v) = start, end
    x, u, y = x + WIDTH // 2, u + WIDTH // 2, y + HEIGHT
    curve = f"M{x} {y}C{x} {y + GAP} {u} {v - GAP} {u} {v}"
    return f'<path d="{curve}" fill="none" stroke="#666" marker-end="url(#tip)"/>'


def box(name: str, lines: int, x: int, y: int) -> str:
    """Return the box of a package with its number of lines."""
    frame = (
        f'<rect x="{x}" y="{y}" width="{WIDTH}" height="{HEIGHT}" rx="5" fill="#dbe9f6" stroke="#004f8b"/>'
    )
    words = f'<text x="{x + WIDTH // 2}" y="{{}}" text-anchor="middle" font-size="{{}}">{{}}</text>'
    return frame + words.format(y + 18, 14, name) + words.format(y + 33, 10, f"{lines} lines")
