"""Kinds of parameters of commands: what a person types for each, and what the command's function then gets.

A parameter of a plain type gets the text or number that is typed; one that is ``Annotated[type, kind]`` what
its kind makes of it. Of those with a text beside the kind one at most may be given, or just one.
"""

from argparse import Namespace
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from mcgw.commands.outputs import Output
from mcgw.formats.units import parse

if TYPE_CHECKING:
    from mcgw.scene.scene import Scene

AT_MOST_ONE, JUST_ONE = "at most one", "just one"


@dataclass(frozen=True)
class Call:
    """What was typed, what is read first, all that is read and written, and cautions to end with."""

    args: Namespace
    source: Path | None
    inputs: list[Path] = field(default_factory=list)
    outputs: list[Output] = field(default_factory=list)
    cautious: list[tuple[Any, str]] = field(default_factory=list)


@dataclass(frozen=True)
class Kind:
    """A parameter: how it is typed, and what the function gets of it."""

    metavar: str = ""  # what stands for its value, where the docstring of the command has no words for it
    about: str = ""  # what it is, likewise
    file: Literal["", "in", "scene", "out"] = ""  # a file that is read (of a scene: --set changes it) or made
    words: str = ""  # that the help adds
    choices: tuple[str, ...] = ()
    # Makes of the text that was typed (or the default), the option and the call what the function gets.
    read: Callable[[Any, str, Call], Any] | None = None
    beside: str = ""  # name of a file that is made, where none is given, beside what is read


def quantity(unit: str, metavar: str = "", about: str = "") -> Kind:
    """Return the kind of a positive number with a unit, in the SI unit named."""

    def read(given: Any, option: str, _call: Call) -> Any:
        return parse(given, unit, option) if isinstance(given, str) else given

    return Kind(metavar, about, read=read)


def values(unit: str) -> Kind:
    """Return the kind of numbers with units, and ranges of them; without a unit, others are left as typed."""

    def read(given: Any, option: str, _call: Call) -> Any:
        found: list[Any] = []
        for text in given or ():
            if ":" in text:
                found += ranged(text, option, unit)
            else:
                found.append(parse(text, unit, option) if unit else text)
        return found or None

    how = "at a constant ratio" if unit in _GEOMETRIC else "at equal steps"
    return Kind(words=f"; or A:B:N for N of them from A to B, {how}", read=read)


_GEOMETRIC = ("Pa", "N")  # pressures and loads are at a constant ratio, all else evenly


def ranged(text: str, option: str, unit: str = "") -> list[float]:
    """Return the N numbers from A to B of a text A:B:N, with a unit if one is given."""
    import numpy as np

    begin, end, number = [*text.split(":", 2), ""][:3]
    if not number.isdigit() or not 2 <= int(number) <= 1e6:
        example = {"Pa": "10kPa:20MPa:30", "N": "1N:100N:30"}.get(unit, "0.2:2:10")
        raise ValueError(f"{option} {text}: give A:B:N, such as {example}, with N from 2 to 1e6")
    first, last = (parse(each, unit, option) if unit else float(each) for each in (begin, end))
    if unit in _GEOMETRIC and not 0 < first < last:
        raise ValueError(f"{option} {text}: give the lower one first, above 0")
    space = np.geomspace if unit in _GEOMETRIC else np.linspace
    return [float(x) for x in space(first, last, int(number))]


def pair(text: str, option: str, form: str) -> tuple[str, str]:
    """Return the two sides of a text KEY=VALUE; `form` says how it should look."""
    key, equals, value = (part.strip() for part in text.partition("="))
    if not (equals and key and value):
        raise ValueError(f"{option} {text}: give {form}")
    return key, value


def as_value(text: str) -> Any:
    """Return what a text is as TOML, a number such as .5 or 5., or the text."""
    from mcgw.formats.named_files import loads

    with suppress(ValueError):
        return loads(f"value = {text}")["value"]
    with suppress(ValueError):
        return float(text) if "." in text else text
    return text


def _read(path: Any, call: Call) -> Any:
    """Let no output replace a file, or several."""
    call.inputs.extend(path if isinstance(path, list) else [path])
    return path


