"""Plots of error against time, both in powers of ten."""

import math

COLOURS = ("#2b6cb0", "#1a936f", "#d1495b", "#8e44ad")
GREY = "#444444"
WIDTH, HEIGHT = 800, 320
LEFT, RIGHT, TOP, BOTTOM = 70, 330, 12, 44
ROW = 12  # of marks without a place on the axis


class Axis:
    """Logarithms of `values` onto pixels."""

    def __init__(self, values, first, last):
        known = [math.log10(v) for v in values if v is not None and v > 0.0]
        self.known = bool(known)
        self.lo = min(known, default=0.0)
        self.hi = max(known, default=1.0)
        # less than half a power of ten would make much of little
        middle, half = 0.5 * (self.lo + self.hi), max(0.5 * (self.hi - self.lo), 0.25)
        self.lo, self.hi = middle - half, middle + half
        self.first, self.last = first, last

    def at(self, value):
        share = (math.log10(value) - self.lo) / (self.hi - self.lo)
        return self.first + share * (self.last - self.first)

    def ticks(self):
        """Powers of ten, with some multiples where there are few."""
        powers = range(math.floor(self.lo), math.ceil(self.hi) + 1)
        step = max(1, math.ceil(len(powers) / 8))
        wide = self.hi - self.lo > 0.8
        leading = (1,) if len(powers) > 3 else (1, 2, 5) if wide else (1, 2, 3, 4, 5, 7)
        for exponent in powers[::step]:
            for digit in leading:
                if self.lo <= exponent + math.log10(digit) <= self.hi:
                    yield digit, exponent


def number(digit, exponent):
    if -2 <= exponent <= 3:
        return f"{digit * 10.0 ** exponent:g}"
    times = "" if digit == 1 else f"{digit}·"
    return f'{times}10<tspan dy="-5" font-size="9">{exponent}</tspan>'


def apart(marks):
    """Moves marks that would hide each other: in a strip to a free row, else a little aside."""
    placed = []
    for x, y, strip, text, colour in sorted(marks):
        def free(px, py):
            return all(abs(px - qx) >= 10 or abs(py - qy) >= 10 for qx, qy in placed)

        if strip:
            rows = [y + ROW * i for i in range(4)]
            y = next((row for row in rows if free(x, row)), rows[0])
        while not free(x, y):
            x += 10
        placed.append((x, y))
        yield x, y, text, colour


def escaped(text):
    return text.replace("&", "&amp;").replace("<", "&lt;").replace("`", "")


def scatter(series, variants, x_name, y_name):
    """A picture on white; marks are the numbers of the variants, colours the series."""
    points = [point for _, each in series for point in each]
    # strips for no error at all and for what is undefined
    zero = any(y == 0.0 for _, _, y in points)
    endless = any(y is None for _, _, y in points)
    floor = HEIGHT - BOTTOM
    zero_at, endless_at = floor - 8 - 3 * ROW, TOP + 8
    foot = zero_at - ROW if zero else floor - 10
    head = endless_at + 4 * ROW if endless else TOP + 10
    xs = Axis([x for _, x, _ in points], LEFT + 10, WIDTH - RIGHT - 28)
    ys = Axis([y for _, _, y in points], foot, head)
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
             'font-family="sans-serif" font-size="12">',
             f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>',
             f'<path d="M{LEFT} {TOP}V{floor}H{WIDTH - RIGHT}" fill="none" stroke="#999999"/>']

    def text(x, y, what, anchor="end", colour=GREY, more=""):
        lines.append(f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{colour}"{more}>'
                     f'{what}</text>')

    def line(x1, y1, x2, y2):
        lines.append(f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" '
                     'stroke="#dddddd"/>')

    if ys.known:
        for digit, exponent in ys.ticks():
            y = ys.at(digit * 10.0 ** exponent)
            line(LEFT, y, WIDTH - RIGHT, y)
            text(LEFT - 6, y + 4, number(digit, exponent))
    if zero:
        line(LEFT, zero_at - 8, WIDTH - RIGHT, zero_at - 8)
        text(LEFT - 6, zero_at + 1.5 * ROW + 4, "0")
    if endless:
        line(LEFT, endless_at + 4 * ROW - 8, WIDTH - RIGHT, endless_at + 4 * ROW - 8)
        text(LEFT - 6, endless_at + 1.5 * ROW + 4, "undefined")
    for digit, exponent in xs.ticks():
        x = xs.at(digit * 10.0 ** exponent)
        line(x, TOP, x, floor)
        text(x, floor + 16, number(digit, exponent), "middle")
    text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 8, x_name, "middle")
    lines.append(f'<text transform="translate(12 {(TOP + floor) / 2}) rotate(-90)" '
                 f'text-anchor="middle" fill="{GREY}">{y_name}</text>')
    marks = []
    for colour, (_, each) in zip(COLOURS, series):
        for mark, x, y in each:
            strip = y is None or y == 0.0
            place = endless_at if y is None else zero_at if y == 0.0 else ys.at(y)
            marks.append((xs.at(x), place, strip, mark, colour))
    bold = ' font-weight="bold"'
    for x, y, mark, colour in apart(marks):
        text(x, y + 4, mark, "middle", colour, bold)
    at = TOP + 14
    for colour, (name, _) in zip(COLOURS, series):
        text(WIDTH - RIGHT + 16, at, escaped(name), "start", colour, bold)
        at += 17
    at += 8
    for i, name in enumerate(variants, 1):
        text(WIDTH - RIGHT + 16, at, f"{i}  {escaped(name)}", "start")
        at += 17
    return "\n".join(lines) + "\n</svg>\n"
