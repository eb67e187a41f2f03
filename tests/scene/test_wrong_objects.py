"""Another object or word than a call takes: one line that names it, and what makes the right one."""

import pytest

import mcgw
from mcgw.cli import main

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "0.1 mm^2", "78.6 GPa")
SCENE = mcgw.Scene(SURFACE, separations=[0.0, 1.0], n_surfaces=4, seed=1)
ENSEMBLE = mcgw.simulate(SCENE)
OF_SCENES = {
    "simulate": mcgw.simulate,
    "run": lambda scene: mcgw.run(scene, "never.h5"),
    "solve": lambda scene: mcgw.solve(scene, pressure=1e6),
    "sweep": lambda scene: mcgw.sweep(scene, {"grading.gamma": [1.0]}),
    "converge": mcgw.converge,
    "tradeoff": mcgw.tradeoff,
}
OF_ENSEMBLES = {
    "compare": mcgw.compare,
    "save": lambda e: mcgw.save(e, "never.h5"),
    "paired_ratio": lambda e: mcgw.paired_ratio(ENSEMBLE, e, "load"),
}


@pytest.mark.parametrize("call", OF_SCENES)
@pytest.mark.parametrize(
    ("given", "said"),
    [
        (SURFACE, r"not Surface; mcgw\.Scene\(surface, separations=\.\.\.\) makes one"),
        ("mine.toml", r"not str 'mine\.toml'; mcgw\.load_scene\(path\) reads one"),
        (ENSEMBLE, r"not Ensemble; that of an ensemble is its \.scene"),
        (3, "not int; "),
    ],
)
def test_who_takes_a_scene_says_how_to_get_one(call, given, said):
    with pytest.raises(TypeError, match=rf"^{call}: give a mcgw\.Scene, {said}"):
        OF_SCENES[call](given)


@pytest.mark.parametrize("call", OF_ENSEMBLES)
@pytest.mark.parametrize(
    ("given", "said"),
    [
        (SCENE, r"not Scene; mcgw\.simulate\(scene\) draws one"),
        ("file.h5", r"not str 'file\.h5'; mcgw\.open_ensemble\(path\) opens one"),
        (None, "not NoneType; "),
    ],
)
def test_who_takes_an_ensemble_says_how_to_get_one(call, given, said):
    with pytest.raises(TypeError, match=rf"^{call}: give a mcgw\.Ensemble, {said}"):
        OF_ENSEMBLES[call](given)


@pytest.mark.parametrize(("word", "meant"), [("pressures", "pressure"), ("loads", "load"), ("areas", "area")])
def test_solve_knows_what_was_meant(word, meant):
    with pytest.raises(TypeError, match=rf"^solve: there is no '{word}'; did you mean {meant}\?$"):
        mcgw.solve(SCENE, **{word: [1e6]})
    with pytest.raises(TypeError, match="a scene has no 'seperations'; did you mean separations"):
        mcgw.solve(SCENE, load=1.0, seperations=[1.0])


@pytest.fixture
def files(tmp_path, in_tmp_path):
    (tmp_path / "scene.toml").write_text(mcgw.scene_text(SCENE))
    (tmp_path / "latin.toml").write_bytes('title = "größer"\n'.encode("latin-1"))
    mcgw.save(ENSEMBLE, tmp_path / "mine.h5")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (
            "run mine.h5",
            "mine.h5: holds results, not a scene; print their scene with mcgw show --scene mine.h5",
        ),
        ("run latin.toml", "latin.toml: this is not TOML: not text in UTF-8 (byte 11)"),
        ("solve scene.toml --pressure -1MPa", "--pressure = '-1MPa': give a number > 0 with its unit, such"),
    ],
)
@pytest.mark.usefixtures("files")
def test_a_wrong_file_or_number_is_one_line(capsys, words, said):
    assert main(words.split()) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"mcgw: {said}")
