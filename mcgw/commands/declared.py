"""A command from its function: parser, help, completion, checks of outputs and exit code.

Parameters before ``*`` are typed by place, the others are options. Their types and defaults are those of the
signature, with kinds of `mcgw.commands.kinds`. The docstring says what the command does, then has a line for
each parameter, with what stands for its value, as ``csv (FILE): also write the table``, and an example.
"""

import argparse
import re
from collections.abc import Callable, Iterator, Sequence
from importlib import import_module
from inspect import Parameter, cleandoc, signature
from pathlib import Path
from typing import Annotated, Any, NoReturn, get_args, get_origin

import mcgw.commands
from mcgw.commands.kinds import JUST_ONE, Call, Kind
from mcgw.commands.outputs import ALL, NEWS, QUIET, check_outputs, tell_cautions

_HOMES = {  # commands in the order of work, by the files in which they stand; any other has its own
    "init": "starting", "run": "drawing", "sweep": "drawing", "show": "answers", "compare": "views",
    "converge": "views", "tradeoff": "views", "merge": "drawing", "solve": "answers",
    "export": "views", "figures": "views", "report": "views", "surface": "maps", "fit": "maps",
    "elastic": "answers", "warm": "starting", "completion": "starting",
}  # fmt: skip
_OTHERS = {*_HOMES.values(), "declared", "kinds", "outputs"}
Command = Callable[..., bool | None]
_WORDS = re.compile(r"^(\w+)(?: \((.+?)\))?: (.+(?:\n    .+)*)", re.MULTILINE)  # of a parameter


def all_commands() -> tuple[str, ...]:
    """Names of all commands: those of this package, and of files that somebody added to it."""
    files = {path.stem for folder in mcgw.commands.__path__ for path in Path(folder).glob("[a-z]*.py")}
    return (*_HOMES, *sorted(files - _OTHERS))


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
        from importlib.metadata import version

        print(f"mcgw {version('mcgw')}")
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
        function = getattr(import_module(f"mcgw.commands.{_HOMES.get(name, name)}"), name)
        text, mark, example = cleandoc(function.__doc__).partition("\n\nexample: ")
        about = " ".join(_WORDS.sub("", text).split())
        about = f"{about[0].lower()}{about[1:]}"
        brief = about.partition(". ")[0].rstrip(".")
        sub = commands.add_parser(name, help=brief, description=about, epilog=(mark + example).strip())
        sub._negative_number_matcher = re.compile(r"-\.?\d")  # no option: a value such as -1MPa
        _add_arguments(sub, function, text)
        amount = sub.add_mutually_exclusive_group()
        for flags, const, told in (
            (("-q", "--quiet"), QUIET, "print only errors and requested output"),
            (("-v", "--verbose"), ALL, "print everything: tables, cautions in full, sources"),
        ):
            amount.add_argument(*flags, dest="amount", action="store_const", const=const, help=told)
        sub.set_defaults(function=function, command=name, amount=NEWS)
    return parser


def _kinds_of(function: Command) -> Iterator[tuple[Parameter, Kind, str, str | None]]:
    """Yield each parameter of a command, its kind, the option that sets it, and its group."""
    for each in signature(function).parameters.values():
        beside = getattr(each.annotation, "__metadata__", ())
        kind = next((x for x in beside if isinstance(x, Kind)), Kind())
        option = "-o" if each.name == "output" else f"--{each.name.replace('_', '-')}"
        yield each, kind, option, next((x for x in beside if isinstance(x, str)), None)


def _add_arguments(parser: argparse.ArgumentParser, function: Command, words: str) -> None:
    texts = {name: (metavar, " ".join(text.split())) for name, metavar, text in _WORDS.findall(words)}
    groups: dict[str | None, Any] = {None: parser}
    parts = [*_kinds_of(function)]
    for each, kind, option, group in parts:
        if group not in groups:
            groups[group] = parser.add_mutually_exclusive_group(required=group == JUST_ONE)
        placed = each.kind is Parameter.POSITIONAL_OR_KEYWORD
        names = [each.name] if placed else [option, "--output"] if option == "-o" else [option]
        found = _options(each, kind, placed, *texts.get(each.name, (kind.metavar, kind.about)))
        groups[group].add_argument(*names, **found)
    if any(kind.file == "scene" for _, kind, *_ in parts):
        told = "change a key of the scene, such as grading.gamma=2 or contact.law=hertz; repeat for more keys"
        parser.add_argument("--set", action="append", metavar="KEY=VALUE", help=told)


def _options(each: Parameter, kind: Kind, placed: bool, metavar: str, words: str) -> dict[str, Any]:
    """Return what argparse takes for a parameter."""
    types = [*_types_in(each.annotation)]
    words = f"{words}{kind.words}".removeprefix("; ").replace("%", "%%")
    if bool in types:
        return {"action": "store_true", "help": words}
    given = each.default is not Parameter.empty
    default = each.default if given else None
    if default not in (None, "", []):
        words += f"; default: {default}"
    choices = kind.choices or tuple(one for one in types if isinstance(one, str))  # of a Literal
    plain = next((one for one in (Path, int, float) if one in types), str)
    found: dict[str, Any] = {"help": words, "default": default, "metavar": metavar or None}
    found["type"] = Path if kind.file else str if choices or kind.read else plain
    if choices:
        found["choices"] = choices
    if dict in types:
        found["action"] = "append"
    elif list in types and kind.file != "out":
        found["nargs"] = "*" if placed and given else "+"
    elif placed and given:
        found["nargs"] = "?"
    return found if placed else found | {"required": not (given or kind.beside)}


def _types_in(annotation: Any) -> Iterator[Any]:
    """Yield all types of an annotation, and the words of its literals; not what stands beside it."""
    annotation = get_args(annotation)[0] if get_origin(annotation) is Annotated else annotation
    yield get_origin(annotation) or annotation
    for inner in get_args(annotation):
        yield from _types_in(inner)


def execute(function: Command, args: argparse.Namespace) -> int:
    """Read what a command reads, check what it writes, and call it; 1 if it says that something failed.

    Cautions of what it read are printed last.
    """
    parts = [*_kinds_of(function)]
    values = {each.name: getattr(args, each.name) for each, *_ in parts}
    files = (values[each.name] for each, kind, *_ in parts if kind.file in ("in", "scene"))
    call = Call(args, next((path for path in files if isinstance(path, Path)), None))
    parts.sort(key=lambda part: part[1].file != "out")  # a scene may take its seed from an output
    for each, kind, option, _ in parts:
        if kind.read:
            values[each.name] = kind.read(values[each.name], option, call)
    check_outputs(call.outputs, call.inputs)
    done = function(**values)
    for source, instead in call.cautious:
        tell_cautions(source, instead)
    return int(done is False)
