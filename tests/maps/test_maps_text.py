"""Text as instruments and spreadsheets of any country write it; and in which unit its heights are."""

import numpy as np
import pytest

from mcgw.maps import Profile, Topography, read_heights, read_map
from mcgw.maps.text_file import table_of

NAN = np.nan
PIXEL = (1e-6, 1e-6)


def read(tmp_path, content, encoding="utf-8"):
    path = tmp_path / "map.csv"
    path.write_bytes(content.encode(encoding))
    return table_of(path)[1]


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        ("1.5,2.5\n3,4\n", [[1.5, 2.5], [3, 4]]),
        ("1,2,3\n", [[1, 2, 3]]),  # nothing else parts the numbers
        ("1,5\n2,5\n", [[1, 5], [2, 5]]),
        ("1.5 2.5\n  3   4\n", [[1.5, 2.5], [3, 4]]),
        ("1.5\t2.5\r\n3\t4\r\n", [[1.5, 2.5], [3, 4]]),
        ("1,23;4,56\n7;8,5\n", [[1.23, 4.56], [7, 8.5]]),
        ("1,2; 3,4\n", [[1.2, 3.4]]),
        ("1,23\t4,56\n7\t8\n", [[1.23, 4.56], [7, 8]]),
        ("-1,23 +4,56\n7 8,\n", [[-1.23, 4.56], [7, 8]]),
        ("1,5e-6;2,5E+06\n", [[1.5e-6, 2.5e6]]),
        ("1;2\t3 4\n", [[1, 2, 3, 4]]),
        ("1,,3\n4,5,6\n", [[1, NAN, 3], [4, 5, 6]]),
        ("1,5;;3\n4;5;6\n", [[1.5, NAN, 3], [4, 5, 6]]),
        ("\t2\t3\n4\t5\t\n", [[NAN, 2, 3], [4, 5, NAN]]),
        ("1\t2\n\t\n3\t4\n", [[1, 2], [NAN, NAN], [3, 4]]),
        ("1;nan;BAD\n---;5,5;6\n", [[1, NAN, NAN], [NAN, 5.5, 6]]),
        ("1;2;\n3;4;\n", [[1, 2], [3, 4]]),  # every line ends with a separator
        (";1;2\n;3;4\n", [[1, 2], [3, 4]]),
        ("1;2;\n3;4;5\n", [[1, 2, NAN], [3, 4, 5]]),
        ("0;0.5\n", [[0, 0.5]]),
        ("# nm, as measured\n\n1 2\n", [[1, 2]]),
    ],
)
def test_numbers_of_every_country(content, expected, tmp_path):
    found = read(tmp_path, content)
    assert found.shape == np.shape(expected)
    assert np.array_equal(found, expected, equal_nan=True)


@pytest.mark.parametrize(("content", "told"), [
    ("1,2, 3,4\n", "inside and between numbers"),
    ("1,2, 3,4 5\n0 0 1\n1 0 2\n0 1 3\n1 1 4\n", "inside and between numbers"),  # no header of points
    ("1,2,3;4,5,6\n", "by commas and by something else"),
    ("1.234,5;6,5\n", "inside and between numbers|something else"),
    ("0,0012,0,0013\n", "begins with 0"),
    ('"1,5","2,5"\n', "line 1: could not convert"),
    ("1,5;2\n3;4;5\n", "line 2 has 3 numbers, the first row 2"),
    ("1 inf\n", "infinite"),
    ("# nothing\n", "holds no numbers"),
    ("1" * 2**24, r"map\.csv: line 1 has 16777216 characters or more; is it a map\?"),
], ids=lambda x: x[:20])  # fmt: skip
def test_what_may_mean_two_things_is_refused_in_one_line(content, told, tmp_path):
    (tmp_path / "map.csv").write_text(content)
    with pytest.raises(ValueError, match=told) as error:
        read_map(tmp_path / "map.csv", pixel=(1.0, 1.0))
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16-le", "utf-16-be"])
def test_marks_of_the_encoding_are_no_numbers(encoding, tmp_path):
    assert read(tmp_path, "\ufeff1,5;;-3\n", encoding)[0, [0, 2]].tolist() == [1.5, -3]


