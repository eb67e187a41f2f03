"""A bit of a stored number is flipped, as a bad disk does; elsewhere HDF5 leaves room that nobody reads."""

import h5py


def flip_a_number(path, name=None):
    """One bit in the middle of a table or its first chunk; by default of the first one."""
    with h5py.File(path) as file:
        table = file[name or min(file)].id
        first, size = table.get_offset(), table.get_storage_size()
        if first is None:
            _, _, first, size = table.get_chunk_info(0)
    data = bytearray(path.read_bytes())
    data[first + size // 2] ^= 4
    path.write_bytes(data)
