"""``mcgw show --plan``: what would be drawn, and what not."""

import numpy as np
import pytest

import analytic
from mcgw.reports.plan import plan_of, plan_text
from mcgw.sampling.samplers import sampler_of


def test_plan_says_what_is_drawn(make_scene):
    scene = make_scene(separations=(1.0, 2.0), n_asperities=10**5, sampler="cells")
    plan = plan_of(scene)
    expected = 10**5 * float(analytic.fn(0, 1.0))
    assert plan.touching == pytest.approx(expected, rel=1e-12)
    drawn = sampler_of(scene).block(0, 64)
    assert drawn.counts.sum() / 64 == pytest.approx(expected, abs=5 * np.sqrt(expected / 64))
    assert (plan.cells, plan.moments) == (drawn.counts.shape[1], drawn.moments.shape[1])
    assert plan.bytes == 8 * 200 * 2 * 4
    assert plan.seconds > 0
    text = plan_text(scene, plan)
    assert "lie below every separation and are not drawn" in text
    assert "conductance: not asked for" in text
    assert "time          about" in text


def test_plan_counts_what_is_kept_and_says_who_chose(make_scene):
    """Bytes of the sums, and of moments and cells where they are kept; auto is named where it chose."""
    scene = make_scene(sampler="cells", keep="moments", separations=(1.0, 2.0))
    plan = plan_of(scene)
    drawn = sampler_of(scene).block(0, 1)
    assert plan.bytes == 8 * 200 * (2 * 4 + drawn.moments.shape[1] + drawn.counts.shape[1])
    alone = scene.replace(keep="statistics", n_surfaces=10**6)
    kept = plan_of(alone)
    assert kept.bytes < 8 * 10**6  # not even one value of each surface
    assert f"statistics alone, about {kept.bytes / 1e6:.4g} MB" in plan_text(alone, kept)
    assert "chosen by auto" not in plan_text(scene, plan)
    assert "sampler       cells" in plan_text(scene, plan)
    assert "chosen by auto" in plan_text(make_scene(sampler="auto"), plan)
    text = plan_text(scene, plan)
    assert f"touching      {plan.touching:.4g} of a surface, at the lowest d/sigma = 1" in text
    assert f"results       {plan.bytes / 1e6:.4g} MB" in text
    assert f"  {3000 - plan.touching:.4g} asperities of a surface lie below" in text


def test_contacts_alone_draw_no_height(make_scene):
    scene = make_scene(quantities=("contacts",), sampler="cells")
    plan = plan_of(scene)
    assert plan.moments == 0
    assert plan.drawn < 0.1  # what lies beyond the last cell is drawn one by one
    assert "no height is drawn" in plan_text(scene, plan)


def test_samplers_that_draw_all_and_hardly_any(make_scene):
    assert plan_of(make_scene(sampler="direct", separations=(1.0, 2.0), n_asperities=300)).drawn == 300
    huge = plan_of(make_scene(sampler="aggregate", n_asperities=10**15))
    assert huge.moments <= huge.drawn < huge.moments + 0.1
    assert huge.moments < 5000
    assert plan_of(make_scene(rel_err=0.01, n_surfaces=10**6, separations=(0.0,))).surfaces < 10**6
