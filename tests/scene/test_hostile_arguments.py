"""Values that are just not what they must be: each is refused in one line that says what would do."""

import json

import h5py
import numpy as np
import pytest
from hypothesis import assume, given, strategies as st
from oracles.inside import CSV, Output, check_outputs
from strategies import FEW, VALUES

import mcgw
from mcgw.maps import Topography, read_map, write_map

FLAT = Topography(1e-6 * np.arange(12.0).reshape(3, 4), (1e-6, 2e-6))


@pytest.mark.parametrize("given", ["load", "pressure", "area", "area_fraction"])
@pytest.mark.parametrize("value", [5e-324, 1e-200, 1e-15])
def test_loads_down_to_the_smallest_number_are_found_or_refused(make_scene, given, value):
    scene = make_scene(separations=(2.0,), n_surfaces=3)
    if value < 1e-20:
        with pytest.raises(ValueError, match=r"double precision of the heights; give .* or more"):
            mcgw.solve(scene, **{given: value})
        return
    found = mcgw.solve(scene, **{given: value})
    name = {"pressure": "load", "area_fraction": "area"}.get(given, given)
    assert found.surfaces[name] == pytest.approx(found.amount, rel=0.5)
    assert np.isfinite(list(found.value.values())).all()


RIGHT = {
    "pixel": lambda x: isinstance(x, list) and len(x) == 2 and not any(isinstance(v, bool | str) for v in x),
    "periodic": lambda x: isinstance(x, bool),
    "unit": lambda x: x in ("m", None),
}


@FEW
@given(key=st.sampled_from(list(RIGHT)), value=VALUES | st.none())
def test_a_sidecar_is_taken_at_its_word(key, value, tmp_path):
    assume(not RIGHT[key](value))
    write_map(FLAT, tmp_path / "m.npy")
    facts = json.loads((tmp_path / "m.json").read_text())
    (tmp_path / "m.json").write_text(json.dumps(facts | {key: value}))
    with pytest.raises(ValueError, match=rf"^[^\n]*{key} = [^\n]* must be [^\n]*$"):
        read_map(tmp_path / "m.npy")


@pytest.mark.parametrize(
    ("key", "value"), [("pixel", "12"), ("pixel", [1e-6]), ("pixel", [0.0, 1e-6]), ("periodic", "no")]
)
def test_so_is_an_hdf5_map(key, value, tmp_path):
    write_map(FLAT, tmp_path / "m.h5")
    with h5py.File(tmp_path / "m.h5", "r+") as file:
        file.attrs[key] = value
    with pytest.raises(ValueError, match=rf"{key} = .*(must be|give its size)"):
        read_map(tmp_path / "m.h5")


def test_a_folder_is_not_made_without_a_word(tmp_path, capsys):
    for _ in range(2):
        check_outputs([Output(tmp_path / "new" / "deeper" / "x.csv", CSV)])
    assert capsys.readouterr().err == f"mcgw: note: {tmp_path / 'new' / 'deeper'} is a new folder\n"