def test_comments_may_be_in_any_encoding(tmp_path):
    assert read(tmp_path, "# Gr\u00f6\u00dfe\n1 2\n3 4\n", "latin-1").tolist() == [[1, 2], [3, 4]]


@pytest.mark.parametrize(("head", "told"), [
    ("# Width: 4 um\n", "does not give the size of a pixel"),
    ("# Height: 4 um\n", "does not give the size of a pixel"),
    ("# Width: 4 um\n# Height: 4 lightyears\n", "'lightyears' is not a known unit of length"),
    ("# Width: 1-2 um\n# Height: 4 um\n", "line 1: Width = '1-2 um': give one length, as 4 um"),
])  # fmt: skip
def test_half_of_an_extent_is_none(head, told, tmp_path):
    (tmp_path / "map.txt").write_text(head + "1 2\n3 4\n")
    with pytest.raises(ValueError, match=told):
        read_map(tmp_path / "map.txt", unit="m")


@pytest.mark.parametrize("word", ["Value units", "Werteinheit", "Werteinheiten", "Einheit der Werte"])
def test_units_of_comments_in_two_languages(word, tmp_path):
    """Whatever separator ends or begins the rows, the extent is that of the points there are."""
    (tmp_path / "map.txt").write_text(f"# {word}: nm\n# Breite: 3 µm\n#Höhe : 2,5 µm \n;1;2\n;3;4\n;5;6\n")
    found = read_map(tmp_path / "map.txt")
    assert found.heights == pytest.approx(1e-9 * np.array([[1, 2], [3, 4], [5, 6]]))
    assert found.pixel == pytest.approx((1.5e-6, 2.5e-6 / 3))
    assert found.assumed_unit == ""


def test_steepness_is_that_of_the_map_and_not_of_a_spike():
    y, x = np.mgrid[0:40, 0:50]
    plane = 3e-6 * x + 8e-6 * y
    assert Topography(plane, (1e-6, 2e-6)).steepness == pytest.approx(5)
    plane[7, 9] = 1.0
    assert Topography(plane, (1e-6, 2e-6)).steepness == pytest.approx(5)
    plane[20] = np.nan
    assert Topography(plane, (1e-6, 2e-6)).steepness == pytest.approx(5)


POINTS = [(x, y, 10 * x + y * y) for y in range(4) for x in range(3)]  # um and nm


@pytest.mark.parametrize(
    "head", ["x (um) y (um) z (nm)", "# x[um]\ty[um]\tz[nm]", "x_um,y_um,z_nm", "X/um;Y/um;Z/nm"]
)
@pytest.mark.parametrize(("mark", "separator"), [(".", " "), (".", ","), (",", ";"), (",", "\t")])
def test_points_on_a_grid_are_a_map_in_any_order(head, mark, separator, tmp_path):
    """With the units of the header; a point that is not there is missing."""
    rows = [row for row in np.random.default_rng(1).permutation(POINTS) if tuple(row[:2]) != (1, 2)]
    texts = [f"{0.5 * x:.4f} {2 * y + 7:.4f} {z:.3f}".replace(".", mark).split() for x, y, z in rows]
    (tmp_path / "map.txt").write_text("\n".join([head, *(separator.join(text) for text in texts)]) + "\n")
    found = read_heights(tmp_path / "map.txt")
    expected = np.array([[10.0 * x + y * y for x in range(3)] for y in range(4)])
    expected[2, 1] = np.nan
    assert found.heights == pytest.approx(1e-9 * expected, nan_ok=True, rel=1e-12, abs=1e-25)
    assert found.pixel == pytest.approx((0.5e-6, 2e-6))
    assert found.assumed_unit == ""


def test_places_of_points_without_a_unit_are_assumed_in_metres(tmp_path):
    lines = (f"{x * 1e-6:g};{y * 1e-6:g};{z}" for x, y, z in POINTS)
    (tmp_path / "map.txt").write_text("\n".join(["x;y;z (nm)", *lines]))
    assert read_map(tmp_path / "map.txt").assumed_unit == "m"


