"""A report of an ensemble: one HTML page that needs no network and no script."""

import io
import re
from html import escape
from string import Template
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from analytic import quantity_of
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.intervals import TOO_FEW
from mcgw.figures.comparison import quantity_figure
from mcgw.figures.data import FigureData, Panel, Points, Series
from mcgw.figures.drawing import draw
from mcgw.figures.style import STYLE, grading_label
from mcgw.formats.evenly import evenly
from mcgw.formats.pictures import write_figure
from mcgw.machine.terminal import one_line, plain_text
from mcgw.reports.elasticity import elasticity_section
from mcgw.reports.laws_section import contacts_sentence, laws_section, yielding_item
from mcgw.reports.text import verdict_line
from mcgw.scene.cautions import cautions
from mcgw.scene.contact_text import contact_facts
from mcgw.statistics.comparison import Comparison, compare

__all__ = ["report_html"]

_MOST_ROWS = 9
_STYLE = """
:root { color: #1a1a1a; background: #fff; font: 16px/1.5 system-ui, sans-serif; }
body { max-width: 68rem; margin: 0 auto; padding: 1rem; }
h1 { font-size: 1.6rem; line-height: 1.2; margin: .5rem 0; }
h2 { font-size: 1.2rem; margin: 2rem 0 .5rem; border-bottom: 1px solid #bbb; }
h3 { font-size: 1rem; margin: 0 0 .25rem; }
p, li { max-width: 44rem; }
.verdict { border-left: 6px solid #009e73; padding: .5rem .8rem; background: #f2f7f5; max-width: 44rem; }
.verdict.bad { border-color: #d55e00; background: #fbf1ea; }
.grid { display: grid; gap: 1rem 2rem; }
.grid { grid-template-columns: repeat(auto-fit, minmax(min(100%, 21rem), 1fr)); }
figure { margin: 0; }
svg { width: 100%; height: auto; max-width: 34rem; }
table { border-collapse: collapse; font-size: .85rem; font-variant-numeric: tabular-nums; }
th, td { padding: .15rem .5rem .15rem 0; text-align: right; white-space: nowrap; }
tr { border-bottom: 1px solid #e4e4e4; }
th:first-child, td:first-child { text-align: left; white-space: nowrap; }
.facts td:first-child { padding-right: 1rem; overflow-wrap: normal; }
.facts td, .facts td:first-child { text-align: left; white-space: normal; vertical-align: top; }
.facts td { overflow-wrap: anywhere; }
pre { background: #f5f5f5; padding: .6rem; overflow-wrap: anywhere; white-space: pre-wrap; font-size: .8rem; }
@media print {
  body { max-width: none; padding: 0; }
  figure, table, .verdict { break-inside: avoid; }
  h2, h3 { break-after: avoid; }
  .grid { grid-template-columns: 1fr 1fr; }
}
"""
_PAGE = Template("""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<link rel="icon" href="data:,">
<title>$title</title>
<style>$style</style>
</head>
<body>
<h1>$title</h1>
<p>$words</p>
<p class="verdict$bad">$verdict<br>
$elastic</p>
<h2>Means and theory</h2>
<p>Markers: mean over the surfaces with its 95 % interval. Line: exact mean. Below: their difference in exact
standard errors of the mean; the grey band is ±2.</p>
<div class="grid">$figures</div>
<h2>Tables</h2>
<p>In brackets: half of the 95 % interval of the mean, in its last digits;
residual in standard errors.</p>
<div class="grid">$tables</div>
<h2>The surface</h2>
<table class="facts">$facts</table>
$laws$elasticity<h2>Before you trust it</h2>
<ul>$cautions
$yielding</ul>
<h2>Provenance</h2>
<table class="facts">$provenance</table>
<h2>Do it again</h2>
<p>Save the scene below as <code>scene.toml</code>; the digest of what it gives is the one above.</p>
<pre>mcgw run scene.toml -o again.h5
mcgw show again.h5 --digest
mcgw compare again.h5</pre>
<pre>$scene</pre>
</body>
</html>
""")


