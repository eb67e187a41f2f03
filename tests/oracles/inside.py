"""Inner names of the product that several files of tests ask for: a module that moves changes this file.

Each module is imported when the first of its names is asked for.
"""

from importlib import import_module
from typing import Any

MODULES = {
    "analytic.integrals": "fn_scaled",
    "mcgw.elasticity.grid": "Grid",
    "mcgw.elasticity.levels": "alone Level LEVELS located Pressed rimless",
    "mcgw.elasticity.located": "balanced beyond_point interaction",
    "mcgw.elasticity.multilevel": "Design design difference Mean mean_of terms_of",
    "mcgw.elasticity.sources": "maps_of",
    "mcgw.elasticity.spots": "fallen Spots",
    "mcgw.ensemble.at_load": "mean_surface pressures_of",
    "mcgw.ensemble.drawing": "block_size kept reducer_of Statistics Values",
    "mcgw.ensemble.intervals": "count_interval exact_ends FEWEST pearson3_quantile Spread spread_of TOO_FEW",
    "mcgw.ensemble.results": "Held Results",
    "mcgw.ensemble.separation": "Asperities crossing",
    "mcgw.ensemble.forecast": "after before checkpoints forecast in_words rough_seconds upper_contacts",
    "mcgw.ensemble.solution": "solutions",
    "mcgw.figures.catalogue": "CATALOGUE figures_of",
    "mcgw.figures.compared": "_ratio Compared",
    "mcgw.figures.panels": "draw FigureData GAMMA Panel save Series",
    "mcgw.figures.studies": "comparison_figure quantity_panel convergence_figure spread spread_panel "
    "tradeoff_figure",
    "mcgw.figures.style": "FAMILIES look PAIRS power_of_ten prefixed save_figure short STYLE THEORY",
    "mcgw.formats.files": "alive check_output LOCK_FILES parts_of state_of whole_file write_whole",
    "mcgw.formats.gate": "check_archive open_h5 opened",
    "mcgw.formats.named_files": "loads loads_json open_npy read_text",
    "mcgw.machine.terminal": "brief listed",
    "mcgw.formats.table": "Column digits_of evenly joined stacked Table typeset",
    "mcgw.formats.units": "_FACTORS EXAMPLES METRES parse",
    "mcgw.jobs.executors": "dask_executor drive Jobs",
    "mcgw.jobs.blocks": "_merged commit_block",
    "mcgw.jobs.running": "share_of",
    "mcgw.machine.threads": "THREADS use_threads",
    "mcgw.machine.process": "check_memory heed_signals memory_available Signals",
    "mcgw.maps.envelope": "envelope hidden_summits",
    "mcgw.maps.estimates": "_unhidden by_caps by_summits SUMMITS visible",
    "mcgw.maps.fit": "fit_prepared",
    "mcgw.maps.fit_cautions": "profile_cautions",
    "mcgw.maps.form": "gaussian_transmission lowpass smooth without_form without_offsets",
    "mcgw.maps.topography": "filter_variance",
    "mcgw.maps.preparation": ("filled Preparation prepared recorded small_spike_heights spike_heights"),
    "mcgw.maps.fitted_scene": "write_scene",
    "mcgw.maps.summit_sums": "coarse_sums_of summit_sums_of Summits SUMS variation",
    "mcgw.reports.plan": "plan_text",
    "mcgw.reports.html": "pressure_panels report_html round_pressures solved_pressures svg_of",
    "mcgw.reports.text": "comparison_text correlation solutions_text summary",
    "mcgw.sampling.asperities": "summits summits_drawn worst_of_values",
    "mcgw.sampling.samplers": "sampler_of",
    "mcgw.scene.cautions": "cautions",
    "mcgw.scene.keys": "KEYS SURFACE_UNITS",
    "mcgw.scene.ensemble": "PROMISES SAMPLERS",
    "mcgw.scene.surface": "perhaps_other_units RANGES surface_in_other_units",
    "mcgw.scene.scene": "Scene storable",
    "mcgw.statistics.checks": (
        "covariances coverage independence PrincipalComponents scores skewness Slope variances"
    ),
    "mcgw.statistics.comparison": "compare Comparison Points",
    "mcgw.statistics.convergence": "_own converge Convergence",
    "mcgw.statistics.measured_ways": "Point Task",
    "mcgw.statistics.tradeoff": "Rung Tradeoff worth",
    "mcgw.statistics.ways": "advise of_one sampled_ways surfaces_for WANTS wants_of Way",
    "mcgw.statistics.verdict": "Check FALSE_ALARM verdict",
    "mcgw.store.ensembles": "LARGE open_results read_attributes verify",
    "mcgw.store.h5_reading": "attributes_in checksum_of MOST_TEXT read_rows read_tables table_names",
    "mcgw.store.h5_writing": "CHUNK_ROWS",
    "mcgw.store.ownership": "another locked LockedError PATIENCE",
    "mcgw.store.place": "put tidy",
    "mcgw.store.run_plan": "blocks_of commit_shard Plan RECORD Span",
    "mcgw.sweeps.axes": "axes_of label",
    "mcgw.sweeps.points": "_ROWS Group sweep_cautions",
}
HOME = {name: module for module, names in MODULES.items() for name in names.split()}


def __getattr__(name: str) -> Any:
    if name not in HOME:
        raise AttributeError(name)
    return getattr(import_module(HOME[name]), name)


def home(name: str) -> Any:
    """Return the module that has a name, for a test that puts something in its place."""
    return import_module(HOME[name])
