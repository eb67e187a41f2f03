"""Profiles as instruments write them: columns, headers, units, decimal commas, gaps, uneven steps."""

import re

import numpy as np
import pytest

import mcgw
from mcgw.maps.profile import Profile, profile_at
from mcgw.maps.profile_files import holds_profile, read_profile

Z = np.array([0.1, 0.3, -0.2, 0.5, 0.4, 0.0, -0.1, 0.2, 0.35, 0.15])
UM, MM = 1e-6, 1e-3


def lines(columns, separator, comma):
    rows = (separator.join(f"{v:g}" for v in row) for row in zip(*columns, strict=True))
    return [row.replace(".", ",") if comma else row for row in rows]


X = np.arange(10) * 0.5
BOTH, ALONE = (X, Z), (Z,)
ROWS = {  # name: text, ending, spacing given, spacing and unit of z expected in m
    "two columns, SI": (lines((X * UM, Z * UM), " ", False), ".txt", None, (0.5 * UM, UM)),
    "tabs, units in brackets": (["x [mm]\tz [um]", *lines(BOTH, "\t", False)], ".txt", None, (0.5 * MM, UM)),
    "decimal commas": (["X (µm);Z (nm)", *lines(BOTH, ";", True)], ".csv", None, (0.5 * UM, 1e-9)),
    "after a slash": (["Weg/mm;Hoehe/um", *lines(BOTH, ";", True)], ".asc", None, (0.5 * MM, UM)),
    "commas": (["x,z", "um,nm", *lines(BOTH, ",", False)], ".csv", None, (0.5 * UM, 1e-9)),
    "Gwyddion": (
        ["Profile 1", "x [m] y [m]", *lines((X * UM, Z * UM), "  ", False)], ".txt", None, (0.5 * UM, UM),
    ),
    "comments": (["# x in um; z in nm", *lines(BOTH, " ", False)], ".dat", None, (0.5 * UM, 1e-9)),
    "one unit for both": (["Units (um)", *lines(BOTH, ";", False)], ".txt", None, (0.5 * UM, UM)),
    "metadata": (
        ["Speed (mm/s): 0.5", "Length (mm): 4.8", "x (um);z (nm)", *lines(BOTH, ";", False)],
        ".txt", None, (0.5 * UM, 1e-9),
    ),
    "one column": (["z (um)", *lines(ALONE, "", False)], ".txt", 2 * UM, (2 * UM, UM)),
    "one column of commas": (["z (um)", *lines(ALONE, "", True)], ".txt", 2 * UM, (2 * UM, UM)),
    "a count for x": (["n z", *lines((np.arange(10), Z * UM), " ", False)], ".txt", 2 * UM, (2 * UM, UM)),
}  # fmt: skip


@pytest.mark.parametrize("name", ROWS)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_text_of_every_kind(name, encoding, tmp_path):
    text, ending, given, (spacing, unit) = ROWS[name]
    path = tmp_path / f"p{ending}"
    path.write_text("\n".join(text) + "\n", encoding=encoding)
    assert holds_profile(path)
    found = read_profile(path, spacing=given)
    assert found.spacing == pytest.approx(spacing, rel=1e-9)
    np.testing.assert_allclose(found.heights, Z * unit, rtol=1e-9, atol=1e-20)
    assert not found.filled
    assert not found.resampled


@pytest.mark.parametrize(
    ("text", "given", "told"),
    [
        ("1\n2\n3\n", {}, "has one column, of heights; give --pixel"),
        ("x (um);z (um)\n0;1\n1;2\n", {"spacing": 1e-6}, "tells x in um itself; leave --pixel out"),
        ("x (um);z (um)\n0;1\n1;2\n", {"unit": "nm"}, "heights are in um as the file says, not in nm"),
        ("0 1\n1 2\n2 1\n3 1\n1 2\n4 2\n5 2\n6 1\n7 1\n", {}, "x = 3 m is followed by 1 m"),
        ("\n".join(f"{i} {i % 2 * 1e-6}" for i in range(20)), {}, "the points are 1 m apart; give --unit"),
        ("\n".join(f"{i * 1e-6} {i % 2}" for i in range(20)), {}, "the usual slope is 1e\\+06; give --unit"),
        ("0 1\n1 2\n", {}, "2 points: a profile has 8 or more"),
        ("0 1\n1 2 3\n2 2\n", {}, "line 2 has 3 numbers, the first 2"),
        ("0 1\n1 2\nend\n", {}, "line 3: could not convert"),
        ("0 1 2\n1 2 3\n", {}, "3 numbers a line; a profile has z, or x and z"),
        ("x z\n", {}, "holds no numbers"),
        ("\n".join(f"{i} {'nan' if i % 3 else 1}" for i in range(30)), {}, "lacks 18 of its 28 heights"),
    ],
)
def test_what_is_no_profile_is_refused_in_one_line(text, given, told, tmp_path):
    path = tmp_path / "p.txt"
    path.write_text(text)
    with pytest.raises(ValueError, match=told) as error:
        read_profile(path, **given)
    assert "\n" not in str(error.value)
    assert "p.txt" in str(error.value)