def report_html(ensemble: Ensemble, attributes: dict[str, Any]) -> str:
    """The page of an ensemble and of the attributes of its file: scene, digest, versions, ...

    Raises
    ------
    ValueError
        If the surfaces are stratified, which are no ensemble.
    """
    comparison, against = compare(ensemble), ensemble.scene.validity()
    names = ensemble.scene.quantities
    figures = [_svg(quantity_figure(comparison, name), quantity_of(name).long_name) for name in names]
    if ensemble.n_surfaces > 1:
        figures.append(_svg(draw(_spread(comparison)), "std over mean against separation"))
    return _PAGE.substitute(
        style=_STYLE,
        title=escape(one_line(ensemble.scene.title) or "Ensemble of rough surfaces"),
        words=_words(ensemble),
        bad="" if comparison.verdict.agrees else " bad",
        verdict=escape(verdict_line(comparison.verdict)),
        elastic=escape(against.verdict),
        elasticity=elasticity_section(against),
        figures="\n".join(f"<figure>{figure}</figure>" for figure in figures),
        tables="\n".join(_table(comparison, name) for name in names),
        facts=_facts(ensemble),
        laws=laws_section(ensemble.scene),
        yielding=yielding_item(ensemble.scene),
        cautions="\n".join(f"<li>{escape(text)}</li>" for text in cautions(ensemble.scene)),
        provenance=_rows(
            (key, escape(str(attributes[key])))
            for key in ("digest", "seed", "sampler", "date", "versions", "commit", "cpu")
        ),
        scene=escape(plain_text(_shorter(attributes["scene"]))),
    )


def _shorter(scene: str) -> str:
    """The scene with each list of numbers or names on one line: the same TOML."""
    return re.sub(r"\[\n[^\]]*\]", _one_line, scene)


def _one_line(listed: re.Match[str]) -> str:
    return f"[{' '.join(listed.group()[1:-1].split()).rstrip(',')}]"


def _svg(figure: Figure, label: str) -> str:
    """An SVG element that takes the width it is given."""
    buffer = io.StringIO()
    with mpl.rc_context(STYLE | {"svg.hashsalt": label}):
        write_figure(figure, buffer, format="svg", metadata={"Date": None, "Creator": None})
    text = buffer.getvalue()
    text = re.sub(r"<metadata>.*?</metadata>", "", text[text.index("<svg") :], flags=re.DOTALL)
    head, rest = text.split(">", 1)
    head = re.sub(r' (width|height)="[^"]*"', "", head)
    # Ids are unique in a page: each figure has its own.
    mark = re.sub(r"\W+", "-", label)
    rest = re.sub(r'(id="|href="#|url\(#)', rf"\g<1>{mark}-", rest)
    return f'{head} role="img" aria-label="{escape(label)}">{rest}'


def _spread(comparison: Comparison) -> FigureData:
    ensemble = comparison.ensemble
    scene, h = ensemble.scene, ensemble.separations
    order = np.argsort(h, kind="stable")
    series = []
    for name in scene.quantities:
        curve = comparison.curves[name]
        touches = curve.theory != 0
        exact = np.full(len(h), np.nan)
        exact[touches] = (curve.stderr * np.sqrt(ensemble.n_surfaces))[touches] / np.abs(
            curve.theory[touches]
        )
        known = (ensemble.mean(name) > 0) & (exact > 0)
        mean, std = ensemble.mean(name)[known], ensemble.std(name)[known]
        points = Points(h[known], std / mean, np.zeros(known.sum()), exact[known])
        series.append(Series(name, h[order], exact[order], points))
    panel = Panel("Spread over surfaces", "separation d/σ", "std / mean", tuple(series), ("linear", "log"))
    return FigureData("spread", "", "Lines: exact. Markers: the ensemble.", (panel,), columns=1)


