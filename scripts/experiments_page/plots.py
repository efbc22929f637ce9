"""Curves as SVG files."""

import dataclasses
import html
import math

WIDTH, HEIGHT = 620, 380
LEFT, RIGHT, TOP, BOTTOM = 56, 12, 12, 44
COLOURS = ["#1565c0", "#c62828", "#2e7d32", "#ef6c00", "#6a1b9a", "#00838f", "#5d4037", "#ad1457"]
ORACLE_COLOUR = "#222222"


@dataclasses.dataclass
class Curve:
    label: str  # of the legend; empty: not in it
    colour: str
    points: list  # (x, y)
    width: float = 2.0
    opacity: float = 1.0
    dashed: bool = False


def find_step(extent):
    """1, 2 or 5 times a power of ten, about six steps to the extent."""
    power = 10 ** math.floor(math.log10(extent / 5))
    return next((factor * power for factor in (1, 2, 5) if extent / (factor * power) <= 7), 10 * power)


def list_ticks(low, high):
    step = find_step(high - low)
    first = math.ceil(low / step - 1e-9)
    return [round(k * step, 10) for k in range(first, math.floor(high / step + 1e-9) + 1)]


def make_plot(curves, x_label, y_label, x_range, y_range):
    """The text of an SVG file. What lies outside of the ranges is cut off."""
    def map_x(x):
        return LEFT + (x - x_range[0]) / (x_range[1] - x_range[0]) * (WIDTH - LEFT - RIGHT)

    def map_y(y):
        return HEIGHT - BOTTOM - (y - y_range[0]) / (y_range[1] - y_range[0]) * (HEIGHT - TOP - BOTTOM)

    parts = [f"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {WIDTH} {HEIGHT}' width='{WIDTH}' font-family='sans-serif' font-size='11'>",
             f"<rect width='{WIDTH}' height='{HEIGHT}' fill='white'/>",
             f"<clipPath id='c'><rect x='{LEFT}' y='{TOP}' width='{WIDTH - LEFT - RIGHT}' height='{HEIGHT - TOP - BOTTOM}'/></clipPath>"]
    for x in list_ticks(*x_range):
        parts.append(f"<line x1='{map_x(x):.1f}' x2='{map_x(x):.1f}' y1='{TOP}' y2='{HEIGHT - BOTTOM}' stroke='#e4e4e4'/>"
                     f"<text x='{map_x(x):.1f}' y='{HEIGHT - BOTTOM + 15}' text-anchor='middle'>{x:g}</text>")
    for y in list_ticks(*y_range):
        parts.append(f"<line y1='{map_y(y):.1f}' y2='{map_y(y):.1f}' x1='{LEFT}' x2='{WIDTH - RIGHT}' stroke='#e4e4e4'/>"
                     f"<text x='{LEFT - 6}' y='{map_y(y) + 4:.1f}' text-anchor='end'>{y:g}</text>")
    for curve in curves:
        points = " ".join(f"{map_x(x):.1f},{map_y(y):.1f}" for x, y in curve.points)
        dash = " stroke-dasharray='6 4'" if curve.dashed else ""
        parts.append(f"<polyline clip-path='url(#c)' fill='none' stroke='{curve.colour}' stroke-width='{curve.width}' stroke-opacity='{curve.opacity}'{dash} "
                     f"points='{points}'/>")
    for number, curve in enumerate(reversed([curve for curve in curves if curve.label])):
        y = HEIGHT - BOTTOM - 10 - 15 * number
        dash = " stroke-dasharray='6 4'" if curve.dashed else ""
        parts.append(f"<line x1='{WIDTH - RIGHT - 34}' x2='{WIDTH - RIGHT - 8}' y1='{y - 4}' y2='{y - 4}' stroke='{curve.colour}' stroke-width='2'{dash}/>"
                     f"<text x='{WIDTH - RIGHT - 40}' y='{y}' text-anchor='end'>{html.escape(curve.label)}</text>")
    parts.append(f"<rect x='{LEFT}' y='{TOP}' width='{WIDTH - LEFT - RIGHT}' height='{HEIGHT - TOP - BOTTOM}' fill='none' stroke='#888'/>"
                 f"<text x='{(LEFT + WIDTH - RIGHT) / 2}' y='{HEIGHT - 10}' text-anchor='middle'>{html.escape(x_label)}</text>"
                 f"<text transform='translate(14 {(TOP + HEIGHT - BOTTOM) / 2}) rotate(-90)' text-anchor='middle'>{html.escape(y_label)}</text></svg>")
    return "\n".join(parts) + "\n"


def interpolate(points, x):
    """y at x on the line through the points (x rising); the first y before them, the last after."""
    if x <= points[0][0]:
        return points[0][1]
    for (x0, y0), (x1, y1) in zip(points, points[1:]):
        if x <= x1:
            return y1 if x1 == x0 else y0 + (x - x0) / (x1 - x0) * (y1 - y0)
    return points[-1][1]


def average(curves, x_values):
    """The mean of several lines of points."""
    return [(x, sum(interpolate(points, x) for points in curves) / len(curves)) for x in x_values]
