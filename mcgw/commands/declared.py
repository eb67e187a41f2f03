"""A command from its function: parser, help, completion, reading, checks of outputs and exit code.

Parameters before ``*`` are typed by place, the others are options. Their types and defaults are those of the
signature, with kinds of `mcgw.commands.kinds`; the docstring has their words, in place of types what stands
for their values, and an example.
"""

import argparse
import re
from collections.abc import Callable, Sequence
from importlib import import_module
from inspect import cleandoc
from pathlib import Path
from typing import Any, NoReturn

import mcgw.commands
from mcgw.commands.kinds import Dry, In, Kind, OneOf, Out, SceneFile
from mcgw.commands.outputs import check_outputs, reading
from mcgw.commands.voice import add_amount_options, tell_cautions

_HELPERS = ("declared", "kinds", "options", "outputs", "voice")
_ORDER = (
    "init", "run", "sweep", "show", "compare", "converge", "tradeoff", "merge", "solve", "export", "figures",
    "report", "surface", "fit", "elastic", "warm", "completion",
)  # fmt: skip
Command = Callable[..., bool | None]
_NEGATIVE = re.compile(r"-\.?\d")  # a value that looks like an option, such as -1MPa
_SECTION = re.compile(r"\n\n(?:Parameters|Examples)\n-+\n")
_WORDS = re.compile(r"(\w+)(?: : (.+))?\n((?:    .+\n?)+)")


def all_commands() -> tuple[str, ...]:
    """Names of all commands: the files of this package, in the order of work."""
    names = {path.stem for folder in mcgw.commands.__path__ for path in Path(folder).glob("[a-z]*.py")}
    return (*(name for name in _ORDER if name in names), *sorted(names - {*_ORDER, *_HELPERS}))


COMMANDS = all_commands()


class Parser(argparse.ArgumentParser):
    """Errors are one line, without the usage, which has a dozen; with what a misspelt word may mean."""

    def error(self, message: str) -> NoReturn:
        """End the process with code 2."""
        from difflib import get_close_matches

        message = re.sub(r" \(choose from .{150,}", "", message)
        found = re.search(r"(?:invalid choice: '|unrecognized arguments: )([\w-]+)", message)
        near = get_close_matches(found[1], self.words(), 1) if found else []
        meant = f"; did you mean {near[0]}?" if near else ""
        self.exit(2, f"{self.prog}: error: {message}{meant}; see {self.prog} --help\n")

    def words(self) -> list[str]:
        """Options and words that may stand here or in its commands."""
        known = [*self._option_string_actions]
        for action in self._actions:
            known += map(str, action.choices or ())
            if isinstance(action.choices, dict):
                known += [word for one in action.choices.values() for word in one.words()]
        return known


class _Version(argparse.Action):
    """The action "version", looked up only when needed."""

    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> None:
        from importlib.metadata import PackageNotFoundError, version

        try:
            found = version("mcgw")
        except PackageNotFoundError:
            found = "unknown"
        print(f"mcgw {found}")
        parser.exit()


def parser_of(names: Sequence[str] = ()) -> argparse.ArgumentParser:
    """Return the parser of some commands, or all; only what these import is imported."""
    parser = Parser(
        prog="mcgw",
        description="Monte-Carlo simulation of rough contacts with graded elasticity. SI units; "
        "separations and heights in units of sigma.",
    )
    parser.add_argument("--version", action=_Version, nargs=0, help="show program's version number and exit")
    commands = parser.add_subparsers(metavar="COMMAND", required=True)
    for name in names or all_commands():
        function = getattr(import_module(f"mcgw.commands.{name}"), name)
        about, *sections = _SECTION.split(cleandoc(function.__doc__))
        about = f"{about[0].lower()}{' '.join(about.split())[1:]}"
        example = f"example: {sections[-1]}" if sections else None
        sub = commands.add_parser(
            name, help=about.partition(". ")[0].rstrip("."), description=about, epilog=example
        )
        sub._negative_number_matcher = _NEGATIVE
        _add_arguments(sub, function, sections[0] if sections[1:] else "")
        add_amount_options(sub)
        sub.set_defaults(function=function, command=name)
    return parser


def kinds_of(function: Command) -> dict[str, Kind]:
    """Return the kind of each parameter of a command."""
    found = {}
    for name, annotation in function.__annotations__.items():
        own = (x for x in getattr(annotation, "__metadata__", ()) if isinstance(x, Kind))
        found[name] = next(own, Kind())
    found.pop("return", None)
    return found