def test_maps_are_no_profiles(tmp_path):
    (tmp_path / "m.txt").write_text("1 2 3\n4 5 6\n")
    np.save(tmp_path / "m.npy", np.zeros((3, 4)))
    np.save(tmp_path / "p.npy", np.arange(100.0) % 7 * UM)
    assert not holds_profile(tmp_path / "m.txt")
    assert not holds_profile(tmp_path / "m.npy")
    assert not holds_profile(tmp_path / "absent.txt")
    assert not holds_profile(tmp_path / "absent.xyz")
    assert holds_profile(tmp_path / "p.npy")
    assert read_profile(tmp_path / "p.npy", spacing=UM).heights[6] == 6 * UM
    with pytest.raises(ValueError, match="give --pixel"):
        read_profile(tmp_path / "p.npy")
    with pytest.raises(ValueError, match="no such file"):
        read_profile(tmp_path / "absent.txt")


def test_gaps_are_filled_and_uneven_places_resampled():
    """On a slope, which straight lines do not change."""
    x = np.arange(50.0)
    z = 3 * x + 1
    z[[0, 7, 8, 49]] = np.nan
    found = profile_at(x, z)
    np.testing.assert_allclose(found.heights, 3 * x[1:49] + 1, rtol=1e-14)
    assert (found.filled, found.resampled, found.spacing) == (2, False, 1.0)
    uneven = x + 0.3 * np.sin(x)
    found = profile_at(uneven, 3 * uneven + 1)
    np.testing.assert_allclose(np.diff(found.heights), 3 * found.spacing, rtol=1e-12)
    assert found.resampled
    assert not profile_at(x + 0.04 * np.sin(x), z).resampled  # rounded
    back = profile_at(-x, 3 * x + 1)
    np.testing.assert_array_equal(back.heights, (3 * x + 1)[::-1])
    with pytest.raises(ValueError, match="no heights"):
        profile_at(x, np.full(50, np.nan))


@pytest.mark.parametrize(
    ("heights", "spacing", "told"),
    [
        (np.zeros((3, 9)), 1.0, "not 2 dimensions"),
        (np.zeros(7), 1.0, "8 or more"),
        (np.full(9, np.nan), 1.0, "lacks points"),
        (np.zeros(9), 0.0, "give a length > 0 m"),
    ],
)
def test_no_such_profile(heights, spacing, told):
    with pytest.raises(ValueError, match=told):
        Profile(heights, spacing)


def test_profiles_that_surface_topography_reads(tmp_path):
    """Its own file of a line scan, even and uneven."""
    library = pytest.importorskip("SurfaceTopography")
    z = np.cumsum(np.random.default_rng(1).normal(size=3000)) * 1e-3
    z -= np.linspace(z[0], z[-1], 3000)
    library.UniformLineScan(z, 1.5, unit="mm").to_netcdf(str(tmp_path / "even.nc"))
    assert holds_profile(tmp_path / "even.nc")
    found = read_profile(tmp_path / "even.nc")
    np.testing.assert_allclose(found.heights, z * MM, rtol=1e-12)
    assert found.spacing == pytest.approx(0.5 * UM, rel=1e-9)
    with pytest.raises(ValueError, match="distance of its points itself"):
        read_profile(tmp_path / "even.nc", spacing=UM)
    fit = mcgw.fit(tmp_path / "even.nc", cutoff="10 um")
    assert fit.lengths == (pytest.approx(1.5 * MM),)


def test_lists_of_numbers_without_a_header_go_to_surface_topography(tmp_path):
    """An ending that is not read here: .xyz of two columns."""
    pytest.importorskip("SurfaceTopography")
    text = "\n".join(f"{i * 0.5e-6:.7e} {(i % 5) * 1e-7:.3e}" for i in range(60))
    (tmp_path / "p.xyz").write_text(text)
    assert holds_profile(tmp_path / "p.xyz")
    found = read_profile(tmp_path / "p.xyz")
    assert found.spacing == pytest.approx(0.5 * UM, rel=1e-6)
    assert re.fullmatch("m?", found.assumed_unit)


def test_whole_numbers_that_rise_before_a_comma_are_places(tmp_path):
    path = tmp_path / "p.csv"
    path.write_text("x (um),z (um)\n" + "\n".join(f"{i},{i % 3}" for i in range(9)))
    assert read_profile(path).heights.tolist() == [i % 3 * UM for i in range(9)]
    path.write_text("z (um)\n" + "\n".join(f"{i},0{i % 3}" for i in (0, 1, 1, 0, 2, 3, 1, 0)))
    np.testing.assert_allclose(read_profile(path, spacing=UM).heights[4:6] / UM, [2.02, 3.0], rtol=1e-12)