def file_in(metavar: str = "", about: str = "", opened: Callable[[Any, Call], Any] = _read) -> Kind:
    """Return the kind of a file that is read, which no output may replace; `opened` makes the value."""

    def read(given: Any, _option: str, call: Call) -> Any:
        return given and opened(given, call)

    return Kind(metavar, about, "in", read=read)


def _recorded_seed(path: Path) -> int | None:
    """Return the seed of the ensemble that grows, if there is one."""
    from mcgw.store.place import recorded_scene

    return getattr(recorded_scene(path), "seed", None)


def scene_file(*, others: bool = False, cautious: Literal["brief", "full", ""] = "brief") -> Kind:
    """Return the kind of the file of a scene, read, with the changes of --set.

    Of `others` than TOML, if they are taken, the function gets the path. The command ends with the number of
    cautions, all of them, or none.
    """

    def opened(path: Path, call: Call) -> Any:
        from mcgw.scene.scene_file import files_of, load_scene

        changes = call.args.set
        if others and path.suffix.lower() != ".toml":
            if changes:
                raise ValueError(f"--set {changes[0]}: {path} is no scene (.toml); give one")
            return _read(path, call)
        pairs = (pair(text, "--set", "KEY=VALUE, such as grading.gamma=2") for text in changes or ())
        changed = {key: as_value(value) for key, value in pairs}
        seed = next((partial(_recorded_seed, each.path) for each in call.outputs if each.grows), None)
        scene = load_scene(path, changes=changed, seed=seed)
        call.inputs.extend(files_of(path))
        if cautious:
            call.cautious.append((scene, f"mcgw show --plan {path}" if cautious == "brief" else ""))
        return scene

    return replace(file_in("SCENE", "TOML file, SI units", opened), file="scene")


def file_out(
    what: str, beside: str = "", *, names: tuple[str, ...] = (), grows: bool = False, dry: str = ""
) -> Kind:
    """Return the kind of a file that is written: checked before anything is computed.

    Its default is `beside` what is read, with {} for the stem of that. With `names` it is a folder, and the
    function gets the paths of these files in it, named likewise. What `grows` are ensembles, whose own rules
    say which may be replaced. With the flag `dry` nothing is written.
    """

    def read(given: Any, option: str, call: Call) -> Any:
        stem = call.source.stem if call.source else ""
        if given is None and beside and call.source:
            given = call.source.parent / beside.format(stem)
        paths = [given / name.format(stem) for name in names] or [given] * bool(given)
        if not (dry and getattr(call.args, dry)):
            call.outputs.extend(Output(path, what, option, grows) for path in paths)
        return paths if names else given

    words = f"; default: {beside.format('NAME')} beside what is read" if beside else ""
    return Kind("FILE", "also write the table to this file", "out", words, read=read, beside=beside)


SceneIn = Annotated["Scene", scene_file()]
Cautioned = Annotated["Scene", scene_file(cautious="")]  # by the command itself
MaybeScene = Annotated["Scene | None", scene_file(cautious="")]
SceneOrFile = Annotated["Scene | Path", scene_file(others=True)]
SceneOrMap = Annotated["Scene | Path", scene_file(others=True, cautious="")]
SceneOrResults = Annotated["Scene | Path", scene_file(others=True, cautious="full")]
Table = Annotated[Path | None, file_out("a table")]
Length = Annotated[float | None, quantity("m", "LENGTH")]
Pixel = Annotated[float | None, quantity("m", "LENGTH", "size of a pixel, if the file does not give it")]
Unit = Annotated[
    str | None, Kind("UNIT", "unit of the heights, such as um, if the file does not give it; default: m")
]
Threads = Annotated[int | None, Kind("N", "number of threads; default: all cores; does not change results")]
Jobs = Annotated[int | None, Kind("N", "use N processes instead"), AT_MOST_ONE]
Dask = Annotated[
    str | None, Kind("ADDRESS", "use the workers of a dask scheduler, tcp:// or tls://"), AT_MOST_ONE
]
Share = Annotated[
    str | None, Kind("I/N", "draw the I-th of N shares, as one job of an array; then mcgw merge"), AT_MOST_ONE
]
