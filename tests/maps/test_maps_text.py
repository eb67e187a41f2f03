"""Text as instruments and spreadsheets of any country write it; and in which unit its heights are."""

import numpy as np
import pytest

from mcgw.maps import Profile, Topography, read_heights, read_map
from mcgw.maps.text_file import table_of

NAN = np.nan
UM, MM = 1e-6, 1e-3


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        ("1.5,2.5\n3,4\n", [[1.5, 2.5], [3, 4]]),
        ("1,2,3\n", [[1, 2, 3]]),  # nothing else parts the numbers
        ("1,23;4,56\n7;8,5\n", [[1.23, 4.56], [7, 8.5]]),
        ("-1,23\t+4,56\r\n7\t8,\r\n", [[-1.23, 4.56], [7, 8]]),
        ("1,5e-6; 2,5E+06\n", [[1.5e-6, 2.5e6]]),
        ("1;2\t3   4\n", [[1, 2, 3, 4]]),
        ("1,5;;3\n4;5;6\n", [[1.5, NAN, 3], [4, 5, 6]]),
        ("\t2\t3\n4\t5\t\n", [[NAN, 2, 3], [4, 5, NAN]]),
        ("1\t2\n\t\n3\t4\n", [[1, 2], [NAN, NAN], [3, 4]]),
        ("1;nan;BAD\n---;5,5;6\n", [[1, NAN, NAN], [NAN, 5.5, 6]]),
        (";1;2;\n;3;4;\n", [[1, 2], [3, 4]]),  # every line begins and ends with a separator
        ("1;2;\n3;4;5\n", [[1, 2, NAN], [3, 4, 5]]),
    ],
)
def test_numbers_of_every_country(content, expected, tmp_path):
    (tmp_path / "map.csv").write_text(content, newline="")
    found = table_of(tmp_path / "map.csv")[0]
    assert found.shape == np.shape(expected)
    assert np.array_equal(found, expected, equal_nan=True)


@pytest.mark.parametrize(
    ("encoding", "text"),
    [("utf-8", "\ufeff1;2\n"), ("utf-16-be", "\ufeff1;2\n"), ("latin-1", "# Gr\u00f6\u00dfe\n1 2\n")],
)
def test_marks_of_the_encoding_and_letters_of_comments_are_no_numbers(encoding, text, tmp_path):
    (tmp_path / "map.csv").write_bytes(text.encode(encoding))
    assert table_of(tmp_path / "map.csv")[0].tolist() == [[1, 2]]


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
    plane[7, 9] = 1.0
    assert Topography(plane, (1e-6, 2e-6)).steepness == pytest.approx(5)
    plane[20] = np.nan
    assert Topography(plane, (1e-6, 2e-6)).steepness == pytest.approx(5)


POINTS = [(x, y, 10 * x + y * y) for y in range(4) for x in range(3)]  # um and nm


@pytest.mark.parametrize(
    ("head", "mark", "separator"),
    [
        ("x (um) y (um) z (nm)", ".", " "),
        ("# x[um]\ty[um]\tz[nm]", ",", "\t"),
        ("x_um,y_um,z_nm", ".", ","),
        ("X/um;Y/um;Z/nm", ",", ";"),
    ],
)
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


# --- profiles -------------------------------------------------------------------------------------------


def profile(path, spacing=None):
    found = read_heights(path, pixel=None if spacing is None else (spacing, spacing))
    assert isinstance(found, Profile)
    return found


def lines(columns, separator, comma=False):
    rows = (separator.join(f"{v:g}" for v in row) for row in zip(*columns, strict=True))
    return [row.replace(".", ",") if comma else row for row in rows]


