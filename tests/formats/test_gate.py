"""The gate before every HDF5 file and archive: nothing outside is read, and little makes nothing large."""

import os
import subprocess
import sys
import time
import zipfile
from pathlib import Path

import h5py
import numpy as np
import pytest
from oracles.inside import check_archive, loads, loads_json, open_h5, read_text
from oracles.memory_growth import peak_growth

from mcgw.errors import StoreError

SECRET = b"correct horse battery staple" * 64


OUTSIDE = "height: its data are in another file"


def virtual(file, folder):
    layout = h5py.VirtualLayout((8, 8), "f8")
    layout[:] = h5py.VirtualSource(str(folder / "other.h5"), "height", (8, 8))
    file.create_virtual_dataset("height", layout)


def link_through_a_link(file, folder):
    file["out"] = h5py.ExternalLink(str(folder / "other.h5"), "/")
    file["height"] = h5py.SoftLink("/out/height")


def unknown_filter(file, folder):
    space, plist = h5py.h5s.create_simple((8, 8)), h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    plist.set_chunk((8, 8))
    plist.set_filter(32999, h5py.h5z.FLAG_OPTIONAL)
    h5py.h5d.create(file.id, b"height", h5py.h5t.IEEE_F64LE, space, plist)


def external(file, folder):
    file.create_dataset("height", (8, 8), "f8", external=[(str(folder / "secret"), 0, 512)])


# By name: what makes it of a file in a folder, and what is said.
HOSTILE = {
    "external storage": (external, OUTSIDE),
    "external storage below": (lambda f, d: external(f.create_group("a/b/c"), d), f"a/b/c/{OUTSIDE}"),
    "virtual": (virtual, OUTSIDE),
    "external link": (
        lambda f, d: f.update(height=h5py.ExternalLink(str(d / "other.h5"), "height")),
        "height: a link to another file",
    ),
    "link through a link": (link_through_a_link, "out: a link to another file"),
    "chunk bomb": (
        lambda f, d: f.create_dataset("height", data=np.ones((64, 64)), maxshape=(None, None),
                                      chunks=(4000, 4000), compression="gzip"),
        "height: chunks of 128000000 bytes for 32768",
    ),
    "never written": (
        lambda f, d: f.create_dataset("height", (2**14, 2**14), "f8", chunks=(64, 64)),
        "height: more bytes declared than a file of",
    ),
    "unknown filter": (unknown_filter, "height: unknown filter"),
    "deep": (lambda f, d: f.create_group("g/" * 100), "groups are nested more than 32 deep"),
    "members": (
        lambda f, d: [f.create_group(str(i)) for i in range(5000)], "more than 4096 groups and datasets",
    ),
}  # fmt: skip


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "secret").write_bytes(SECRET)
    with h5py.File(tmp_path / "other.h5", "w") as file:
        file["height"] = np.ones((8, 8))
    return tmp_path


@pytest.mark.parametrize("name", HOSTILE)
def test_what_leads_out_of_a_file_or_declares_too_much_is_refused(name, folder):
    make, told = HOSTILE[name]
    with h5py.File(folder / "map.h5", "w") as file:
        make(file, folder)

    def refused():
        with pytest.raises(StoreError, match=rf"^\S*map\.h5: refused: .*{told}") as error:
            open_h5(folder / "map.h5")
        assert len(str(error.value).splitlines()) == 1

    began = time.process_time()
    assert not peak_growth(refused) > 2**26
    assert time.process_time() - began < 1


def test_plain_files_pass(folder):
    """Groups, a soft link, cycles, empty and scalar data, resizable and compressed ones."""
    with h5py.File(folder / "map.h5", "w") as file:
        file["a/b"], file["scalar"], file["text"] = np.ones(8), 1.0, "a text"
        file["a/self"], file["empty"] = file["/"], h5py.Empty("f8")
        file["soft"], file["dangling"] = h5py.SoftLink("/a/b"), h5py.SoftLink("/no")
        file.create_dataset("none", (0, 5), "f8", maxshape=(None, 5))
        file.create_dataset("zeros", data=np.zeros((1000, 1000)), compression="gzip")
        file.create_dataset("grows", data=np.ones(10), maxshape=(None,), compression="lzf", shuffle=True)
    with open_h5(folder / "map.h5") as file:
        assert file["soft"][...] == pytest.approx(1)
        assert file["zeros"].shape == (1000, 1000)


def test_what_is_no_regular_file_is_not_waited_for(folder):
    os.mkfifo(folder / "pipe.h5")
    for path, told in (
        (folder / "pipe.h5", r"pipe\.h5: is not a regular file"),
        ("/dev/zero", "is not a regular file"),
        (folder / "absent.h5", "No such file"),
    ):
        with pytest.raises(StoreError, match=told):
            open_h5(path)


