"""Pictures for the scripts beside this one: SVG without any library."""

import numpy as np

WIDTH, HEIGHT, EDGE = 640, 420, 60
COLOURS = ("#0072b2", "#d55e00", "#009e73")  # Okabe and Ito: told apart by the colour-blind
VIRIDIS = np.array([[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]])


def _colour(share):
    at = np.clip(share, 0, 1) * (len(VIRIDIS) - 1)
    low = int(min(at, len(VIRIDIS) - 2))
    red, green, blue = VIRIDIS[low] + (at - low) * (VIRIDIS[low + 1] - VIRIDIS[low])
    return f"rgb({red:.0f},{green:.0f},{blue:.0f})"


def _write(path, title, body, width=WIDTH):
    with open(path, "w") as file:
        file.write(f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{HEIGHT}" '
                   f'font-family="sans-serif" font-size="13"><rect width="100%" height="100%" fill="white"/>'
                   f'<text x="{EDGE}" y="24" font-size="15">{title}</text>{body}</svg>\n')


def _ticks(low, high):
    if not high > low:
        return np.array([low])
    step = 10 ** np.floor(np.log10((high - low) / 4))
    step *= min((m for m in (1, 2, 5, 10) if (high - low) / (m * step) <= 6), default=10)
    return np.arange(np.ceil(low / step), np.floor(high / step) + 1) * step


def lines(path, title, x_label, y_label, curves):
    """Draws curves, {name: (x, y)}."""
    low = np.min([[np.min(x), np.min(y)] for x, y in curves.values()], axis=0)
    high = np.max([[np.max(x), np.max(y)] for x, y in curves.values()], axis=0)
    high = np.where(high > low, high, low + 1)  # of curves that are all the same
    right, bottom = WIDTH - 20, HEIGHT - EDGE
    px = lambda x: EDGE + (np.asarray(x) - low[0]) / (high[0] - low[0]) * (right - EDGE)
    py = lambda y: bottom - (np.asarray(y) - low[1]) / (high[1] - low[1]) * (bottom - 40)
    body = ""
    for x in _ticks(low[0], high[0]):
        body += (f'<line x1="{px(x):.1f}" y1="40" x2="{px(x):.1f}" y2="{bottom}" stroke="#ddd"/>'
                 f'<text x="{px(x):.1f}" y="{bottom + 18}" text-anchor="middle">{x:g}</text>')
    for y in _ticks(low[1], high[1]):
        body += (f'<line x1="{EDGE}" y1="{py(y):.1f}" x2="{right}" y2="{py(y):.1f}" stroke="#ddd"/>'
                 f'<text x="{EDGE - 6}" y="{py(y) + 4:.1f}" text-anchor="end">{y:g}</text>')
    for n, (name, (x, y)) in enumerate(curves.items()):
        dashes = ("", "8 4", "2 3")[n % 3]
        points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(px(x), py(y)))
        body += (f'<polyline points="{points}" fill="none" stroke="{COLOURS[n % 3]}" stroke-width="2" '
                 f'stroke-dasharray="{dashes}"/>'
                 f'<line x1="{right - 190}" y1="{56 + 18 * n}" x2="{right - 160}" y2="{56 + 18 * n}" '
                 f'stroke="{COLOURS[n % 3]}" stroke-width="2" stroke-dasharray="{dashes}"/>'
                 f'<text x="{right - 152}" y="{60 + 18 * n}">{name}</text>')
    body += (f'<text x="{(EDGE + right) / 2}" y="{HEIGHT - 14}" text-anchor="middle">{x_label}</text>'
             f'<text x="16" y="{HEIGHT / 2}" text-anchor="middle" transform="rotate(-90 16 {HEIGHT / 2})">{y_label}</text>')
    _write(path, title, body)


def points(path, title, unit, x, y, values):
    """Draws values at places in the plane [mm], with a colour bar."""
    low, high = np.nanmin(values), np.nanmax(values)
    scale = (HEIGHT - EDGE - 50) / max(np.ptp(x), np.ptp(y))
    radius = max(1.5, 0.75 * scale * np.sqrt(np.ptp(x) * np.ptp(y) / len(x)))
    body = ""
    for a, b, v in zip(x, y, values):
        fill = "#bbb" if np.isnan(v) else _colour((v - low) / (high - low) if high > low else 0.5)
        body += (f'<circle cx="{EDGE + radius + (a - np.min(x)) * scale:.1f}" '
                 f'cy="{HEIGHT - EDGE + radius - (b - np.min(y)) * scale:.1f}" r="{radius:.1f}" fill="{fill}"/>')
    bar = EDGE + np.ptp(x) * scale + 50
    for n in range(100):
        body += f'<rect x="{bar:.0f}" y="{50 + 3 * (99 - n)}" width="18" height="3.5" fill="{_colour(n / 99)}"/>'
    for v in _ticks(low, high):
        share = (v - low) / (high - low) if high > low else 0.5
        body += f'<text x="{bar + 26:.0f}" y="{354 - 300 * share:.1f}">{v:g} {unit}</text>'
    body += f'<line x1="{EDGE}" y1="{HEIGHT - 16}" x2="{EDGE + 10 * scale:.0f}" y2="{HEIGHT - 16}" stroke="black"/>'
    body += f'<text x="{EDGE + 10 * scale + 8:.0f}" y="{HEIGHT - 12}">10 mm</text>'
    _write(path, title, body)