Z = np.array([0.1, 0.3, -0.2, 0.5, 0.4, 0.0, -0.1, 0.2, 0.35, 0.15])
X = np.arange(10) * 0.5
BOTH, ALONE, COUNT = (X, Z), (Z,), np.arange(10)
ROWS = {  # name: ending, lines, spacing given, spacing and unit of z expected in m
    "two columns, SI": (".txt", lines((X * UM, Z * UM), " "), None, (0.5 * UM, UM)),
    "tabs, units in brackets": (".tsv", ["x [mm]\tz [um]", *lines(BOTH, "\t")], None, (0.5 * MM, UM)),
    "decimal commas": (".csv", ["X (µm);Z (nm)", *lines(BOTH, ";", comma=True)], None, (0.5 * UM, 1e-9)),
    "after a slash": (".asc", ["Weg/mm;Hoehe/um", *lines(BOTH, ";", comma=True)], None, (0.5 * MM, UM)),
    "commas": (".csv", ["x,z", "um,nm", *lines(BOTH, ",")], None, (0.5 * UM, 1e-9)),
    "Gwyddion": (
        ".txt", ["Profile 1", "x [m] y [m]", *lines((X * UM, Z * UM), "  ")], None, (0.5 * UM, UM),
    ),
    "comments": (".dat", ["# x in um; z in nm", *lines(BOTH, " ")], None, (0.5 * UM, 1e-9)),
    "one unit for both": (".txt", ["Units (um)", *lines(BOTH, ";")], None, (0.5 * UM, UM)),
    "metadata": (
        ".txt", ["Speed (mm/s): 0.5", "Length (mm): 4.8", "x (um);z (nm)", *lines(BOTH, ";")],
        None, (0.5 * UM, 1e-9),
    ),
    "Dektak": (
        ".csv",
        ["Scan Parameters", "ID,0", "Stylus,Radius: 2.5 um", "Length,4.5 um", "Location,0.0 um, 0.0 um", "",
         "Analytical Results", "Function,R.Cur Pos,Result", "Ra,4.0 um,0.005 um", "Skew,4.0 um,6.96", "",
         "Scan Data", "Lateral um,Raw Micrometer,", *(f"{x},,"  for x in lines(BOTH, ","))],
        None, (0.5 * UM, UM),
    ),
    "along x": (".txt", ["x (um) y (um) z (nm)", *lines((X, 0 * X + 5, Z), " ")], None, (0.5 * UM, 1e-9)),
    "along y": (".xyz", ["x (um) y (um) z (nm)", *lines((0 * X + 5, X, Z), " ")], None, (0.5 * UM, 1e-9)),
    "one column": (".prf", ["z (um)", *lines(ALONE, "")], 2 * UM, (2 * UM, UM)),
    "one column of commas": (".XY", ["z (um)", *lines(ALONE, "", comma=True)], 2 * UM, (2 * UM, UM)),
    "a count for x": (".txt", ["n z", *lines((COUNT, Z * UM), " ")], 2 * UM, (2 * UM, UM)),
    "500 words": (".txt", [*["word"] * 500, *lines((X * UM, Z * UM), " ")], None, (0.5 * UM, UM)),
}  # fmt: skip


@pytest.mark.parametrize("name", ROWS)
def test_profiles_of_every_kind(name, tmp_path):
    """In UTF-16, if there is a letter that ASCII lacks."""
    ending, text, given, (spacing, unit) = ROWS[name]
    path, text = tmp_path / f"p{ending}", "\n".join(text) + "\n"
    path.write_text(text, encoding="utf-8" if text.isascii() else "utf-16")
    found = profile(path, given)
    assert found.spacing == pytest.approx(spacing, rel=1e-9)
    np.testing.assert_allclose(found.heights, Z * unit, rtol=1e-9, atol=1e-20)
    assert not found.filled
    assert not found.resampled
    with pytest.raises(ValueError, match="is a profile along a line"):
        read_map(path, pixel=None if given is None else (given, given))


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
    ([f"{i // 4},{25 + i}" for i in range(8)], [0.25, 0.26, 0.27, 0.28, 1.29, 1.3, 1.31, 1.32]),
])  # fmt: skip
def test_whole_numbers_that_rise_or_fall_before_a_comma_are_places(lines, heights, tmp_path):
    path, places = tmp_path / "p.csv", len(heights) == 9
    path.write_text(("x (um),z (um)\n" if places else "z (um)\n") + "\n".join(lines))
    found = profile(path, None if places else UM)
    np.testing.assert_allclose(found.heights / UM, heights, rtol=1e-12)
    assert found.spacing == pytest.approx(UM)


