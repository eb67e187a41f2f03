"""Whether the parts of a figure have room."""

import itertools

from matplotlib.backends.backend_agg import FigureCanvasAgg


def crowded(figure):
    """What runs out of a figure or into a neighbour, as it is drawn: panels, legends, labels of ticks."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    texts = [text for text in (figure._suptitle, figure._supxlabel) if text and text.get_text()]
    legends = [legend for part in figure.subfigs for legend in part.legends]
    boxes = [part.get_tightbbox(canvas.get_renderer()) for part in (*figure.axes, *texts, *legends)]
    out = [
        box for box in boxes if box.x0 < 0 or box.y0 < 0 or box.x1 > figure.bbox.x1 or box.y1 > figure.bbox.y1
    ]
    groups = [boxes] + [
        [label.get_window_extent() for label in axis.get_ticklabels(which="both") if label.get_text()]
        for panel in figure.axes
        for axis in (panel.xaxis, panel.yaxis)
        if panel.axison
    ]
    pairs = itertools.chain.from_iterable(itertools.combinations(group, 2) for group in groups)
    return out + [(a, b) for a, b in pairs if a.padded(-1).overlaps(b)]  # of a pixel, by rounding
