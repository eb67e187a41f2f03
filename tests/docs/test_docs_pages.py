"""Pages of the site and documents: their code runs, all are reached, links and commands lead somewhere."""

import argparse
import doctest
import re
import shlex
from pathlib import Path

import h5py
import matplotlib.pyplot as plt
import numpy as np
import pytest
from oracles.docs_site import DOCS, ROOT, WRITTEN, blocks, file_name, pages
from oracles.scenes import scene_by

import mcgw
import mcgw.store
from mcgw.cli import COMMANDS, main, parser_of

LOOSE = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
NOTHING = ("show", "solve", "merge", "warm")  # is written in the folder
LONG = ("elastic", "figures", "tradeoff")  # a minute each; what they do has tests of its own
DOCUMENTS = ("README.md", "runs/README.md", "runs/ERRATA.md", "runs/LAWS.md", "runs/ROUGHNESS.md")
WITH_CODE = [name for name in WRITTEN if blocks((DOCS / name).read_text())]


@pytest.fixture(scope="module", autouse=True)
def _made():
    """Pages that are made from the code take a second; all tests share them."""
    pages()


def run_python(code, names, page):
    if ">>>" not in code:
        exec(compile(code, page, "exec"), names)
        return
    test = doctest.DocTestParser().get_doctest(code, names, page, None, 0)
    said = []
    failed, _ = doctest.DocTestRunner(optionflags=LOOSE).run(test, out=said.append, clear_globs=False)
    names.update(test.globs)
    assert not failed, "".join(said)


def run_commands(code, page):
    for line in code.replace("\\\n", " ").splitlines():
        words = shlex.split(line, comments=True)
        if words[:1] != ["mcgw"]:
            continue
        assert "-o" in words or words[1] in NOTHING, f"{page}: where does {line} write?"
        parser_of().parse_args(words[1:])
        if words[1] not in LONG:
            fewer = [re.sub(r"^(.+Pa:.+Pa):\d+$", r"\1:4", word) for word in words[1:]]
            assert main(fewer) == 0, f"{page}: {line}"


@pytest.mark.site
@pytest.mark.usefixtures("blank_figures")
@pytest.mark.parametrize("page", WITH_CODE)
def test_code_of_a_page_runs(page, tmp_path, in_tmp_path):
    """In its order, in an empty folder; a block whose first line names a file is that file.

    Ranges of pressures have four points, whatever the page asks for.
    """
    names = {"__name__": "page"}
    with np.printoptions():
        for kind, code in blocks((DOCS / page).read_text()):
            if name := file_name(code):
                Path(name).write_text(code.partition("\n")[2] if kind == "text" else code)
            if kind == "python":
                run_python(code, names, page)
            elif kind == "sh":
                run_commands(code, page)
    plt.close("all")


def test_wrong_numbers_of_a_page_would_be_seen():
    with pytest.raises(AssertionError, match="Expected"):
        run_python(">>> 1 + 1\n3\n", {}, "page")
    with pytest.raises(SystemExit):
        run_commands("mcgw run a.toml -o b.h5 --threat 3", "page")


def targets(page, text):
    """Places of the site and of the repository that a page links to."""
    for target in re.findall(r"\]\(([^)#:\s]+)(?:#[^)]*)?\)", text):
        yield page.parent.joinpath(target).resolve()


def test_links_lead_somewhere():
    texts = {DOCS / name: text for name, text in pages().items()}
    there = {page.resolve() for page in texts}
    texts |= {ROOT / name: (ROOT / name).read_text() for name in DOCUMENTS}
    for page, text in texts.items():
        for target in targets(page, text):
            made = (
                target.is_relative_to(DOCS / "gallery") or target.parent == DOCS / "reference" / "api"
            )  # by Sphinx
            assert made or target in there or target.is_file(), f"{page}: {target}"
    for name in re.findall(r"`((?:bench/)?[\w.-]+\.(?:toml|py|md))`", texts[ROOT / "runs/README.md"]):
        assert (ROOT / "runs" / name).is_file(), name


@pytest.fixture(scope="module")
def parsers():
    """The parser of each command, by its name."""
    (commands,) = (x for x in parser_of()._actions if isinstance(x, argparse._SubParsersAction))
    assert tuple(commands.choices) == tuple(COMMANDS)
    return commands.choices


