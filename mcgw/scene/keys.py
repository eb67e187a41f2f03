"""Every key of a scene, one row each: source of reader, writer, checks, schema, page and ``--set``."""

import math

import analytic
from analytic.laws import ContactLaw
from analytic.laws.custom import RootSeries
from mcgw.scene.contact import Contact, Joint
from mcgw.scene.ensemble import Sampling
from mcgw.scene.kinds import FLAG, Either, List, Number, Plain, Table, Whole, Word
from mcgw.scene.laws import LAWS, evenly, grading_given, heights_given
from mcgw.scene.measured import KNOWN, SUMMITS, Fitted, Uncertainty
from mcgw.scene.section import Key, rows_of

_MOST = 100_000
POISSON = Number(low=-1.0, high=0.5)
_ANY, _POSITIVE = Number(low=-math.inf), Number()
YOUNG = Number("Pa", infinite=True)
_RADII = List(_POSITIVE, advice="give a list of finite numbers > 0")
_LISTED = List(_ANY)
_SEPARATIONS = "give a list of finite numbers d/sigma, or {start = 0.0, stop = 4.0, num = 41}"
_NUM = Whole(1, _MOST, f"give a whole number >= 1, at most {_MOST}")
_PLANES = '"body", the undeformed body, or "mean-plane", that of the deformed one'
_FORMULA = "give a list of {edges, coefficients}, one for each piece, as mcgw writes them"
_LISTS = List(_LISTED, advice="give a list of lists of finite numbers")
_SERIES = (Key("edges", _LISTED, required=True), Key("coefficients", _LISTS, required=True))
_PIECES = List(Table(_SERIES, _FORMULA, RootSeries), advice=_FORMULA)
_PIECES_EXAMPLE = (
    "[{edges = [-1.0, 1.0], coefficients = [[1.0]]}, {edges = [0.0, 1.1], coefficients = [[1.0]]}]"
)
_ERRORS = Table(rows_of(Uncertainty), KNOWN, Uncertainty)
BODY = Table((Key("E", YOUNG, required=True), Key("nu", POISSON, default=0.3)), "", analytic.Body)
_BODY_OF_FILE = Table((Key("file", Plain(), required=True),), "")
_GRADING = "mcgw.Exponential(gamma), mcgw.Table(s, ratio), or a function of an array of heights"
_HEIGHTS = "mcgw.HeightTable.of(heights), or a frozen continuous distribution, scipy.stats.lognorm(0.3)"
_OWN_LAW = "a law; your own law is mcgw.CustomLaw(load=..., area=..., ...)"
_RADII_LAWS = analytic.RandomCurvature | analytic.MeasuredRadii
# fmt: off
TABLES: dict[str, Table] = {
"": Table((
    Key("title", Plain(empty=True), '"My surface"', "title of figures and reports", ""),
)),
"surface": Table(words="Either `sigma`, `radius`, `eta`, or the spectrum by `m0`, `m2`, `m4`; either "
    "`E_star` or `bodies`.", advice="mcgw.Surface(sigma, radius, eta, nominal_area, E_star)", rows=(
    Key("sigma", Number("m"), "1.37e-6", required=True),
    Key("radius", Number("m"), "13e-6", required=True),
    Key("eta", Number("1/m^2"), "3.0e8", required=True),
    Key("nominal_area", Number("m^2"), "1e-4", required=True),
    Key("E_star", Number("Pa"), "78.6e9", required=True),
    Key("bodies", List(Either((BODY, _BODY_OF_FILE)), 2, 2,
        "give two, such as [{E = 70e9, nu = 0.33}, {E = inf}], each with its E in Pa"),
        "[{E = 70e9, nu = 0.33}, {E = inf}]",
        "instead of `E_star`: Young's modulus (Pa) and Poisson's ratio (default: 0.3) of the two bodies. Or "
        '`[{file = "a.toml"}, {file = "b.toml"}]`, instead of all keys but `nominal_area`: [two rough '
        "bodies](../how-to/numbers-of-iso.md#two-rough-bodies), each the scene of one on a rigid plane",
        excludes=("E_star",)),
    Key("m0", Number("m^2"), "1e-12", required=True, needs=("m2",), excludes=SUMMITS),
    Key("m2", Number("1"), "1e-3", required=True, needs=("m4",)),
    Key("m4", Number("1/m^2"), "5e6", required=True, needs=("m0",)),
    Key("uncertainty", _ERRORS, '{sigma = "20 %", radius = "15 %", eta = "12 %"}',
        "standard errors of `sigma`, `radius`, `eta` (or of `m0`, `m2`, `m4`) and `E_star`, relative to the "
        "values, with their `correlation` in this order, if any; `mcgw fit` writes them, and `mcgw solve` "
        "includes them in its error"),
), required=True),
"grading": Table(words="E*(s)/E* over the reduced height s. Default: 1 at every height.", rows=(
    Key("law", Word((*LAWS["grading"],), "", grading_given, _GRADING), '"exponential"',
        "`homogeneous`, `exponential` (Eq. 4), `table` or `series`; default: `exponential` if there is a "
        "`gamma`, otherwise `homogeneous`", "homogeneous"),
    Key("gamma", _ANY, "0.5", "γ of E*(s)/E* = γ − (γ − 1) exp(−s)"),
    Key("negative", Word(("error", "clip", "allow")), '"clip"', default="error"),
    Key("s", _LISTED, "[0.0, 1.0]", needs=("ratio",), excludes=("file",)),
    Key("ratio", _LISTED, "[1.0, 2.0]", needs=("s",)),
    Key("file", Plain(advice="give a CSV file, or lists s and ratio"), '"moduli.csv"',
        "a CSV table beside the scene: columns `s` or `z` (m), and `ratio` or `E_star` (Pa); other units in "
        "the header, `z (um)`, or after a number, `61.2 GPa`"),
    Key("edges", _LISTED, "[0.0, 5.0, 20.0]"),
    Key("coefficients", _LISTS, "[[1.0, 0.5], [1.5]]"),
    Key("kinks", List(_ANY, 0), "[5.0]"),
    Key("name", Plain(empty=True), '"ramp"', "name of the function, for display"),
    Key("checked", FLAG, "false", "`false`: a series far from 1 at all heights that touch is meant so",
        True),
)),
"heights": Table(words="Distribution of the summit heights, scaled to mean 0 and standard deviation 1. "
    "Default: Gaussian.", rows=(
    Key("law", Word((*LAWS["heights"],), "", heights_given, _HEIGHTS), '"weibull"',
        "`gaussian`, `exponential`, `weibull`, `nayak`, `table` or `scipy`", "gaussian"),
    Key("shape", Number(low=1, high=100, advice="give a number from 1 to 100 (3.6 has no skewness)"), "2.0",
        "shape of the Weibull law, 1 to 100; 3.6 has no skewness"),
    Key("alpha", Number(low=1.501, high=1e12,
                        advice="give a number from 1.501 to 1e12, m0 m4/m2^2 of the surface"), "5.0",
        "α = m0 m4/m2² of the surface for Nayak's law, above 1.5"),
    Key("heights", _LISTED, "[0.0, 1.0, 3.0]", "measured heights of a `table`, in any unit",
        excludes=("file", "s")),
    Key("file", Plain(advice="give a list of heights, a file of them, or points s and share"),
        '"heights.csv"', "the same from a file beside the scene: `.npy`, or text with one per line",
        excludes=("s",)),
    Key("resample", FLAG, "true",
        "`true` (default): drawn from the measured distribution; `false`: one surface, as they are",
        needs=("heights", "file")),
    Key("s", _LISTED, "[0.0, 1.0]", needs=("share",)),
    Key("share", _LISTED, "[0.0, 1.0]", needs=("s",)),
    Key("name", Plain(), '"gamma"', 'name of a continuous distribution of `scipy.stats`, for `law = "scipy"`',
        "norm"),
    Key("shapes", Table(item=_ANY, advice="give its shapes, such as {a = 4.0}"), "{a = 4.0}",
        "its shape parameters"),
)),
"summits": Table(words="Radii of the summits, if they differ.", rows=(
    Key("curvature", Word(("random", "mean"), "", lambda x: x if isinstance(x, _RADII_LAWS) else None,
        "mcgw.MeasuredRadii(heights, ratios)"), '"random"',
        "`random`: the radius of each summit follows the exact joint distribution with its height (default "
        "with `m0`, `m2`, `m4`); `mean`: one radius"),
    Key("largest_radius", Number("m"), '"1 mm"', "upper limit of the radii, m"),
    Key("file", Plain(advice="give a CSV file of heights and radii, or lists of both"), '"summits.csv"',
        "measured summits, written by `mcgw fit --summits`: columns `height`, `radius`, m",
        excludes=("heights", "radii", "ratios", "curvature", "largest_radius")),
    Key("heights", _LISTED, "[0.0, 1e-6, 3e-6]", "the same in the scene itself: heights, m",
        needs=("radii", "ratios"), excludes=("curvature", "largest_radius")),
    Key("radii", _RADII, "[1e-5, 2e-5, 3e-5]", "and radii, m", needs=("heights",), excludes=("ratios",)),
    Key("ratios", _RADII, "[1.0, 2.0, 3.0]", "or radii over their mean", needs=("heights",)),
    Key("resample", FLAG, "true",
        "`true`: summits drawn in pairs from the list; `false`: one surface, the summits as they are", False,
        needs=("heights", "file")),
)),
"contact": Table(words="Separations, and what is computed of the contacts.", rows=(
    Key("separations",
        Either((
            List(Number(low=-1e6, high=1e6), 1, _MOST, f"{_SEPARATIONS}, at most {_MOST} of them"),
            Table((Key("start", _ANY, required=True), Key("stop", _ANY, required=True),
                   Key("num", _NUM, required=True)), _SEPARATIONS, evenly),
            Number(low=-1e6, high=1e6, advice=_SEPARATIONS),
        ), _SEPARATIONS),
        "{start = 0.0, stop = 1.0, num = 3}", "d/σ: a range, a list, or one number", required=True),
    *rows_of(Contact),
), required=True, make=Contact, advice="mcgw.Contact(...)"),
"contact.law": Table(words="Contact law of an asperity, and its constants: [how the laws "
    "differ](../explanation/contact-laws.md). A law without constants may stand under `[contact]` as a word: "
    "`law = \"hertz\"`. Default: Hertz's.", rows=(
    Key("name", Word((*LAWS["contact.law"],), "",
        lambda given: given if isinstance(given, ContactLaw) else None, _OWN_LAW),
        '"kogut-etsion"',
        "`hertz` (default), `power-law-graded`, `coated`, `chang-etsion-bogy`, `zhao-maietta-chang`, "
        "`kogut-etsion`, `jackson-green`, `derjaguin-muller-toporov`, `johnson-kendall-roberts` or `custom`",
        "hertz"),
    Key("hardness", Number("Pa"), '"1.2 GPa"', "hardness of the softer body, Pa, for elastic-plastic laws; "
        "under an elastic law it only tells whether contacts yield"),
    Key("poisson", POISSON, "0.3", "Poisson's ratio of the body that yields or coats"),
    Key("critical", _POSITIVE, "0.05"),
    Key("yield_strength", Number("Pa"), '"400 MPa"'),
    Key("yield_strain", _POSITIVE, "0.004"),
    Key("bridge", Word(("hermite",)), '"hermite"'),
    Key("k", _POSITIVE, "0.5"),
    Key("c0", Number("m"), '"10 um"'),
    Key("reduced_c0", _POSITIVE, "1.0"),
    Key("thickness", Number("m"), '"1 um"', "thickness of the coating, m"),
    Key("reduced_thickness", _POSITIVE, "0.5", "the same over sqrt(R sigma), the form used in files"),
    Key("ratio", _POSITIVE, "3.0"),
    Key("work", Number("J/m^2"), '"0.05 J/m^2"'),
    Key("pull_off", _POSITIVE, "0.1", "instead of `work`: stretch over σ at which contacts break off"),
    Key("limits", List(_POSITIVE, 0, advice="give a list of numbers > 0 that increase"), "[1.0]"),
    Key("load", _PIECES, _PIECES_EXAMPLE),
    Key("area", _PIECES, _PIECES_EXAMPLE),
    Key("checked", FLAG, "false", "`false`: a law far from Hertz's at all penetrations is meant so", True),
),),
"interaction": Table(words="[Asperity interaction](../explanation/interaction.md). Default: asperities are "
    "independent.", rows=(
    Key("reference", Word(("body", "mean-plane"), f"give {_PLANES}"), '"body"', required=True),
    Key("bulk_modulus", Number("Pa"), "1e11"),
),
    advice='mcgw.Interaction("body")'),
"joint": Table(words="Conduction: through spots alone as in vacuum, or [a thermal "
    "joint](../how-to/conductance-of-a-joint.md), in which gas conducts beside them, and both in series with "
    "the bodies where `[interaction]` has them constrict the flux. Default: only `conductance`, without a "
    "unit.", rows=rows_of(Joint), make=Joint,
    advice='mcgw.Joint((150.0, 16.0), gas="air")'),
"fitted": Table(words="More about the fitted map, written by `mcgw fit`. It does not affect the results, but "
    "the stated [error of the model](../explanation/validity.md). Default: the surface is assumed to be "
    "Gaussian.", rows=rows_of(Fitted), make=Fitted, advice="the `fitted` of a scene from mcgw.fitted_scene"),
"ensemble": Table(words="Number of surfaces, and sampling.", rows=rows_of(Sampling), make=Sampling,
    advice="mcgw.Sampling(...)"),
}
# fmt: on

KEYS = {name: {row.name: row for row in table.rows} for name, table in TABLES.items()}
SURFACE_UNITS = {name: KEYS["surface"][name].kind.unit for name in (*SUMMITS, "nominal_area", "E_star")}
_PLACES = [name.rpartition(".") for name in TABLES if name]
INSIDE = {name: [inner for outer, _, inner in _PLACES if outer == name] for name in TABLES}