def _add_arguments(parser: argparse.ArgumentParser, function: Command, words: str) -> None:
    texts = {name: (metavar, " ".join(text.split())) for name, metavar, text in _WORDS.findall(words)}
    code, kinds = function.__code__, kinds_of(function)
    placed = code.co_varnames[: code.co_argcount]
    defaults = dict(zip(placed[::-1], (function.__defaults__ or ())[::-1], strict=False))
    defaults |= function.__kwdefaults__ or {}
    groups: dict[OneOf, Any] = {}
    for name, kind in kinds.items():
        annotation = function.__annotations__[name]
        to: Any = parser
        for group in getattr(annotation, "__metadata__", ()):
            if isinstance(group, OneOf):
                new = (
                    None if group in groups else parser.add_mutually_exclusive_group(required=group.required)
                )
                to = groups.setdefault(group, new)
        option = f"--{name.replace('_', '-')}"
        names = [name] if name in placed else ["-o", option] if name == "output" else [option]
        to.add_argument(
            *names,
            **_options(
                kind,
                annotation,
                name in placed,
                defaults.get(name, ...),
                *texts.get(name, (kind.metavar, kind.about)),
            ),
        )
    if any(isinstance(kind, SceneFile) for kind in kinds.values()):
        told = "change a key of the scene, such as grading.gamma=2 or contact.law=hertz; repeat for more keys"
        parser.add_argument("--set", action="append", metavar="KEY=VALUE", help=told)


def _options(
    kind: Kind, annotation: Any, placed: bool, default: Any, metavar: str, words: str
) -> dict[str, Any]:
    """Return what argparse takes for a parameter; the default is ... where it must be given."""
    annotation = (
        getattr(annotation, "__origin__", annotation) if hasattr(annotation, "__metadata__") else annotation
    )
    types = getattr(annotation, "__args__", (annotation,))
    several = next((x for x in (annotation, *types) if getattr(x, "__origin__", None) is list), None)
    words = f"{words}{kind.words}".removeprefix("; ").replace("%", "%%")
    if bool in types:
        return {"action": "store_true", "help": words}
    if default not in (..., None, "") and default != []:
        words += f"; default: {default}"
    must = default is ... and not (isinstance(kind, Out) and kind.beside)
    found: dict[str, Any] = {"help": words, "default": None if default is ... else default}
    if kind.file or kind.reads:
        found["type"] = Path if kind.file else str
    else:
        inner = several.__args__ if several else types
        found["type"] = next((x for x in (Path, int, float) if x in inner), str)
    found["metavar"] = metavar or None
    choices = kind.choices or types
    if str in map(type, choices):  # a Literal
        found |= {"choices": choices, "type": str}
    if kind.action:
        found["action"] = kind.action
    elif several and not isinstance(kind, Out):
        found["nargs"] = "*" if placed and not must else "+"
    elif placed and not must:
        found["nargs"] = "?"
    return found if placed else found | {"required": must}


def execute(function: Command, args: argparse.Namespace) -> int:
    """Read what a command reads, check what it writes, and call it; 1 if it says that something failed.

    Cautions of what it read are printed last.
    """
    kinds = kinds_of(function)
    typed = {name: getattr(args, name) for name in kinds}
    files = {name: typed[name] for name, kind in kinds.items() if isinstance(kind, In) and typed[name]}
    source = next((path for path in files.values() if isinstance(path, Path)), None)
    values, outputs = {}, []
    for name, kind in kinds.items():
        option = "-o" if name == "output" else f"--{name.replace('_', '-')}"
        if isinstance(kind, Out):
            values[name], some = kind.place(typed[name], option, source)
            outputs += some
        else:
            values[name] = kind.read(typed[name], option)
    grown = next((each.path for each in outputs if each.grows), None)
    inputs, cautious = [], []
    for name, path in files.items():
        kind = kinds[name]
        assert isinstance(kind, In)
        values[name], read = kind.open(path, args, grown)
        inputs += read
        cautious.append(kind.cautions(path, values[name]))
    dry = any(isinstance(kind, Dry) and typed[name] for name, kind in kinds.items())
    with reading(inputs):
        check_outputs([] if dry else outputs)
        done = function(**values)
    for each in filter(None, cautious):
        tell_cautions(*each)
    return int(done is False)
