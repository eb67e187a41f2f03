"""Shards and trailers: every changed bit and every lost byte is noticed."""

import errno
import hashlib
import os
from contextlib import closing

import h5py
import numpy as np
import pytest

from mcgw.errors import StoreError
from mcgw.formats.files import write_whole
from mcgw.store.disk import TRAILER_BYTES, SteadyFile, Trailer, check_trailer, read_checked, trailer_of
from mcgw.store.shards import Span, commit_shard, content_digest, open_shard, pack

RUN, SPAN = "a" * 64, Span(40, 5)
FLIPS, TRUNCATIONS = 200, 100


def arrays():
    load = np.linspace(0, 1, 15).reshape(5, 3)
    return {"load": load, "contacts": np.arange(15).reshape(5, 3), "block_mean": np.array([[42.0, 3.5, 1.0]])}


@pytest.fixture
def shard(tmp_path):
    return commit_shard(tmp_path / SPAN.file_name, RUN, SPAN, arrays(), 1.5)


def test_a_shard_gives_back_what_was_put_in(shard):
    again = open_shard(shard.path, RUN)
    assert again == shard
    for name, values in arrays().items():
        np.testing.assert_array_equal(again.arrays()[name], values)


def test_every_flipped_bit_is_noticed(shard):
    data = shard.path.read_bytes()
    rng = np.random.default_rng(1)
    for bit in rng.choice(8 * len(data), FLIPS, replace=False):
        changed = bytearray(data)
        changed[bit // 8] ^= 1 << bit % 8
        shard.path.write_bytes(changed)
        with pytest.raises(StoreError):
            open_shard(shard.path, RUN)


def test_every_other_length_is_noticed(shard):
    data = shard.path.read_bytes()
    rng = np.random.default_rng(2)
    shard.path.write_bytes(data + b"\0")
    with pytest.raises(StoreError, match="not a whole file"):
        open_shard(shard.path, RUN)
    for length in [0, 1, TRAILER_BYTES, len(data) - 1, *rng.choice(len(data), TRUNCATIONS, replace=False)]:
        shard.path.write_bytes(data[:length])
        with pytest.raises(StoreError):
            open_shard(shard.path, RUN)


def test_a_shard_of_another_run_or_block_is_refused(shard):
    with pytest.raises(StoreError, match="another run"):
        open_shard(shard.path, "b" * 64)
    other = shard.path.with_name(Span(45, 5).file_name)
    other.write_bytes(shard.path.read_bytes())
    with pytest.raises(StoreError, match="surfaces 40"):
        open_shard(other, RUN)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_numbers_that_are_not_finite_are_never_committed(tmp_path, bad):
    wrong = arrays()
    wrong["load"][2, 1] = bad
    with pytest.raises(StoreError, match="load holds numbers that are not finite"):
        commit_shard(tmp_path / SPAN.file_name, RUN, SPAN, wrong, 0.0)
    assert not list(tmp_path.iterdir())


def test_rows_must_be_those_of_the_block(tmp_path):
    for wrong in ({"load": np.ones((4, 3))}, {"block_mean": np.ones((2, 3))}):
        with pytest.raises(StoreError, match="does not have the rows"):
            commit_shard(tmp_path / SPAN.file_name, RUN, SPAN, wrong, 0.0)


def test_a_sealed_file_that_is_no_shard_is_refused(tmp_path):
    """Sealed rightly and holding something else: a link to another file instead of numbers."""
    path = tmp_path / SPAN.file_name
    with h5py.File(path, "w") as file:
        file["load"] = h5py.ExternalLink("/etc/hostname", "/x")
    body = path.read_bytes()
    notes = {"run": RUN, "first": 40, "n": 5, "content": "0", "seconds": 0.0}
    path.write_bytes(body + trailer_of(body, **notes))
    with pytest.raises(StoreError, match="a link to another place"):
        open_shard(path, RUN).arrays()


def test_a_body_of_another_length_is_noticed_by_the_trailer_alone(shard):
    data = shard.path.read_bytes()
    for body in (data[: -TRAILER_BYTES - 8], data[:-TRAILER_BYTES] + bytes(8)):
        shard.path.write_bytes(body + data[-TRAILER_BYTES:])
        with pytest.raises(
            StoreError, match=rf"damaged \({len(body) + TRAILER_BYTES} bytes long, not {len(data)}\)"
        ):
            open_shard(shard.path, RUN, body=False)


@pytest.mark.parametrize(("key", "value"), [("first", -1), ("n", 0), ("n", "many"), ("run", None)])
def test_a_trailer_that_tells_of_no_block_is_refused(key, value, tmp_path):
    path, body = tmp_path / SPAN.file_name, pack(arrays())
    notes = {"run": RUN, "first": 40, "n": 5, "content": content_digest(arrays()), "seconds": 0.0}
    path.write_bytes(body + trailer_of(body, **notes))
    assert open_shard(path, RUN).span == SPAN
    wrong = {k: v for k, v in (notes | {key: value}).items() if v is not None}
    path.write_bytes(body + trailer_of(body, **wrong))
    with pytest.raises(StoreError, match=r"is not a shard$"):
        open_shard(path, RUN)


def test_the_digest_is_of_contents_alone():
    assert content_digest(arrays()) == content_digest(dict(reversed(arrays().items())))
    changed = arrays()
    changed["load"][0, 0] = -0.0  # equal to 0.0, and not the same bits
    assert content_digest(changed) != content_digest(arrays())
    # A header has the second in which it was made: two in a row may fall on either side of its end.
    assert any(pack(arrays()) == pack(arrays()) for _ in range(3))


def test_a_file_appears_whole_or_not_at_all(tmp_path, monkeypatch):
    path = tmp_path / "a"
    write_whole(path, [b"old"])

    def fail(fd):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", fail)
    with pytest.raises(OSError, match="No space"):
        write_whole(path, [b"new"])
    assert path.read_bytes() == b"old"
    assert [p.name for p in tmp_path.iterdir()] == ["a"]


def test_a_planted_link_is_replaced_not_followed(tmp_path):
    victim, path = tmp_path / "victim", tmp_path / "a"
    victim.write_bytes(b"precious")
    path.symlink_to(victim)
    write_whole(path, [b"new"])
    assert victim.read_bytes() == b"precious"
    assert not path.is_symlink()
    assert path.read_bytes() == b"new"


def test_large_files_are_checked_in_pieces(tmp_path):
    path, body = tmp_path / "a", bytes(range(256)) * 40_000
    path.write_bytes(body + trailer_of(body))
    assert check_trailer(path).length == read_checked(path)[0].length == len(body)


NO_TRAILERS = ["{}", "[]", "3", "nothing", '{"length": "x", "sha256": "", "notes": {}}']
NO_TRAILERS += ['{"length": 1, "sha256": ""}', '{"length": 1, "sha256": "", "notes": 3}']


@pytest.mark.parametrize("text", NO_TRAILERS)
def test_a_trailer_of_other_words_is_refused(text):
    """Its own digest holds; and so does that of one in order."""
    for words, good in ((text, False), ('{"length": 7, "sha256": "a", "notes": {"n": 1}}', True)):
        head = b"MCGWSEAL" + words.encode().ljust(472)
        data = head + hashlib.sha256(head).digest()
        if good:
            assert Trailer.from_bytes(data) == Trailer(7, "a", {"n": 1})
            continue
        with pytest.raises(StoreError, match=r"^its trailer cannot be read$"):
            Trailer.from_bytes(data)


class Disk:
    """A file that takes three bytes at a time, and so many in all."""

    def __init__(self, file, room):
        self.room, self.data, self.asked = room, b"", 0
        self.close = file._file.close
        file._file = self

    def write(self, data):
        self.asked += 1
        if len(self.data) >= self.room:
            raise OSError(errno.ENOSPC, "No space left on device")
        self.data += bytes(data[:3])
        return len(data[:3])

    def truncate(self, _):
        raise OSError(errno.EIO, "Input/output error")

    def seek(self, *_):
        return 0


def test_a_full_disk_is_an_error_only_when_it_is_asked_for(tmp_path):
    """HDF5 sees none: it goes on, nothing more is written, and the first error is the one that is told."""
    with closing(SteadyFile(tmp_path / "a")) as file:
        disk = Disk(file, room=6)
        assert file.write(b"abcdef") == 6
        file.check()
        assert file.write(np.arange(2, dtype=np.int64)) == 16
        assert (disk.data, disk.asked) == (b"abcdef", 3)
        assert file.write(b"xyz") == 3
        assert file.truncate(5) == 5
        assert disk.asked == 3
        for end in (file.check, lambda: file.trailer(b"end")):
            with pytest.raises(OSError, match="No space left on device"):
                end()


def test_a_length_that_cannot_be_set_is_an_error_too(tmp_path):
    with closing(SteadyFile(tmp_path / "a")) as file:
        Disk(file, room=6)
        assert file.truncate(None) == 0
        with pytest.raises(OSError, match="Input/output error"):
            file.check()


def test_what_hdf5_writes_is_what_it_reads(tmp_path):
    path = tmp_path / "a"
    with closing(SteadyFile(path)) as file:
        file.write(b"0123456789")
        assert file.tell() == file.seek(0, os.SEEK_END) == 10
        assert file.seek(-3, os.SEEK_CUR) == 7
        assert file.read(5) == b"789\0\0"
        file.truncate(4)
        file.trailer(b"end")
        file.flush()
    assert path.read_bytes() == b"0123end"
    with pytest.raises(FileExistsError):
        SteadyFile(path)
