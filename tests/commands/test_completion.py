"""Shells are told of commands, options, words and files; how they complete them is the library's."""

import shutil
import subprocess

import pytest

from mcgw.cli import COMMANDS, main

BASH = [
    f"_shtab_mcgw_pos_0_choices=({' '.join(COMMANDS)})",
    "_shtab_mcgw_export___to_choices=(calculix abaqus moose comsol json)",
    *(f"_shtab_mcgw_run_{place}_COMPGEN=_shtab_compgen_files" for place in ("pos_0", "_o", "__output")),
]


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_shells_are_told_of_every_command_word_and_file(shell, capsys):
    assert main(["completion", shell]) == 0
    said = capsys.readouterr().out
    assert all(word in said for word in (*COMMANDS, "shard", "moose"))
    assert shell != "bash" or set(BASH) <= set(said.splitlines())
    if found := shutil.which(shell):
        assert subprocess.run([found, "-n"], input=said, text=True, check=False).returncode == 0


def test_without_the_library_one_line_says_so(missing, capsys):
    missing("shtab")
    assert main(["completion", "bash"]) == 2
    assert capsys.readouterr().err == (
        "mcgw: shtab is not installed: in a clone of mcgw, pip install -e '.[completion]'\n"
    )
