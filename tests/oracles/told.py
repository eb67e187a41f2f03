"""What a result says, as lines of text with every number in it.

Long arrays stand as their shape, ends, extremes, mean, root mean square and a mean with uneven weights: a
number that moves, or changes its place, changes one of them.
"""

import dataclasses
import difflib
import inspect
import re
from collections.abc import Mapping
from enum import Enum
from pathlib import Path

import numpy as np
from matplotlib.ticker import FixedFormatter, FuncFormatter

ANSWERS = Path(__file__).parents[1] / "answers"
SHORT = 8  # numbers that stand one by one
WIDTH = 240  # characters within which parts stand beside one another
_NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?")


def number(value):
    """A number to ten digits, without the sign of a zero."""
    return f"{value + 0.0:.10g}" if isinstance(value, float | np.floating) else f"{value}"


def of_array(values):
    """An array as one line: its numbers if they are few, else what tells it from another."""
    a = np.asarray(values)
    if a.dtype.kind == "O":
        a = a.astype(float)
    if a.dtype.kind not in "fiub" or a.size <= SHORT:
        shape = "" if a.ndim < 2 else f"{a.shape} "
        return (
            shape
            + "["
            + ", ".join(number(x) if a.dtype.kind in "fiu" else repr(x) for x in a.ravel().tolist())
            + "]"
        )
    flat = a.astype(float).ravel()
    finite = np.isfinite(flat)
    x = np.where(finite, flat, 0.0)
    weights = 1 + np.arange(x.size) * 0.6180339887498949 % 1
    size = np.abs(x).max() or 1.0
    said = (x[0], x[-1], x.min(), x.max(), x.mean(), np.sqrt(np.mean(x * x)), weights @ x / x.size)
    rest = "" if finite.all() else f", {np.count_nonzero(~finite)} not finite"
    return f"{a.dtype.kind}{a.shape} " + " ".join(number(round(v / size, 10) * size) for v in said) + rest


def mark(values):
    """A series of numbers in four: how many, both ends, and a mean that moves with each."""
    x = np.asarray(values, dtype=float)
    if not x.size:
        return "none"
    weights = 1 + np.arange(x.size) * 0.6180339887498949 % 1
    said, size = (x[0], x[-1], weights @ x / x.size), np.abs(x).max() or 1.0
    return f"{x.size} {' '.join(f'{round(v / size, 10) * size + 0.0:.6g}' for v in said)}"


def drawn(figure):
    """What stands in a figure, or in that of an axis: words, ends, ticks, data and look of each part."""
    figure = figure.figure
    size = " x ".join(f"{x:.4g}" for x in figure.get_size_inches())
    yield f"figure: {figure.get_suptitle()!r} {figure.get_supxlabel()!r}, {size} inches"
    for one in filter(lambda text: text.get_text(), figure.texts):
        x, y = one.get_position()
        yield f" text at {x:.4g} {y:.4g}, {one.get_fontsize():g} pt: {one.get_text()[:20]!r}"
    for axis in figure.axes:
        words = axis.get_title(loc="left"), axis.get_title(), axis.get_xlabel(), axis.get_ylabel()
        yield f" axes: {' | '.join(words)}, at {' '.join(f'{x:.4g}' for x in axis.get_position().bounds)}"
        yield f"  x {_axis(axis.xaxis)}; y {_axis(axis.yaxis)}"
        legend = axis.get_legend()
        entries = legend.get_texts() if legend else ()
        sizes = sorted({t.get_fontsize() for t in (axis.title, axis.xaxis.label, axis.yaxis.label, *entries)})
        yield f"  legend: {[t.get_text() for t in entries] if legend else None}; {sizes} pt"
        yield from (f"  says {t.get_text()!r}" for t in axis.texts)
        for line in axis.get_lines():
            x, y = (np.asarray(v, dtype=float) for v in line.get_data())
            yield f"  line {line.get_label()!r} {_look(line)}: {of_array(x)}; {of_array(y)}"
        for one in axis.images:
            ends = " ".join(f"{x:.6g}" for x in (*one.get_extent(), *one.get_clim()))
            yield f"  image {one.get_cmap().name} {ends}: {of_array(np.ma.filled(one.get_array(), np.nan))}"
        corners = [p.get_patch_transform().transform(p.get_path().vertices) for p in axis.patches]
        if corners:
            yield f"  {len(corners)} patches {_colour(axis.patches[0])}: {_points(corners)}"
        for one in axis.collections:
            paths = [p.vertices for p in one.get_paths()]
            places = np.asarray(one.get_offsets(), dtype=float).reshape(-1, 2)
            shades = () if one.get_array() is None else (*one.get_clim(), *np.ravel(one.get_array()))
            yield f"  collection {_colour(one)} {mark(shades)}: {_points([places, *paths])}"


def _axis(axis):
    """Scale, ends and ticks, with the labels that are ours."""
    ends = sorted(axis.get_view_interval())
    ticks = [x for x in axis.get_majorticklocs() if ends[0] <= x <= ends[1]]
    ours = isinstance(axis.get_major_formatter(), FuncFormatter | FixedFormatter)
    labels = axis.get_major_formatter().format_ticks(ticks) if ours else [f"{x:.4g}" for x in ticks]
    return f"{axis.get_scale()} {ends[0]:.6g} to {ends[1]:.6g}: {', '.join(labels)}"


