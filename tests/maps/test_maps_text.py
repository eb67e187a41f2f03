"""Text as instruments and spreadsheets of any country write it; and in which unit its heights are."""

import numpy as np
import pytest

from mcgw.cli import main
from mcgw.maps import Spectrum, Topography, gaussian_map, read_map
from mcgw.maps.text_file import read_text

NAN = np.nan
PIXEL = (1e-6, 1e-6)


def read(tmp_path, content, encoding="utf-8"):
    path = tmp_path / "map.csv"
    path.write_bytes(content.encode(encoding))
    return read_text(path, (1.0, 1.0), "m").heights


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
    ("x in nm, y in nm\n1, 2\n", "line 1: could not convert"),
    ("X;Y\n1;2\n", "line 1: could not convert"),
    ("1,5;2\n3;4;5\n", "line 2 has 3 numbers, the first row 2"),
    ("1 inf\n", "infinite"),
    ("# nothing\n", "holds no numbers"),
    ("1" * 2**24, r"map\.csv: line 1 has 16777216 characters or more; is it a map\?"),
], ids=lambda x: x[:20])  # fmt: skip
def test_what_may_mean_two_things_is_refused_in_one_line(content, told, tmp_path):
    with pytest.raises(ValueError, match=told) as error:
        read(tmp_path, content)
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


def test_a_command_tells_a_unit_that_was_assumed(tmp_path, capsys, without_caps):
    path, out = tmp_path / "map.npy", tmp_path / "x.toml"
    np.save(
        path, gaussian_map(Spectrum(1e-6, 16e-6, 8e-6), (128, 128), PIXEL, np.random.default_rng(1)).heights
    )
    words = ["fit", str(path), "--pixel", "1um", "--cutoff", "none", "-o", str(out)]
    for more, assumed in ((["--unit", "m"], False), ([], True)):
        assert main([*words, *more]) == 0
        for text in (capsys.readouterr().out, out.read_text()):
            assert ("heights assumed in m" in text) == assumed


def test_steepness_is_that_of_the_map_and_not_of_a_spike():
    y, x = np.mgrid[0:40, 0:50]
    plane = 3e-6 * x + 8e-6 * y
    assert Topography(plane, (1e-6, 2e-6)).steepness == pytest.approx(5)
    plane[7, 9] = 1.0
    assert Topography(plane, (1e-6, 2e-6)).steepness == pytest.approx(5)
    plane[20] = np.nan
    assert Topography(plane, (1e-6, 2e-6)).steepness == pytest.approx(5)
