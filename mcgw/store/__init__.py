"""Ensembles as HDF5 files, and the folders of the runs that make them.

A file appears whole or not at all. Its schema (``filetype = "mcgw-ensemble"``, ``format = [1, 1]``)::

    /                     attributes: filetype, format, title, scene (TOML text of the resolved scene),
                          seed, sampler, complete, digest, versions, draws, run, commit, date, cpu,
                          wall_seconds
    /surface              int64 (surfaces,)               dimension scale: numbers of the surfaces
    /separation           float64 (separations,)          dimension scale: d/sigma
    /load                 float64 (surfaces, separations) N
    /area                 float64 (surfaces, separations) m^2
    /stiffness            float64 (surfaces, separations) N/m
    /contacts             int64   (surfaces, separations) 1   (float64 expectation if stratified)
    /conductance          float64 (surfaces, separations) m   (times 1/rho)

and, if the scene says ``keep = "moments"``, what `mcgw.ensemble.regrading` starts from::

    /drawn/moments        float64 (surfaces, moments)     sums of Chebyshev polynomials, cell by cell
    /drawn/cells          float64 (surfaces, cells)       asperities in each cell
    /drawn/extras         float64 (extras, 3)             surface, height, weight of those outside

Every dataset has the attributes `units` and `long_name`; only quantities that the scene asks for are
there. Chunked, shuffled, compressed with gzip, each chunk with a checksum (Fletcher). `digest` is over
scene and data, `run` over what the numbers of a surface depend on (scene but for the number of surfaces,
sampler, and the versions in `draws`). After the HDF5 data stand 512 bytes, the trailer (`trailer`), with the
digest of the file's bytes and that of its head (`head`: attributes, types, shapes, scales). That of the
head is checked on every opening, that of all bytes by ``mcgw show --verify``; files of format 1.0 have
none of the head.

A run that fits one block is written in one atomic step. Any other grows as shards in ``FILE.parts/``
(`rundir`), which are merged at the end (`merge`) and then removed. Whoever writes the file, in whatever way,
holds the lock in that folder (`lock`); what a killed process leaves there is cleared by the next command
(`leftovers`).
"""