def test_points_along_one_line_are_a_profile(tmp_path):
    for name, columns in (("x.txt", "{i} 5 {z}"), ("y.xyz", "5 {i} {z}")):
        lines = [columns.format(i=i, z=i % 3) for i in range(20)]
        (tmp_path / name).write_text("x (um) y (um) z (nm)\n" + "\n".join(lines))
        found = read_heights(tmp_path / name)
        assert found.spacing == pytest.approx(1e-6)
        assert found.heights == pytest.approx(1e-9 * (np.arange(20) % 3))
        with pytest.raises(ValueError, match="is a profile along a line"):
            read_map(tmp_path / name)


@pytest.mark.parametrize(("change", "told"), [
    (lambda p: [*p, p[0]], r"x = 0, y = 0 has two heights"),
    (lambda p: [*p, (0.37, 0, 1)], "x of the points is not evenly spaced"),
    (lambda p: [(k, k, k % 3) for k in range(9)], "9 points on a grid of 9 x 9: scattered points are not"),
    (lambda p: [("nan", *p[0][1:]), *p[1:]], "a point lacks x or y"),
])  # fmt: skip
def test_points_that_are_no_grid_are_refused(change, told, tmp_path):
    (tmp_path / "map.txt").write_text("\n".join(" ".join(map(str, p)) for p in change(POINTS)))
    with pytest.raises(ValueError, match=told):
        read_map(tmp_path / "map.txt", unit="um")
    with pytest.raises(ValueError, match="leave --pixel out"):
        read_map(tmp_path / "map.txt", unit="um", pixel=(1e-6, 1e-6))


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
    "Dektak": (
        ["Scan Parameters", "ID,0", "Stylus,Radius: 2.5 um", "Length,4.5 um", "Location,0.0 um, 0.0 um", "",
         "Analytical Results", "Function,R.Cur Pos,Result", "Ra,4.0 um,0.005 um", "Skew,4.0 um,6.96", "",
         "Scan Data", "Lateral um,Raw Micrometer,", *(f"{x},,"  for x in lines(BOTH, ",", False))],
        ".csv", None, (0.5 * UM, UM),
    ),
    **{
        f"one column in {ending}": (["z (um)", *lines(ALONE, "", False)], ending, 2 * UM, (2 * UM, UM))
        for ending in (".txt", ".csv", ".asc", ".dat", ".tsv", ".prf", ".xy", ".XY")
    },
    "one column of commas": (["z (um)", *lines(ALONE, "", True)], ".txt", 2 * UM, (2 * UM, UM)),
    "a count for x": (["n z", *lines((np.arange(10), Z * UM), " ", False)], ".txt", 2 * UM, (2 * UM, UM)),
}  # fmt: skip


def profile(path, spacing=None, **given):
    found = read_heights(path, pixel=None if spacing is None else (spacing, spacing), **given)
    assert isinstance(found, Profile)
    return found


@pytest.mark.parametrize("name", ROWS)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_profiles_of_every_kind(name, encoding, tmp_path):
    text, ending, given, (spacing, unit) = ROWS[name]
    path = tmp_path / f"p{ending}"
    path.write_text("\n".join(text) + "\n", encoding=encoding)
    found = profile(path, given)
    assert found.spacing == pytest.approx(spacing, rel=1e-9)
    np.testing.assert_allclose(found.heights, Z * unit, rtol=1e-9, atol=1e-20)
    assert not found.filled
    assert not found.resampled


