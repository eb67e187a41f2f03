"""Kinds of parameters of commands: what a person types for each, and what the command's function then gets.

A command is a function: see `mcgw.commands.declared`. A parameter of a plain type gets the text or number
that is typed; one that is ``Annotated[type, kind]`` what its kind makes of it. `OneOf` beside the kind puts
it into a group.
"""

from argparse import Namespace
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from mcgw.commands.outputs import CSV, Format, Output, figure_format

if TYPE_CHECKING:
    from mcgw.ensemble.ensemble import Ensemble
    from mcgw.scene.scene import Scene

_GEOMETRIC = ("Pa", "N")  # pressures and loads are at a constant ratio, all else evenly


@dataclass(frozen=True)
class Call:
    """What was typed, what is read first, all that is read and written, and cautions to end with."""

    args: Namespace
    source: Path | None
    inputs: list[Path] = field(default_factory=list)
    outputs: list[Output] = field(default_factory=list)
    cautious: list[tuple[Any, str]] = field(default_factory=list)


class OneOf:
    """Options of which one at most may be given, or just one."""

    def __init__(self, *, required: bool = False) -> None:
        self.required = required


class Kind:
    """A parameter that is passed on as typed.

    Parameters
    ----------
    metavar, about : str, optional
        What stands for its value, and what it is, where the docstring of the command has no words for it.
    """

    typed: type | None = None  # what argparse makes of a word, if it is not what is annotated
    action = ""  # of argparse, if it is not that of the type
    words = ""  # that the help adds
    choices: tuple[str, ...] = ()

    def __init__(self, metavar: str = "", about: str = "") -> None:
        self.metavar, self.about = metavar, about

    def read(self, given: Any, option: str, call: Call) -> Any:  # noqa: ARG002
        """Make the value of what was typed after an option, or of the default."""
        return given


class Dry(Kind):
    """A flag with which nothing is written."""

    def read(self, given: Any, option: str, call: Call) -> Any:  # noqa: ARG002
        """Forget what would be written."""
        if given:
            call.outputs.clear()
        return given


class Quantity(Kind):
    """A positive number with a unit, in the SI unit named."""

    typed = str

    def __init__(self, unit: str, metavar: str = "", about: str = "") -> None:
        super().__init__(metavar, about)
        self.unit = unit

    def read(self, given: Any, option: str, call: Call) -> Any:  # noqa: ARG002
        """Return the number; what is no text, as a default, is one already."""
        from mcgw.formats.units import parse

        return parse(given, self.unit, option) if isinstance(given, str) else given


class Values(Quantity):
    """Numbers with units, and ranges of them."""

    def __init__(self, unit: str) -> None:
        super().__init__(unit)
        how = "at a constant ratio" if unit in _GEOMETRIC else "at equal steps"
        self.words = f"; or A:B:N for N of them from A to B, {how}"

    def read(self, given: Any, option: str, call: Call) -> Any:
        """Return a list of SI numbers; without a unit, what is no range is left to the function."""
        found = []
        for text in given or ():
            if ":" in text:
                found += ranged(text, option, self.unit)
            else:
                found.append(super().read(text, option, call) if self.unit else text)
        return found or None


def ranged(text: str, option: str, unit: str = "") -> list[float]:
    """Return the N numbers from A to B of a text A:B:N; pressures and loads at a constant ratio.

    Parameters
    ----------
    text : str
        A and B are numbers with a unit, where one is given.
    option : str
        Name of the option, for messages.
    unit : str, optional
        SI unit of the numbers; default: plain numbers.

    Raises
    ------
    ValueError
        If it is none, N is not from 2 to 1e6, or a ratio would not be positive and rising.
    """
    import numpy as np

    from mcgw.formats.units import parse

    begin, _, rest = text.partition(":")
    end, _, number = rest.partition(":")
    if not number.isdigit() or not 2 <= int(number) <= 1e6:
        example = {"Pa": "10kPa:20MPa:30", "N": "1N:100N:30"}.get(unit, "0.2:2:10")
        raise ValueError(f"{option} {text}: give A:B:N, such as {example}, with N from 2 to 1e6")
    first, last = (parse(each, unit, option) if unit else float(each) for each in (begin, end))
    if unit in _GEOMETRIC and not 0 < first < last:
        raise ValueError(f"{option} {text}: give the lower one first, above 0")
    space = np.geomspace if unit in _GEOMETRIC else np.linspace
    return [float(x) for x in space(first, last, int(number))]


class In(Kind):
    """A file, or several, that is read, which no output may replace."""

    typed = Path

    def read(self, given: Any, option: str, call: Call) -> Any:  # noqa: ARG002
        """Return what the function gets."""
        return given and self.open(given, call)

    def open(self, path: Any, call: Call) -> Any:
        """Return what the function gets of a file that was given."""
        call.inputs.extend(path if isinstance(path, list) else [path])
        return path