# --- what is neither ------------------------------------------------------------------------------------


def text_of(rows):
    return "\n".join(" ".join(map(str, row)) for row in rows)


PIXEL, M = {"pixel": (1.0, 1.0)}, {"unit": "m"}
REFUSED = [  # text, what is given, what is told
    ("1,2, 3,4\n", PIXEL, "inside and between numbers"),
    ("1,2, 3,4 5\n0 0 1\n1 0 2\n0 1 3\n1 1 4\n", PIXEL, "inside and between"),  # no header of points
    ("1,2,3;4,5,6\n", PIXEL, "by commas and by something else"),
    ("0,0012,0,0013\n", PIXEL, "begins with 0"),
    ('"1,5","2,5"\n', PIXEL, "line 1: could not convert"),
    ("1,5;2\n3;4;5\n", PIXEL, "line 2 has 3 numbers, the first row 2"),
    ("1 inf\n", PIXEL, "infinite"),
    ("# nothing\n", PIXEL, "holds no numbers"),
    ("1" * 2**24, PIXEL, r"p\.txt: line 1 has 16777216 characters or more; is it a map\?"),
    ("# Width: 4 um\n1 2 3\n4 5 6\n", M, "does not give the size of a pixel"),
    (
        "# Width: 4 um\n# Height: 4 lightyears\n1 2\n",
        M,
        "line 2: Height = '4 lightyears': give a number > 0 with its unit",
    ),
    (text_of([*POINTS, POINTS[0]]), {"unit": "um"}, "x = 0, y = 0 has two heights"),
    (text_of([*POINTS, (0.37, 0, 1)]), {"unit": "um"}, "x of the points is not evenly spaced"),
    (text_of([(k, k, k % 3) for k in range(9)]), M, "9 points on a grid of 9 x 9: scattered points are not"),
    (text_of([("nan", 0, 0), *POINTS[1:]]), {"unit": "um"}, "a point lacks x or y"),
    (text_of(POINTS), PIXEL, "leave --pixel out"),
    ("# Width: 9 um\n" + text_of((k, 5, k % 3) for k in range(9)), M, "all points lie on one line"),
    ("1\n2\n3\n", {}, "does not give the distance between its points; give --pixel"),
    ("x (um);z (um)\n0;1\n1;2\n", PIXEL, "gives x in um; leave --pixel out"),
    ("0 1\n1 2\n2 1\n3 1\n1 2\n4 2\n5 2\n6 1\n7 1\n", {}, "x = 3 m is followed by 1 m"),
    (text_of((i, i % 2 * 1e-6) for i in range(20)), {}, "the points are 1 m apart; give --unit"),
    ("x;z (um)\n" + text_of((i, i % 2) for i in range(20)), {}, "the points are 1 m apart; give"),
    (text_of((i * 1e-6, i % 2) for i in range(20)), {}, r"the typical slope is 1e\+06; give --unit"),
    ("0 1\n1 2\nend\n", {}, "line 3: could not convert"),
    ("word\n" * 501 + "0 1\n1 2\n", {}, "the first 500 lines are not numbers; is it a map or a profile"),
]


@pytest.mark.parametrize(("text", "given", "told"), REFUSED, ids=[told for *_, told in REFUSED])
def test_what_is_neither_is_refused_in_one_line(text, given, told, tmp_path):
    (tmp_path / "p.txt").write_text(text)
    with pytest.raises(ValueError, match=told) as error:
        read_heights(tmp_path / "p.txt", **given)
    assert "\n" not in str(error.value)
    assert "p.txt" in str(error.value)
