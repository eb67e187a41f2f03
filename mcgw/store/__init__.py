"""Results as HDF5 files, and the folders of the runs that make them.

A file appears whole or not at all. All have one layout (``filetype = "mcgw-results"``, ``format = [2, 0]``),
which reads

==========================  ========================================  ========================
of                          holds                                     opened by
==========================  ========================================  ========================
a scene                     values of every surface, as below         `mcgw.open_ensemble`
``keep = "statistics"``     statistics over them (`statistics_file`)  `mcgw.open_ensemble`
a sweep: attribute `axes`   statistics with the dimension `point`     `mcgw.open_sweep`
any earlier format                                                    no reader: run it again
==========================  ========================================  ========================

Of a scene::

    /                     attributes: filetype, format, title, scene (TOML text of the resolved scene),
                          seed, sampler, complete, digest, versions, draws, run, commit, date, cpu,
                          wall_seconds
    /surface              int64 (surfaces,)               dimension scale: numbers of the surfaces
    /separation           float64 (separations,)          dimension scale: d/sigma
    /load                 float64 (surfaces, separations) N
    /area                 float64 (surfaces, separations) m^2
    /stiffness            float64 (surfaces, separations) N/m
    /contacts             int64   (surfaces, separations) 1
    /conductance          float64 (surfaces, separations) m   (times 1/rho)
    /nominal_separation   float64 (surfaces, separations) 1   (interaction)
    /joint_conductance    float64 (surfaces, separations) W/(m^2 K)   (and gap_conductance: joint)

With ``keep = "statistics"`` a file holds none of these tables: see `statistics_file`.

Every dataset has the attributes `units` and `long_name`; only quantities that the scene asks for are
there. Chunked, each chunk with a checksum (Fletcher); a table is shuffled and compressed with gzip if that
saves half of it (`chunks`). `digest` is over scene and data, `run` over what the
numbers of a surface depend on (scene but for the number of surfaces, sampler, and the versions in `draws`).
After the HDF5 data stand 512 bytes, the trailer: ``MCGWSEAL``, JSON padded with spaces (472 bytes), and the
SHA-256 of both (32 bytes). The JSON has the length and the SHA-256 of all bytes before it, and the digest of
the head (attributes, types, shapes, scales). That of the head is checked on every opening, that of all bytes
by ``mcgw show --verify``. Every HDF5 program reads such a file, and one that opens it for writing leaves the
trailer out, even if it writes nothing. The numbers of a file without one are compared with its `digest` when
it is opened: if they are whole, it is read, with a note, and if they are not, it is refused.

A run that fits one block is written in one atomic step. Any other grows as shards in ``FILE.parts/``, which
are merged at the end and then removed. What each mechanism is for:

``layout``       the schema above, written and read back
``chunks``       a table is compressed where that pays; packed chunks are copied as they are
``shards``       a killed run loses at most the blocks in hand; workers elsewhere share no open file
``run_folder``   a run goes on only with what it was begun with: scene, sampler, versions
``Plan``         which surfaces are drawn together, of a run or of all groups of a sweep
``identity``     which scenes, samplers and versions those are; and who made a file
``saving``       a file is made in memory, or of blocks under another name, and read back
``statistics_file``  that of scenes that keep statistics and no surface
``disk``         HDF5 may crash on a full disk, so it never sees its errors; the trailer of a whole file
``structure``    what a file may hold, looked at on every opening
``ensembles``    files and runs in progress opened, and verified
``lock``         two processes never write one file; shared by jobs that each make a share
``place``        what is there already: surfaces, a seed, and leftovers of the dead, which are cleared
"""
