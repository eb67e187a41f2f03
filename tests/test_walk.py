"""The compiled walk for Hertz's rows against the one for any law, given Hertz's formulas in NumPy."""

from dataclasses import replace

import numpy as np
import pytest

import analytic
import mcgw
from mcgw.sampling.cells import mesh_of
from mcgw.sampling.response.hertz_rows import hertz_rows
from mcgw.sampling.response.nodes import LAST_DIGITS, Nodes, Precision
from mcgw.sampling.response.rows import Start
from mcgw.sampling.response.tree import tree_over
from mcgw.sampling.response.walk import walk

SURFACE = analytic.Surface(sigma=1.37e-6, radius=1.3e-5, eta=3e8, nominal_area=1e-4, E_star=78.6e9)
QUANTITIES = ("load", "area", "stiffness", "conductance")
GRADINGS = {
    "homogeneous": analytic.Homogeneous(),
    "gamma 2": analytic.Exponential(2.0),
    "kinks": analytic.Table((-4.0, 0.0, 1.0, 4.0), (0.5, 1.0, 2.0, 1.5)),
}


class InNumpy:
    """``scale e^m (s - h)^n`` as it is written."""

    def __init__(self, rows):
        self.exponent, self.scale, self.graded = rows.formulas.exponent, rows.formulas.scale, rows.graded

    def values(self, rows, above, e):
        whole, half = np.divmod(self.exponent[rows], 1)
        power = np.where(half > 0, np.sqrt(above), 1.0)
        for times in range(3):
            power = np.where(whole > times, power * above, power)
        return self.scale[rows] * np.where(self.graded[rows], e, 1.0) * power

    def at_start(self, rows, above, e, u):
        values, (whole, half) = self.values(rows, above / u[:, None], e), np.divmod(self.exponent[rows], 1)
        return [
            Start(root, np.flatnonzero(here), values[:, here], whole[here])
            for root, here in ((False, half == 0), (True, half > 0))
        ]


def asked(grading, number, precision=LAST_DIGITS):
    h = tuple(np.linspace(0, 4, number))
    scene = mcgw.Scene(
        SURFACE,
        separations=h,
        grading=grading,
        quantities=QUANTITIES,
        n_asperities=10**5,
        n_surfaces=1,
        seed=1,
    )
    mesh = mesh_of(scene)
    tree = tree_over(mesh)
    return (
        mesh,
        tree,
        hertz_rows(scene, QUANTITIES, lasting=False),
        Nodes.of(mesh, tree, grading, 10**5, precision),
    )


def found(mesh, tree, rows, nodes):
    """Every series by its row and node, and the moments that it takes."""
    entries, plain, rooted = walk(mesh, tree, rows, nodes)
    ends = entries.start + entries.length
    places = zip(entries.row.tolist(), entries.node.tolist(), entries.rooted.tolist(), strict=True)
    pieces = [entries.coefficients[a:b].tobytes() for a, b in zip(entries.start, ends, strict=True)]
    return dict(zip(places, pieces, strict=True)), plain.tolist(), rooted.tolist()


@pytest.mark.parametrize("grading", GRADINGS.values(), ids=GRADINGS)
@pytest.mark.parametrize("number", [1, 7, 301])
@pytest.mark.parametrize("precision", [LAST_DIGITS, Precision(1e-4, of_least=True)])
def test_both_walks_find_the_same(grading, number, precision):
    """The same nodes for every row, and the same bits of every coefficient."""
    mesh, tree, rows, nodes = asked(grading, number, precision)
    assert found(mesh, tree, rows, nodes) == found(mesh, tree, replace(rows, formulas=InNumpy(rows)), nodes)


def test_another_formula_is_seen():
    """One whose last digit differs."""
    mesh, tree, rows, nodes = asked(analytic.Exponential(2.0), 7)
    other = InNumpy(rows)
    other.scale = np.nextafter(other.scale, np.inf)
    assert found(mesh, tree, rows, nodes) != found(mesh, tree, replace(rows, formulas=other), nodes)


@pytest.mark.parametrize("formulas", [lambda rows: rows.formulas, InNumpy])
def test_what_is_not_resolved_is_refused(formulas):
    """A grading too steep for the cells, and a row that begins inside one."""
    mesh, tree, rows, nodes = asked(analytic.Homogeneous(), 7)
    steep = replace(nodes, moduli=1 + 0.5 * np.sign(np.sin(40 * (nodes.start[:, None] + nodes.above))))
    with pytest.raises(ValueError, match="not resolved near s = "):
        walk(mesh, tree, replace(rows, formulas=formulas(rows)), steep)
    inside = rows.h + 1e-3
    with pytest.raises(ValueError, match=r"at s = 0.001 is not an edge"):
        walk(mesh, tree, replace(rows, h=inside, low=inside, formulas=formulas(rows)), nodes)