def _words(ensemble: Ensemble) -> str:
    scene = ensemble.scene
    count = "" if scene.count == "fixed" else " on average (a Poisson number)"
    separations = f"{len(scene.separations)} separation{'s' * (len(scene.separations) > 1)}"
    return (
        f"{ensemble.n_surfaces} rough surfaces of {scene.n_asperities:g} asperities{count}, "
        f"{escape(grading_label(scene.grading))}, each pressed on a plane at {separations} from d/σ = "
        f"{min(scene.separations):g} to {max(scene.separations):g}. {contacts_sentence(scene)}"
    )


def _number(x: float, digits: int = 4) -> str:
    """A number as people write it: 1.234×10⁻⁵."""
    text = f"{x:.{digits}g}"
    if "e" not in text:
        return text
    mantissa, power = text.split("e")
    return f"{mantissa}×10<sup>{int(power)}</sup>".replace("-", "−")


def _with_error(x: float, error: float) -> str:
    """Value and, in brackets, the error of its last two digits: 6.698(36)×10⁻⁷."""
    if not (x and np.isfinite(error) and error > 0):
        return _number(x)
    power = int(np.floor(np.log10(max(abs(x), error))))
    power = 0 if -3 <= power < 4 else power
    digits = max(1 - int(np.floor(np.log10(error))) + power, 0)
    shown = f"{error / 10.0**power:.{digits}f}"
    bracket = shown.lstrip("0.") if float(shown) < 1 else shown
    text = f"{x / 10.0**power:.{digits}f}({bracket})"
    return text if not power else f"{text}×10<sup>{str(power).replace('-', '−')}</sup>"


def _rows(pairs: Any) -> str:
    return "\n".join(f"<tr><td>{key}</td><td>{value}</td></tr>" for key, value in pairs)


def _facts(ensemble: Ensemble) -> str:
    scene, x = ensemble.scene, ensemble.scene.surface
    contacts = float(scene.theory.mean("contacts", scene.lowest))
    return _rows(
        (
            ("standard deviation σ of the summit heights", f"{_number(x.sigma)} m"),
            ("summit radius R", f"{_number(x.radius)} m = {_number(x.radius / x.sigma)} σ"),
            (
                "summits per area η",
                f"{_number(x.eta)} m<sup>−2</sup>; ηRσ = {_number(x.eta * x.radius * x.sigma)}",
            ),
            (
                "nominal area Aₙ",
                f"{_number(x.nominal_area)} m<sup>2</sup> = {_number(x.nominal_area / x.sigma**2)} σ²",
            ),
            ("composite modulus E*", f"{_number(x.E_star)} Pa"),
            ("grading E*(s)/E*", escape(grading_label(scene.grading))),
            *((word, escape(what)) for word, what in contact_facts(scene)),
            ("contacts expected at the lowest separation", _number(contacts)),
        )
    )


def _table(comparison: Comparison, name: str) -> str:
    curve, h, q = comparison.curves[name], comparison.ensemble.separations, quantity_of(name)
    rows = []
    for k in evenly(len(h), _MOST_ROWS):
        half = (curve.high[k] - curve.low[k]) / 2
        few = f", {TOO_FEW}" if np.isnan(half) else ""
        rows.append(
            f"<tr><td>{h[k]:g}</td><td>{_with_error(curve.mean[k], half)}{few}</td>"
            f"<td>{_number(curve.theory[k], 5)}</td><td>{curve.residual[k]:+.1f}</td></tr>"
        )
    title = f"{q.name.capitalize()} ({q.unit})" if q.unit != "1" else q.name.capitalize()
    return (
        f"<section><h3>{title.replace('^2', '²')}</h3><table><thead><tr><th>d/σ</th><th>mean</th>"
        f"<th>theory</th><th>residual</th></tr></thead><tbody>{''.join(rows)}</tbody></table></section>"
    )
