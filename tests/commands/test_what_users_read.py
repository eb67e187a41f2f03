"""All that users read, held to recorded text: what each command says, writes and draws, its help, its errors.

As `test_answers` holds results: `--record` writes `tests/answers/read.*.txt` anew, and its reader reads the
difference. What a clock, a disk or a version decides stands there as a #. Of the lines of figures, files and
helps each stands once in a record.
"""

import re
from collections import defaultdict
from html import unescape
from io import BytesIO

import numpy as np
import pytest
from matplotlib.figure import Figure
from oracles.overwrites import prepare
from oracles.said import call
from oracles.told import ANSWERS, drawn, of_array
from tables.scene_keys import keys, text_of

import mcgw
from mcgw.cli import COMMANDS

pytestmark = pytest.mark.usefixtures("one_pressure")

# Command lines in the order in which they find their inputs; y.toml is a scene that yields, there and back.
LINES = {
    "init": ["init demo -o new/i.toml", "init --help"],
    "run": ["run plain.toml -o new/r.h5", "run y.toml -o y.h5", "run y.toml -o y.h5 -v"],
    "sweep": ["sweep plain.toml --over grading.gamma=1.1,1.2 -v -o s.h5", "compare s.h5 -o s.png"],
    "show": ["show e.h5 --verify", "show y.h5", "show y.toml --plan", "show scene.toml --plan -v"],
    "compare": ["compare e.h5 -o c.png --csv new/c.csv -v", "compare y.h5 -o y.png"],
    "converge": ["converge plain.toml -o new"],
    "merge": ["merge e.h5"],
    "solve": ["solve plain.toml --load 1N --csv new/v.csv", "solve y.toml --pressure 2MPa -v"],
    "export": [f"export scene.toml --to {to} --points 4 -o new/x{to}{end}" for to, end in
               (("abaqus", ".inp"), ("calculix", ".inp"), ("comsol", ".txt"), ("moose", ".csv"))],
    "figures": ["figures --scene plain.toml --only equal-load -o new", "figures --list",
                "figures --scene y.toml --only figure-2 -o new --csv"],
    "report": ["report e.h5 -o new/r.html"],
    "surface": ["surface scene.toml --shape 16 -o new/m.h5"],
    "given": ["solve pressed.toml --load 1N -v",
              "solve plain.toml --area-fraction 1% 2% --scatter 1%", "solve spectral.toml --area 0.01mm^2"],
    "joints": ["run joint.toml -o j.h5", "show j.h5", "report j.h5 -o new/j.html",
               "solve joint.toml --pressure 500kPa 2MPa"],
    "tables": ["export joint.toml --to moose --table conductance-gap --points 3 -o new/g.csv",
               "export joint.toml --to calculix --table conductance-pressure --units mm-N-s -o new/p.inp "
               "--points 2",
               "export spectral.toml --to abaqus --points 3 --quantile 0.125 -o new/n.inp",
               "export pressed.toml --to moose --points 3 -o new/q.csv",
               "export joint.toml --to json --points 3 -o new/t.json"],
    "plans": [f"show --plan -v {name}.toml" for name in
              ("pressed", "measured", "crowd", "sticks", "spectral")],
    "pages": ["report y.h5 -o new/y.html", "report s.h5 -o new/s.html", "show s.h5 -v",
              "sweep plain.toml --over grading.gamma=0.5:2:4 --plan"],
    "laws": ["surface --from-spectrum rms=1um,long=20um,short=5um --pixel 1um --shape 32x16 -o new/f.h5"],
    "means": ["compare e.h5 --laws -o new/l.png -q"],
    "maps": ["surface caps.toml --shape 96 -o caps.npy",
             "fit caps.npy --cutoff none --parts 2 --tiles new/t.csv -v -o new/caps.toml",
             "fit p.txt --cutoff none --E-star 7GPa -v -o new/p.toml"],
    "fit": ["fit map.npy --cutoff none -o new/f.toml -v --picture new/f.png --summits new/s.csv"],
}  # fmt: skip
CLOCK = re.compile(
    r"\d[\d.,e+-]*(?: ?(?:ms|s|min|h|[kMG]i?B|bytes)\b| surfaces (?:a|per) second| times as fast)"
)
OTHER = re.compile(
    r"(?<![.\d])(?=\d*[a-f])[0-9a-f]{12,64}\b|(?<=^  (?:with|made) ).*|(?<=time at others: ).*"
    r"|(?<=mcgw )\d+\.\d[\w.+]*|\d{4}-\d\d-\d\d[T ][\d:.+Z-]*"
)
LONG, TABLE = 40, 12  # lines of a text or figures, and of a file of numbers, that stand one by one
TEXT = {".toml", ".csv", ".inp", ".txt", ".json"}
SURFACE = """surface = {sigma = 1.37e-6, radius = 13e-6, eta = 3e8, nominal_area = 1e-6, E_star = 78.6e9}
ensemble = {n_surfaces = 30, seed = 5, n_asperities = 300}
"""
SCENES = {
    "joint": """[contact]
separations = [0.0, 0.5, 1.0, 1.5]
[joint]
conductivities = [150.0, 16.0]
film_resistance = 1e-8
gas = "air"
rms = "2 um"
""",
    "caps": """contact = {separations = [1.0]}
""",
}


