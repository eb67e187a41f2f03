"""Shells complete commands, options, words and files: bash itself is asked."""

import shutil
import subprocess
import sys

import pytest

from mcgw.cli import COMMANDS, main

BASH = shutil.which("bash")
pytestmark = pytest.mark.skipif(BASH is None, reason="needs bash")

# What bash does when Tab is pressed after these words.
ASK = """
source "$1"; shift
COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1))
"$(complete -p mcgw | sed 's/.*-F \\([^ ]*\\).*/\\1/')"
printf '%s\\n' "${COMPREPLY[@]}"
"""


@pytest.fixture(scope="module")
def script(tmp_path_factory):
    path = tmp_path_factory.mktemp("completion") / "mcgw.bash"
    with pytest.MonkeyPatch.context() as patch, path.open("w") as file:
        patch.setattr(sys, "stdout", file)
        assert main(["completion", "bash"]) == 0
    return path


@pytest.fixture
def tab(script, tmp_path):
    def ask(*words):
        done = subprocess.run(
            [BASH, "--norc", "-c", ASK, "bash", str(script), *words], capture_output=True, text=True,
            check=True, cwd=tmp_path,
        )  # fmt: skip
        assert not done.stderr
        return sorted(set(done.stdout.split()))

    return ask


TABS = [
    ("", sorted(COMMANDS)), ("co", ["compare", "completion", "converge"]), ("run --sh", ["--shard"]),
    ("export --to a", ["abaqus"]), ("init co", ["coating"]), ("run --no-such-", []),
    ("run mi", ["mine.toml"]),
    ("run mine.toml -o mi", ["mine.toml"]),
]  # fmt: skip


@pytest.mark.parametrize(("words", "found"), TABS)
def test_commands_options_words_and_files(tab, tmp_path, words, found):
    (tmp_path / "mine.toml").touch()
    assert tab("mcgw", *words.split(" ")) == found


@pytest.mark.parametrize("shell", ["zsh", "fish"])
def test_other_shells_are_told_of_every_command(shell, capsys):
    assert main(["completion", shell]) == 0
    said = capsys.readouterr().out
    assert all(name in said for name in COMMANDS)
    if found := shutil.which(shell):
        assert subprocess.run([found, "-n"], input=said, text=True, check=False).returncode == 0


def test_without_the_library_one_line_says_so(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "shtab", None)
    assert main(["completion", "bash"]) == 2
    assert capsys.readouterr().err == (
        "mcgw: shtab is not installed: in a clone of mcgw, pip install -e '.[completion]'\n"
    )