class Results(In):
    """The file of an ensemble or, with `sweeps`, of a sweep, opened."""

    def __init__(self, *, sweeps: bool = True) -> None:
        super().__init__("FILE", f"file of an ensemble{' or of a sweep' * sweeps} (HDF5)")
        self.sweeps = sweeps

    def open(self, path: Any, call: Call) -> Any:
        """Return the ensemble or the sweep; the command ends with the cautions of its scenes."""
        from mcgw.store.ensembles import open_ensemble, open_results

        found = (open_results if self.sweeps else open_ensemble)(super().open(path, call))
        call.cautious.append((found, f"mcgw show {path}"))
        return found


class SceneFile(In):
    """The file of a scene, read, with the changes of --set.

    Parameters
    ----------
    others : bool, optional
        Whether it may be another file than TOML; of that the function gets the path.
    cautious : {"brief", "full", ""}, optional
        How the command ends: with the number of cautions, all of them, or none.
    """

    def __init__(self, *, others: bool = False, cautious: str = "brief") -> None:
        super().__init__("SCENE", "TOML file, SI units")
        self.others, self.cautious = others, cautious

    def open(self, path: Any, call: Call) -> Any:
        """Return the scene, with the seed of what an output holds where it gives none."""
        from mcgw.scene.scene_file import files_of, load_scene
        from mcgw.store.place import recorded_scene

        changes = call.args.set
        if self.others and path.suffix.lower() != ".toml":
            if changes:
                raise ValueError(f"--set {changes[0]}: {path} is no scene (.toml); give one")
            return super().open(path, call)
        grown = next((each.path for each in call.outputs if each.grows), None)
        seed = None if grown is None else lambda: getattr(recorded_scene(grown), "seed", None)
        scene = load_scene(path, changes=_changes(changes), seed=seed)
        call.inputs.extend(files_of(path))
        if self.cautious:
            call.cautious.append((scene, f"mcgw show --plan {path}" if self.cautious == "brief" else ""))
        return scene


def _changes(given: list[str] | None) -> dict[str, Any]:
    """Values of --set by key: TOML where they parse as TOML, otherwise text."""
    from mcgw.formats.named_files import loads

    changes: dict[str, Any] = {}
    for text in given or ():
        key, equals, value = (part.strip() for part in text.partition("="))
        if not (equals and key and value):
            raise ValueError(f"--set {text}: give KEY=VALUE, such as grading.gamma=2")
        try:
            changes[key] = loads(f"value = {value}")["value"]
        except ValueError:
            changes[key] = value
    return changes


class Out(Kind):
    """A file that is written: checked before anything is computed.

    Parameters
    ----------
    form : Format or None
        Its format; None: that of a figure.
    beside : str, optional
        Its default, with {} for the stem of what is read, in the folder of that.
    grows : bool, optional
        Whether the command makes ensembles, whose own rules say which may be replaced.
    """

    typed = Path

    def __init__(self, form: Format | None, beside: str = "", *, grows: bool = False) -> None:
        super().__init__("FILE", "also write the table to this file")
        self.form, self.beside, self.grows = form, beside, grows
        if beside:
            self.words = f"; default: {beside.format('NAME')} beside what is read"

    def read(self, given: Any, option: str, call: Call) -> Any:
        """Return the path."""
        if given is None and self.beside and call.source is not None:
            given = call.source.parent / self.beside.format(call.source.stem)
        if given:
            call.outputs.append(Output(given, self.form or figure_format(), option, self.grows))
        return given


class Folder(Out):
    """A folder for tables and figures of given names, with {} for the stem of what is read."""

    def __init__(self, *names: str) -> None:
        super().__init__(None, "out")
        self.names = names

    def read(self, given: Any, option: str, call: Call) -> Any:
        """Return the paths of all files."""
        assert call.source is not None
        folder = given or call.source.parent / "out"
        paths = [folder / name.format(call.source.stem) for name in self.names]
        forms = (CSV if path.suffix == ".csv" else figure_format() for path in paths)
        call.outputs.extend(Output(path, form, option) for path, form in zip(paths, forms, strict=True))
        return paths


SceneIn = Annotated["Scene", SceneFile()]
Cautioned = Annotated["Scene", SceneFile(cautious="")]  # by the command itself
SceneOrFile = Annotated["Scene | Path", SceneFile(others=True)]
SceneOrMap = Annotated["Scene | Path", SceneFile(others=True, cautious="")]
SceneOrResults = Annotated["Scene | Path", SceneFile(others=True, cautious="full")]
EnsembleOrSweep = Annotated["Ensemble", Results()]
EnsembleIn = Annotated["Ensemble", Results(sweeps=False)]
Table = Annotated[Path | None, Out(CSV)]
Length = Annotated[float | None, Quantity("m", "LENGTH")]
Pixel = Annotated[float | None, Quantity("m", "LENGTH", "size of a pixel, if the file does not give it")]
Unit = Annotated[
    str | None, Kind("UNIT", "unit of the heights, such as um, if the file does not give it; default: m")
]