def _points(parts):
    """Places by x and y, each in numbers of its own size."""
    return "; ".join(map(of_array, np.concatenate(parts).T))


def _look(line):
    dash, mark = line.get_linestyle(), line.get_marker()
    return f"{line.get_color()} {dash} {line.get_linewidth():g} {mark} {line.get_markersize():g}"


def _colour(one):
    face = np.atleast_2d(one.get_facecolor())
    return " ".join(f"{x:.3g}" for x in face[0]) if face.size else "no face"


def fields_of(value):
    """Public fields of a dataclass or named tuple that hold something, by name; of anything else None."""
    if dataclasses.is_dataclass(value) and not inspect.isclass(value):
        names = [f.name for f in dataclasses.fields(value)]
    elif hasattr(value, "_fields"):
        names = value._fields
    else:
        return None
    held = ((name, getattr(value, name)) for name in names if not name.startswith("_"))
    return {name: part for name, part in held if part is not None}


def short(value, depth):
    """A value on one line."""
    match value:
        case None | bool() | str() | bytes() | Enum() | Path():
            return repr(value)
        case int() | float() | np.number():
            return number(value)
        case np.ndarray():
            return of_array(value)
        case Mapping():
            parts = (f"{key!r}: {short(part, depth - 1)}" for key, part in value.items())
            return "{" + ", ".join(parts) + "}"
        case list() | tuple() if not hasattr(value, "_fields"):
            if value and all(isinstance(x, int | float | np.number) for x in value):
                return of_array(value)
            return "(" + ", ".join(short(part, depth - 1) for part in value) + ")"
    parts = fields_of(value) if depth else None
    if parts is None:
        return f"a {type(value).__name__}"
    return f"{type(value).__name__}({', '.join(f'{k}={short(v, depth - 1)}' for k, v in parts.items())})"


def lines(value, name="", depth=6):
    """A value as one line if it fits, else its parts as lines below it."""
    text = short(value, depth)
    match value:
        case Mapping():
            parts = {f"{name}[{key!r}]": part for key, part in value.items()}
        case list() | tuple() if not hasattr(value, "_fields"):
            parts = {f"{name}[{i}]": part for i, part in enumerate(value)}
        case _:
            parts = {f"{name}.{key}": part for key, part in (fields_of(value) or {}).items()}
    if len(text) <= WIDTH or not parts:
        yield f"{name} = {text}"
        return
    yield f"{name}: {len(parts)} of a {type(value).__name__}"
    for key, part in parts.items():
        yield from lines(part, key, depth - 1)


def answers(thing, without=(), **arguments):
    """All that an object says of itself: fields, properties, methods whose arguments are known."""
    yield f"{type(thing).__name__}:"
    nothing = []
    for word in sorted(w for w in dir(thing) if not w.startswith("_") and w not in without):
        try:
            part = getattr(thing, word)
            if callable(part):
                needs = [
                    p.name
                    for p in inspect.signature(part).parameters.values()
                    if p.default is p.empty and p.kind is not p.VAR_KEYWORD
                ]
                if inspect.isclass(part) or not set(needs) <= set(arguments):
                    continue
                rows = [{}]
                for need in needs:
                    rows = [{**row, need: x} for row in rows for x in arguments[need]]
                for row in rows:
                    said = ", ".join(x if isinstance(x, str) else of_array(x) for x in row.values())
                    yield from answer(lambda part=part, row=row: part(*row.values()), f".{word}({said})")
            elif part is None:
                nothing.append(word)
            else:
                yield from lines(part, f".{word}")
        except (ValueError, KeyError) as error:
            yield f".{word} ! {type(error).__name__}: {error}"
    yield f"None: {', '.join(nothing)}"


def answer(ask, name):
    """What a call gives, or what its refusal says."""
    try:
        yield from lines(ask(), name)
    except (ValueError, KeyError) as error:
        yield f"{name} ! {type(error).__name__}: {error}"
    except (TypeError, RuntimeWarning):
        return  # it wants a number where it was given an array


def apart(old, new):
    """Lines in which two texts differ by more than the last digit of a number."""
    old, new = old.splitlines(), new.splitlines()
    if len(old) != len(new):
        return [*difflib.unified_diff(old, new, "recorded", "now", lineterm="", n=0)]
    return [f"- {a}\n+ {b}" for a, b in zip(old, new, strict=True) if a != b and not near(a, b)]


def near(a, b):
    """Whether lines say the same but for the last digits of their numbers.

    What is less than 1e-14 of the numbers before and after it is rounding, and so is all beyond ten digits.
    """
    if _NUMBER.sub("#", a) != _NUMBER.sub("#", b):
        return False
    old, new = _NUMBER.findall(a), _NUMBER.findall(b)
    sizes = [0.0, *(abs(float(x)) for x in old), 0.0]
    noise = [1e-14 * min(pair) for pair in zip(sizes, sizes[2:], strict=False)]
    return all(
        x == y
        or (
            ("." in x + y or len(x) >= 10)
            and abs(float(x) - float(y)) <= max(1.001 * step(x), 1e-7 * abs(float(x)), least)
        )
        for x, y, least in zip(old, new, noise, strict=True)
    )


def step(written):
    """One unit of the last digit that is written."""
    digits, _, power = written.lower().partition("e")
    return 10.0 ** (int(power or 0) - len(digits.partition(".")[2]))