def test_help_says_what_stands_for_what_is_left_out(parsers):
    """And where the output goes if nobody says."""
    for command, parser in parsers.items():
        for action in parser._actions:
            assert action.help, (command, action.dest)
            if action.option_strings and action.nargs != 0 and action.default is not None:
                said = re.search(r"default: (\S+( GPa)?)", action.help)
                assert said, f"{command} {action.dest}: {action.help}"
                assert said[1].rstrip(";,") == str(action.default), f"{command} {action.dest}"
        outputs = [x for x in parser._actions if "-o" in x.option_strings]
        prints = command in ("show", "solve", "warm", "completion")
        assert len(outputs) == (not prints and command != "merge")
        assert all(x.required or "default: " in x.help for x in outputs)


def test_the_example_of_a_command_is_one(parsers):
    for command, parser in parsers.items():
        lines = parser.epilog.removeprefix("example: ").split(" && ")
        assert lines[0].startswith(f"mcgw {command}")
        for line in lines:
            program, name, *words = shlex.split(line, comments=True)
            assert program == "mcgw"
            parsers[name].parse_args(words)


# --- README and CONTRIBUTING ------------------------------------------------------------------------------


def readme(kind):
    return [code for found, code in blocks((ROOT / "README.md").read_text()) if found == kind]


@pytest.mark.site
@pytest.mark.usefixtures("blank_figures")
def test_commands_of_the_readme_run_in_their_order(tmp_path, in_tmp_path, capsys):
    lines = [line for block in readme("sh") for line in block.splitlines() if line.startswith("mcgw ")]
    found = [shlex.split(line, comments=True)[1:] for line in lines]
    assert len(found) >= 6
    for words in found:
        if words[0] in LONG:
            continue
        fewer = ["--surfaces", "20"] if words[0] == "solve" else []
        assert main([*words, *fewer]) == 0, words
        if words[0] == "init":
            scene = Path("mine.toml")
            scene.write_text(scene.read_text().replace("n_surfaces = 1000", "n_surfaces = 100"))
    said = capsys.readouterr().out
    made = {path.name for path in tmp_path.iterdir()}
    assert {"mine.toml", "mine.h5", "mine.png", "mine.html"} <= made
    assert all(name in said for name in made)  # each command says where its file is


@pytest.mark.site
def test_the_whole_set_of_figures(tmp_path, capsys):
    assert main(["figures", "-v", "-o", str(tmp_path / "figures")]) == 0
    said = [x for x in capsys.readouterr().out.split() if x.endswith(".png")]
    assert len(said) == 6 + 3  # of the paper, and those it lacks
    assert {Path(path) for path in said} == set((tmp_path / "figures").iterdir())


def test_python_of_the_readme_runs(tmp_path, in_tmp_path):
    """With a tenth of its separations."""
    (code,) = readme("python")
    names = {}
    exec(compile(code.replace("0, 4, 41", "0, 4, 5"), "README.md", "exec"), names)
    plt.close("all")
    assert mcgw.open_ensemble("demo.h5").load.shape == names["e"].load.shape == (1000, 5)


# --- the file format ------------------------------------------------------------------------------------

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")


def test_every_dataset_and_attribute_is_described(tmp_path):
    """Of an ensemble, and of a sweep, where those of each quantity are as those of the load."""
    asked = {"quantities": ("load", "area", "stiffness", "contacts", "conductance")}
    scene = scene_by(
        SURFACE, separations=[0.0, 1.0], n_surfaces=3, seed=1, title="x", interaction="body", **asked
    )
    mcgw.run(scene, tmp_path / "a.h5")
    words = set(re.findall(r"\w+", mcgw.store.__doc__))
    with h5py.File(tmp_path / "a.h5") as file:
        found = set(file.attrs)
        file.visit(lambda name: found.update(name.split("/")))
        for name in ("load", "surface"):  # keys of HDF5 itself are in capitals
            found |= {key for key in file[name].attrs if key.islower()}
    assert {"load", "digest", "units"} <= found
    mcgw.sweep(scene.replace(interaction=None), {"grading.gamma": [0.5, 2.0]}, path=tmp_path / "s.h5")
    with h5py.File(tmp_path / "s.h5") as file:
        of_sweep = set(file.attrs) | set(file) | set(file["drawn"])
        assert file.attrs["filetype"] == b"mcgw-results"
    told = {name for name in of_sweep if name.startswith(tuple(f"{name}_" for name in scene.quantities))}
    assert {"load_mean", "load_std"} <= told
    assert (found | of_sweep) - told - words == set()
