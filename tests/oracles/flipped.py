"""A bit of a stored number is flipped, as a bad disk does; elsewhere HDF5 leaves room that nobody reads."""

import h5py


def flip_a_number(path, name=None):
    """One bit in the middle of the first chunk of a table; by default of the first one."""
    with h5py.File(path) as file:
        chunk = file[name or min(file)].id.get_chunk_info(0)
    data = bytearray(path.read_bytes())
    data[chunk.byte_offset + chunk.size // 2] ^= 4
    path.write_bytes(data)
