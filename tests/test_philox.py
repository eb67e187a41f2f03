"""The generator against its published known-answer vectors, and the streams made of it."""

import numpy as np
import pytest
from scipy.stats import kstest

from mcgw.sampling.philox import CELLS, EXTRAS, centred, philox, uniforms

# Random123, kat_vectors: philox4x32 10, counter, key, output.
KNOWN = [
    ((0, 0, 0, 0), (0, 0), (0x6627E8D5, 0xE169C58D, 0xBC57AC4C, 0x9B00DBD8)),
    ((0xFFFFFFFF,) * 4, (0xFFFFFFFF,) * 2, (0x408F276D, 0x41C83B0E, 0xA20BC7C6, 0x6D5451FD)),
    (
        (0x243F6A88, 0x85A308D3, 0x13198A2E, 0x03707344),
        (0xA4093822, 0x299F31D0),
        (0xD16CFE09, 0x94FDCCEB, 0x5001E420, 0x24126EA1),
    ),
]


@pytest.mark.parametrize(("counter", "key", "output"), KNOWN)
def test_published_vectors(counter, key, output):
    words = [np.uint64(word) for word in (*counter, *key)]
    assert tuple(int(word) for word in philox.py_func(*words)) == output


def test_first_words_of_a_stream_are_the_published_ones():
    """Seed 0, surface 0, cell 0, purpose 0: word w of block 0 stands at index 16 w."""
    words = np.rint(uniforms(0, CELLS, 0, 0, 64) * 2**32 - 0.5).astype(np.uint64)
    assert [int(words[16 * w]) for w in range(4)] == list(KNOWN[0][2])


def test_a_word_depends_on_its_own_index_only():
    whole = uniforms(7, CELLS, 3, 5, 1000)
    for first in (64, 512, 960):
        x = np.empty(64)
        centred(x, np.uint64(7), CELLS, 3, 5, first, 64)
        np.testing.assert_array_equal((1 + x[: min(64, 1000 - first)]) / 2, whole[first : first + 64])


def test_streams_differ_in_every_coordinate():
    streams = [
        uniforms(*key, 256)
        for key in (
            (1, CELLS, 0, 0),
            (2, CELLS, 0, 0),
            (1 + 2**32, CELLS, 0, 0),
            (1, EXTRAS, 0, 0),
            (1, CELLS, 1, 0),
            (1, CELLS, 2**32, 0),
            (1, CELLS, 0, 1),
        )
    ]
    values = np.concatenate(streams)
    # 1792 words of 32 bits: a chance collision has probability 4e-4; a shared stream gives 256.
    assert len(np.unique(values)) == len(values)


def test_uniform_and_never_at_the_ends():
    u = uniforms(11, CELLS, 0, 0, 200_000)
    assert 0 < u.min() < u.max() < 1
    assert kstest(u, "uniform").pvalue > 1e-6  # false alarms: 1 in 1e6, seed fixed
    assert kstest(u**1.02, "uniform").pvalue < 1e-6  # and a law that is off by 2 % fails


def test_high_blocks_do_not_repeat_the_low_ones():
    low, high = np.empty(64), np.empty(64)
    centred(low, np.uint64(1), CELLS, 0, 0, 0, 64)
    centred(high, np.uint64(1), CELLS, 0, 0, 2**34, 64)
    assert not np.intersect1d(low, high).size