def steady(text):
    """Lines without what another machine or day says in another way."""
    for line in text.splitlines():
        if line.strip():
            yield OTHER.sub("#", CLOCK.sub("#", line)).rstrip()


def written(path):
    """What a file says, or for a long one its size and first lines."""
    if path.suffix == ".html":
        text = re.sub(r"<(style|svg|script).*?</\1>", "", path.read_text(), flags=re.DOTALL)
        told = list(steady(unescape(re.sub(r"\s*<[^>]*>\s*", "\n", text))))
    else:
        told = list(steady(path.read_text()))
    yield from (f"  {line}" for line in shortened(told, LONG if path.suffix == ".html" else TABLE))


def shortened(told, most=LONG):
    """The first lines of many, and all numbers in the others, small beside large, as one line."""
    if len(told) <= most:
        return told
    rest = [float(x) for x in re.findall(r"-?\d+\.?\d*(?:e[-+]\d+)?", "\n".join(told[most:]))]
    return [*told[:most], f"... {len(told) - most} lines: {of_array(np.arcsinh(1e12 * np.array(rest)))}"]


@pytest.fixture(scope="module")
def material(tmp_path_factory):
    folder = tmp_path_factory.mktemp("read")
    prepare(folder)
    (folder / "new").mkdir()
    for path in (ANSWERS / "scenes").glob("*.toml"):
        (folder / path.name).write_text(path.read_text())
    (folder / "yields.toml").rename(folder / "y.toml")
    for name, text in SCENES.items():
        (folder / f"{name}.toml").write_text(SURFACE + text)
    x = np.arange(400)
    z = sum(np.sin(x / k + k) for k in (2.3, 3.1, 5.7, 9.1))
    (folder / "p.txt").write_text(
        "x (um) z (nm)\n" + "".join(f"{a} {b:.6f}\n" for a, b in zip(x, 9 * z, strict=True))
    )
    call("run", "y.toml", "-o", "y.h5", "-q", cwd=folder)
    call("sweep", "plain.toml", "--over", "grading.gamma=1.1,1.2", "-q", "-o", "s.h5", cwd=folder)
    return folder


def pictured(figures):
    """The first lines of figures; of the others what the axes say, and all numbers as one line."""
    rest = figures[LONG:]
    said = [line for line in rest if not line.startswith("  ") or line.startswith("  says")]
    return [*figures[:LONG], *said, *shortened(rest, 0)] if rest else figures


def kept_in(figures):
    def keep(self, target, **_):
        figures.extend(drawn(self))
        if hasattr(target, "touch"):
            target.touch()
        else:
            target.write(b"" if isinstance(target, BytesIO) else "<svg></svg>")

    return keep


@pytest.mark.usefixtures("blank_figures")
@pytest.mark.parametrize("command", LINES)
def test_commands(command, material, recorded, monkeypatch):
    figures, told = [], []
    monkeypatch.setattr(Figure, "savefig", kept_in(figures))
    for words in LINES[command]:
        before = {path: path.stat().st_mtime_ns for path in material.rglob("*")}
        done = call(*words.split(), cwd=material)
        told += [f"$ mcgw {words}", f"code {done.returncode}", *shortened(list(steady(done.stdout)))]
        told += [f"! {line}" for line in steady(done.stderr)]
        told += [line for line in pictured(figures) if line not in told]
        figures.clear()
        for path in sorted(material.rglob("*")):
            if path.is_file() and before.get(path) != path.stat().st_mtime_ns:
                told.append(f"> {path.relative_to(material)}")
                lines = written(path) if path.suffix in {*TEXT, ".html"} else ()
                told += [line for line in lines if line not in told]
    recorded(f"read.{command}", told)


def test_helps(recorded, monkeypatch):
    monkeypatch.setenv("COLUMNS", "110")
    told = []
    for name in COMMANDS:
        told.append(f"== {name}")
        told += [line for line in call(name, "--help").stdout.splitlines() if line and line not in told]
    recorded("read.helps", told)


VALUES = ["'a word'", "''", "-1", "0", "2.5", "nan", "true", "[]", "[1, 'x']", "{}"]


def refusals():
    """Of each key, in the company that it goes with, the values that a line refuses, and those taken."""
    for table, key in keys():
        by_line = defaultdict(list)
        for written in VALUES:
            try:
                mcgw.scene_from(text_of(table, key, written))
                problems = ["taken"]
            except mcgw.SceneError as error:
                problems = error.problems
            for line in problems:
                by_line[re.sub(rf"{key} = .*?: ", f"{key} = ...: ", line, count=1)].append(written)
        yield from (f"{table}.{key} = {' '.join(values)} ! {line}" for line, values in by_line.items())


def test_errors_of_scenes(recorded):
    """Of each key, with values of every kind in turn: the lines of the refusal."""
    recorded("read.errors", refusals())
