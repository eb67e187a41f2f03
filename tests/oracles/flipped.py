"""A bit of a stored number is flipped, as a bad disk does; elsewhere HDF5 leaves room that nobody reads."""

import h5py


def flip_a_number(path, name=None):
    """One bit in the middle of a table or its first chunk; by default of the first one."""
    with h5py.File(path) as file:
        table = file[name or min(file)]
        whole = table.id.get_offset(), table.id.get_storage_size()
        *_, first, size = table.id.get_chunk_info(0) if table.chunks else whole
    data = bytearray(path.read_bytes())
    data[first + size // 2] ^= 4
    path.write_bytes(data)
