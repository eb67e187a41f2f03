"""Results as HDF5 files, and the folders of the runs that make them.

A file appears whole or not at all. All have one layout (``filetype = "mcgw-results"``, ``format = [3, 0]``),
which reads

==========================  ========================================  ========================
of                          holds                                     opened by
==========================  ========================================  ========================
a scene                     values of every surface, as below         `mcgw.open_ensemble`
``keep = "statistics"``     statistics over them (`layout`)           `mcgw.open_ensemble`
a sweep: attribute `axes`   statistics with the dimension `point`     `mcgw.open_sweep`
any earlier format                                                    no reader: run it again
==========================  ========================================  ========================

Of a scene::

    /                     attributes: filetype, format, title, scene (TOML text of the resolved scene),
                          seed, sampler, digest, checksum, versions, draws, run, commit, date, cpu,
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

With ``keep = "statistics"`` a file holds none of these tables: see `layout`.

Every dataset of these has the attributes `units` and `long_name` (texts of a set length, UTF-8); only
quantities that the scene asks for are there. Chunked, each chunk with a checksum (Fletcher); a table is
shuffled and compressed with gzip if that saves half of it (`h5_writing`). `run` is over what the numbers of a
surface depend on (scene but for the number of surfaces, sampler, and the versions in `draws`), `digest`
over scene and numbers: it is the same whoever drew them, and when. Every table has the attribute `sha256`,
over its numbers, and the root `checksum`, over all attributes above, types, shapes and these (`h5_writing`).
That is checked whenever a file is opened, and all numbers as well if it is smaller than a gibibyte; else
by ``mcgw show --verify``. A file that another program has opened for writing, or written anew with the
same contents, is as good.

A run that fits one block is written in one atomic step. Any other grows as shards in ``FILE.parts/``, which
are merged at the end and then removed. What each mechanism is for:

``h5_writing``   the one writer of files, shards and records, and their checksums; HDF5 sees no full disk
``h5_reading``   the one reader: plain tables of numbers alone, looked at on every opening
``layout``       what a file of the schema above holds, and of scenes that keep no surface
``ensembles``    files and runs in progress opened, and verified
``run_folder``   which surfaces are drawn together; a killed run loses at most the blocks in hand
``identity``     which scenes, samplers and versions those are; and who made a file
``lock``         two processes never write one file; shared by jobs that each make a share
``place``        what is there already, leftovers of the dead, and a new file: renamed when it is whole
"""
