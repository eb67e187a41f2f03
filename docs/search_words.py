"""Words that people type, and the pages that answer: main entries of the index, found first."""

from typing import Any

WORDS = {
    "tutorials/first-contact": "install, getting started, example",
    "tutorials/map-to-conductance": "height map, coating, profilometer, AFM",
    "tutorials/own-material": "graded material, nanoindentation, own contact law, modulus",
    "how-to/cluster": "Slurm, Snakemake, dask, MPI, job array, interrupted run, resume",
    "how-to/coming-from": "Greenwood Williamson, tamaas, ContactMechanics, SurfaceTopography",
    "how-to/conductance-of-a-joint": "thermal contact resistance, thermal contact conductance,"
    " contact resistance, gap conductance, electrical contact resistance, vacuum, gas, air, oxide, TIM",
    "how-to/elastic-means": "boundary elements, half-space, multilevel",
    "how-to/generate-surfaces": "synthetic surface, random surface, power spectrum, Hurst exponent",
    "how-to/known-load": "pressure, load, separation, stiffness, real area, mean gap",
    "how-to/law-for-a-joint": "plastic, plasticity, plasticity index, yield, hardness, adhesion, contact law,"
    " metal, hysteresis, unloading, JKR, DMT, Kogut Etsion, Jackson Green, CMY, Hertz",
    "how-to/measured-map": "missing points, height map, spikes, outliers, cutoff, filter, SDF, X3P, lay",
    "how-to/monte-carlo-against-theory": "paper figures, residuals, compare, chi-square",
    "how-to/numbers-of-iso": "ISO 25178, Sq, Sdq, Spd, Spc, two rough surfaces, several maps",
    "how-to/profiles-and-ra": "Ra, Rq, profile, stylus, ISO 4287",
    "how-to/report": "report, reproducible, provenance, digest",
    "how-to/speed-and-accuracy": "how many surfaces, sample size, speed, memory, sampler",
    "how-to/statistical-convergence": "convergence, convergence test, coverage, statistical power",
    "how-to/sweeps": "sweep, parameter study, paired difference",
    "how-to/tables-for-other-programs": "Abaqus, CalculiX, COMSOL, MOOSE, finite elements, gap conductance",
    "how-to/units": "units, inch, SI",
    "how-to/which-model": "spectrum, bandwidth, which model, roughness",
    "how-to/xarray-and-pandas": "pandas, xarray, HDF5, csv, NetCDF",
    "explanation/contact-laws": "hysteresis, unloading, friction, tangential load, JKR, Kogut Etsion, Hertz",
    "explanation/how-finite": "specimen, scatter, distribution, quantile",
    "explanation/interaction": "interaction, mean plane, half-space",
    "explanation/roughness": "roughness, Ra, Rq, Nayak, spectral moments",
    "explanation/same-bits": "seed, random numbers, reproducible, threads",
    "explanation/theory": "grading, equations, Greenwood Williamson, closed form",
    "explanation/validity": "validity, model error, friction, limits",
}  # fmt: skip


def add_words(_: Any, page: str, source: list[str]) -> None:
    """Append the words of a page to its text, as it is read."""
    if page in WORDS:
        entries = ", ".join(f"! {word}" for word in WORDS[page].split(", "))
        source[0] += f"\n```{{index}} {entries}\n```\n"


def read_all(_: Any, env: Any, *__: Any) -> list[str]:
    """Return all pages, to be read in every build: Sphinx forgets the index entries of the others."""
    return sorted(env.found_docs)