def test_an_audit_of_what_is_opened_sees_no_other_file(folder):
    """HDF5 opens files by itself, past Python, so the kernel's list of open files is looked at too."""
    with h5py.File(folder / "map.h5", "w") as file:
        external(file, folder)
        file["far"] = h5py.ExternalLink(str(folder / "other.h5"), "height")
    script = """
import os, sys
from mcgw.formats.gate import open_h5
opened, folder = [], "/proc/self/fd/"
sys.addaudithook(lambda name, args: opened.append(str(args[0])) if name == "open" else None)
try:
    open_h5(sys.argv[1])
except ValueError as error:
    print(error)
kept = [os.readlink(folder + n) for n in os.listdir(folder) if os.path.exists(folder + n)]
print(*(name for name in opened + kept if name.endswith(("secret", "other.h5"))), sep="|")
"""
    command = [sys.executable, "-c", script, str(folder / "map.h5")]
    told, others = subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()
    assert "refused" in told
    assert others == ""


def archive(path: Path, members: dict[str, bytes], method=zipfile.ZIP_DEFLATED) -> Path:
    with zipfile.ZipFile(path, "w", method) as file:
        for name, data in members.items():
            file.writestr(name, data)
    return path


PACKED = zipfile.ZIP_DEFLATED
ARCHIVES = {
    "unpacks to 100 MB": ({"bindata/data.bin": bytes(10**8)}, PACKED, "that unpacks to 100000000"),
    "many": ({str(i): b"" for i in range(2000)}, PACKED, "an archive of 2000 members"),
    "bzip2": ({"a": b"1"}, zipfile.ZIP_BZIP2, "'a' is encrypted, or not packed by deflate"),
    "entities": ({"main.xml": b"<!DOCTYPE a><a/>"}, PACKED, "'main.xml' declares entities"),
    "wide": (
        {"index.xml": "<a/>".encode("utf-16")}, PACKED, "'index.xml' declares entities, or is not UTF-8",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", ARCHIVES)
def test_archives_that_unpack_to_far_more_are_refused(name, tmp_path):
    members, method, told = ARCHIVES[name]
    path = archive(tmp_path / "map.x3p", members, method)
    with pytest.raises(ValueError, match=told):
        check_archive(path)


def test_a_whole_archive_passes_and_a_cut_one_does_not(tmp_path):
    path = archive(tmp_path / "map.x3p", {"main.xml": b"<a/>", "data": bytes(10**6)})
    check_archive(path)
    path.write_bytes(path.read_bytes()[:-30])
    with pytest.raises(ValueError, match=r"map\.x3p: is a damaged zip archive"):
        check_archive(path)


TEXTS = {
    "deep": ("a = " + "[" * 10**5, "nested too deeply|Invalid|Unclosed"),
    "digits": ("a = " + "1" * 10**5, "line 1: a number has more than 4000 digits"),
    "hexadecimal": ("a = 0x" + "f" * 10**6, "line 1: a number has more than 4000 digits"),
    "underscores": ("a = " + "1_" * 10**5 + "1", "line 1: a number has more than 4000 digits"),
    "quoted key": (".".join(['"a"'] * 10**5) + " = 1", "a dotted key has more than 100 parts"),
    "101 parts": ("a" + ".a" * 100 + " = 1\n", "a dotted key has more than 100 parts"),
    "long word": ("a" * 10**6, "Expected"),
}


@pytest.mark.parametrize("name", TEXTS)
def test_toml_that_would_stop_its_parser_is_refused_at_once(name):
    text, told = TEXTS[name]
    began = time.process_time()
    with pytest.raises(ValueError, match=told):
        loads(text)
    assert time.process_time() - began < 1


def test_a_text_may_be_as_long_as_said_and_no_longer(tmp_path):
    (tmp_path / "t").write_bytes(b"\xef\xbb\xbf12345")
    assert read_text(tmp_path / "t", 8) == "12345"
    with pytest.raises(StoreError, match="longer than 7 bytes"):
        read_text(tmp_path / "t", 7)


def test_json_that_would_stop_its_parser_is_refused_at_once():
    for text, told in (
        ("[" * 10**6, "nested too deeply"),
        ('{"a": ' * 10**5, "nested too deeply"),
        ("1" * 400, "300 digits"),
        ('{"a": NaN}', "NaN is not a number of JSON"),
        (b'{"a": "\xff"}', "can't decode"),
        ("{", "Expecting"),
    ):
        with pytest.raises(ValueError, match=told):
            loads_json(text)
    assert loads_json(b'\xef\xbb\xbf{"a": [1, 2.5e300, "[[["]}') == {"a": [1, 2.5e300, "[[["]}
    assert loads('"a"' + ".a" * 99 + " = 1 # " + "a." * 500 + "\n")
    assert loads(f'a = "{"a.[" * 500}"\nb = {"[" * 50}{"]" * 50}')["a"] == "a.[" * 500
    assert loads(f'a = "{"[" * 500}"\nb = [{"1, " * 500}]') == {"a": "[" * 500, "b": [1] * 500}
