"""Whether the parts of a figure have room."""

import itertools

from matplotlib.backends.backend_agg import FigureCanvasAgg


def crowded(figure):
    """What runs out of a figure or into a neighbour, as matplotlib measures all of each panel."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    texts = [text for text in (figure._suptitle, figure._supxlabel) if text and text.get_text()]
    boxes = [part.get_tightbbox(canvas.get_renderer()) for part in (*figure.axes, *texts)]
    out = [
        box for box in boxes if box.x0 < 0 or box.y0 < 0 or box.x1 > figure.bbox.x1 or box.y1 > figure.bbox.y1
    ]
    return out + [pair for pair in itertools.combinations(boxes, 2) if pair[0].overlaps(pair[1])]
