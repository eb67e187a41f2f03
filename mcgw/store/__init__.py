"""Results as HDF5 files, and the folders of the runs that make them.

A file appears whole or not at all. All have one layout (``filetype = "mcgw-results"``, ``format = [4, 0]``):
tables of numbers with dimensions, units and long names. Values of every surface are in the file of a scene;
with ``keep = "statistics"``, and of a sweep, statistics over the surfaces are there instead, and in one group
what these are made of. Earlier formats have no reader: run the scene again. ::

    /                     attributes: filetype, format, title, scene (TOML text of the resolved scene; of a
                          sweep what its points come from), axes (of a sweep, JSON), seed, sampler, digest,
                          checksum, versions, draws, run, commit, date, cpu, wall_seconds, coordinates
    /surface              int64 (surfaces,)               dimension scale: numbers of the surfaces
    /separation           float64 (separations,)          dimension scale: d/sigma
    /load                 float64 (surfaces, separations) N
    /area                 float64 (surfaces, separations) m^2
    /stiffness            float64 (surfaces, separations) N/m
    /contacts             int64   (surfaces, separations) 1
    /conductance          float64 (surfaces, separations) m   (times 1/rho)
    /nominal_separation   float64 (surfaces, separations) 1   (interaction)
    /joint_conductance    float64 (surfaces, separations) W/(m^2 K)   (and gap_conductance: joint)

Where no surface is kept::

    /load_mean, /load_std float64 (axes ..., separations) N   (and so on for each quantity)
    /column, /other_column int64 (columns,)               dimension scales of (of one scene)
    /covariance           float64 (columns, columns)      between all quantities and separations: its
                                                          long_name tells their order
    /gamma                float64 (values,)               an axis of a sweep, by the last word of its key;
                                                          words are numbered, as its long_name tells
    /point                int64 (points,)                 the one axis of a sweep of zipped keys
    /drawn/n              int64 (parts, 2)                surfaces, and numbers of each: of whole blocks and
                                                          the rest, or of groups of points
    /drawn/load_means     float64 (numbers, separations)  of all parts, one after the other (of one scene
                                                          numbers_means and numbers_products)
    /drawn/load_products  float64 (pairs, separations)    sums of products of deviations, all pairs of each
    /drawn/points         int64 (points, 3)               of a sweep: group, one or two of its numbers, or -1
    /drawn/weights        float64 (points, 2)             of these, for what the modulus enters

Every dataset of these has the attributes `units` and `long_name` (texts of a set length, UTF-8); only
quantities that the scene asks for are there. Chunked, each chunk with a checksum (Fletcher); a table is
shuffled and compressed with gzip if that saves half of it (`h5_writing`). `run` is over what the numbers of a
surface depend on (scene but for the number of surfaces, sampler, axes, and the versions in `draws`), `digest`
over scene and numbers: it is the same whoever drew them, and when. Every table has the attribute `sha256`,
over its numbers, and the root `checksum`, over all attributes above, types, shapes and these (`h5_writing`).
That is checked whenever a file is opened, and all numbers as well if it is smaller than a gibibyte; else
by ``mcgw show --verify``. A file that another program has opened for writing, or written anew with the
same contents, is as good.

A run that fits one block is written in one atomic step. Any other grows as shards in ``FILE.parts/``, which
are merged at the end and then removed. What each mechanism is for:

``h5_writing``   the one writer of files, shards and records, and their checksums; HDF5 sees no full disk
``h5_reading``   the one reader: plain tables of numbers alone, looked at on every opening
``run_plan``     what is drawn into a file, in which blocks, and where these lie: a kill loses those in hand
``ownership``    two processes never write one file; a run goes on by the same scene, sampler, versions
``ensembles``    files and runs in progress opened, and verified
``place``        what is there already, leftovers of the dead, and a new file: renamed when it is whole
"""