@pytest.mark.parametrize(("text", "given", "told"), [
    ("1\n2\n3\n", {}, "does not give the distance between its points; give --pixel"),
    ("x (um);z (um)\n0;1\n1;2\n", {"spacing": 1e-6}, "gives x in um; leave --pixel out"),
    ("x (um);z (um)\n0;1\n1;2\n", {"unit": "nm"}, "heights are in um as the file says, not in nm"),
    ("0 1\n1 2\n2 1\n3 1\n1 2\n4 2\n5 2\n6 1\n7 1\n", {}, "x = 3 m is followed by 1 m"),
    ("\n".join(f"{i} {i % 2 * 1e-6}" for i in range(20)), {}, "the points are 1 m apart; give --unit"),
    ("x;z (um)\n" + "\n".join(f"{i};{i % 2}" for i in range(20)), {}, "the points are 1 m apart; give"),
    ("\n".join(f"{i * 1.0004e-3} {i % 9 * 1e-4}" for i in range(1250)), {}, "it is 1.25 m long; give --unit"),
    ("\n".join(f"{i * 1e-6} {i % 2}" for i in range(20)), {}, "the typical slope is 1e\\+06; give --unit"),
    ("0 1\n1 2\n", {}, "2 points: a profile has 8 or more"),
    ("0 1\n1 2 3\n2 2\n", {}, "line 2 has 3 numbers, the first row 2"),
    ("0 1\n1 2\nend\n", {}, "line 3: could not convert"),
    ("word\n" * 501 + "0 1\n1 2\n", {}, "the first 500 lines are not numbers; is it a map or a profile"),
    ("\n".join(f"{i} {'nan' if i % 3 else 1}" for i in range(30)), {}, "18 of the 28 heights are missing"),
])  # fmt: skip
def test_what_is_no_profile_is_refused_in_one_line(text, given, told, tmp_path):
    path = tmp_path / "p.txt"
    path.write_text(text)
    with pytest.raises(ValueError, match=told) as error:
        profile(path, **given)
    assert "\n" not in str(error.value)
    assert "p.txt" in str(error.value)


@pytest.mark.parametrize("form", ["z ({})", "z [{}]", "z/{}", "height in {}", "Raw {}", "{}"])
def test_every_unit_in_a_header(form, tmp_path):
    units = {
        "m": 1, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "μm": 1e-6, "micron": 1e-6, "nm": 1e-9,
        "pm": 1e-12, "fm": 1e-15, "km": 1e3, "Angstrom": 1e-10, "Å": 1e-10, "Nanometer": 1e-9,
        "Micrometer": 1e-6, "Millimeter": 1e-3,
    }  # fmt: skip
    for unit, metre in units.items():
        (tmp_path / "p.txt").write_text("\n".join([form.format(unit), *map(str, Z)]), encoding="utf-8")
        found = profile(tmp_path / "p.txt", 1e3)
        np.testing.assert_allclose(found.heights, Z * metre, rtol=1e-12)
        assert found.assumed_unit == ""


@pytest.mark.parametrize(("lines", "heights"), [
    ([f"{i},{i % 3}" for i in range(9)], [i % 3 for i in range(9)]),  # rising: places
    ([f"{8 - i},{i % 3}" for i in range(9)], [(8 - i) % 3 for i in range(9)]),  # falling
    (["0,25", "# so", *(f"0,{26 + i}" for i in range(7))], [0.25, *(0.26 + i / 100 for i in range(7))]),
    ([f"{i},0{i % 3}" for i in (0, 1, 1, 0, 2, 3, 1, 0)], [0, 1.01, 1.01, 0, 2.02, 3, 1.01, 0]),
    *(([f"{n},{25 + i}" for i, n in enumerate(whole)], [float(f"{n}.{25 + i}") for i, n in enumerate(whole)])
      for whole in (8 * (0,), 4 * (0,) + 4 * (1,), 2 * (2,) + 6 * (1,))),
])  # fmt: skip
def test_whole_numbers_that_rise_or_fall_before_a_comma_are_places(lines, heights, tmp_path):
    path, places = tmp_path / "p.csv", len(heights) == 9
    path.write_text(("x (um),z (um)\n" if places else "z (um)\n") + "\n".join(lines))
    found = profile(path, None if places else UM)
    np.testing.assert_allclose(found.heights / UM, heights, rtol=1e-12)
    assert found.spacing == pytest.approx(UM)


def test_words_above_a_profile(tmp_path):
    """Five hundred lines of them are a header."""
    rows = [*["word"] * 500, *(f"{i * UM} {i % 3 * UM}" for i in range(9))]
    (tmp_path / "words.txt").write_text("\n".join(rows))
    assert profile(tmp_path / "words.txt").heights[5] == pytest.approx(2 * UM)
