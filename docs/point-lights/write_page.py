#!/usr/bin/env python3
"""Writes the tables of docs/point-lights.md and the plots beside this file from measured.json.

usage: docs/point-lights/write_page.py [--check]

With --check nothing is written; the exit code tells whether page and plots are what the file says.
It comes from `./run.sh measure point-lights`.
"""

import json
import math
import pathlib
import statistics
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from page_blocks import fill, keep_pictures  # noqa: E402

FOLDER = pathlib.Path(__file__).resolve().parent
PAGE = FOLDER.parent / "point-lights.md"

# Frames per second of Navratil 2012.
TABLE_1 = {"cube6-gs": (6.19,), "cube6-cull-gs": (20.3,), "dpsm-gs": (18.81,),
           "dpsm-cull-gs": (30.90,)}
TABLE_2 = {"cube6": (75.71, 70.04, 47.9), "cube6-cull": (150.43, 116.76, 64.04),
           "cube6-efc": (188.71, 151.67, 89.68), "dpsm": (167.95, 146.62, 97.52),
           "dpsm-cull": (207.24, 178.67, 109.4), "dpsm-pc": (208.15, 180.24, 110.95)}
TABLE_3 = {"cube6": (19.11, 18.38, 16.21), "cube6-cull": (57.15, 51.23, 36.50),
           "cube6-efc": (127.47, 114.21, 83.38), "dpsm": (41.50, 39.74, 33.17),
           "dpsm-cull": (57.47, 54.32, 42.85), "dpsm-pc": (90.56, 86.08, 69.58)}
SIZES = (1024, 2048, 4096)
COLOURS = {"cube6": "#7a7a7a", "cube6-cull": "#2b6cb0", "cube6-efc": "#1a936f", "dpsm": "#c9a227",
           "dpsm-cull": "#d1495b", "dpsm-pc": "#8e44ad"}


def walk_of(measured, name):
    (found,) = (each for each in measured["walks"] if each["name"] == name)
    return found


def method_of(walk, method, size):
    for each in walk["methods"]:
        if (each["method"], each["map"]) == (method, size):
            return each
    return None


def per_second(entry):
    return 1000.0 / statistics.median(entry["frame_ms"])


def mean(values):
    return sum(values) / len(values)


def corners(walk):
    return f"{int(walk['scene'].split(':')[1]):,}".replace(",", " ")


def row(cells):
    return "| " + " | ".join(cells) + " |"


def speed_table(walk, paper):
    """Frames per second as multiples of cube6, here and in the paper."""
    sizes = [size for size in SIZES if method_of(walk, "cube6", size)]
    lines = [row(["", *(f"{size}², here" for size in sizes),
                  *(f"{size}², paper" for size in SIZES)]),
             row(["---"] * (1 + len(sizes) + len(SIZES)))]
    for method, theirs in paper.items():
        here = [f"{per_second(method_of(walk, method, size)) / per_second(method_of(walk, 'cube6', size)):.2f}"
                for size in sizes]
        there = [f"{own / base:.2f}" for own, base in zip(theirs, paper["cube6"])]
        lines.append(row([f"`{method}`", *here, *there]))
    about = (f"{walk['scene'].split(':')[0]} in {corners(walk)} corners of triangles, "
             f"{walk['view'][0]} × {walk['view'][1]} pixels, "
             f"{len(walk['methods'][0]['maps'])} frames, {walk['renderer'].split(' (')[0]}:")
    return about + "\n\n" + "\n".join(lines) + "\n"


def layered_table(walk):
    cube6 = method_of(walk, "cube6", 1024)
    lines = [row(["one pass", "here", "paper", "of several passes, here", "paper"]),
             row(["---"] * 5)]
    for method, (theirs,) in TABLE_1.items():
        plain = method.removesuffix("-gs")
        one = method_of(walk, method, 1024)
        several = method_of(walk, plain, 1024)
        lines.append(row([f"`{method}`", f"{per_second(one) / per_second(cube6):.2f}",
                          f"{theirs / TABLE_3['cube6'][0]:.2f}",
                          f"{per_second(one) / per_second(several):.2f}",
                          f"{theirs / TABLE_3[plain][0]:.2f}"]))
    return "\n".join(lines) + "\n"


def maps_table(measured):
    lines = [row(["light", "`cube6-efc`: faces of 6", "least, most",
                  "`dpsm-pc`: hemispheres of 2", "frame, `cube6-efc` over `cube6-cull`",
                  "frame, `dpsm-pc` over `dpsm-cull`"]),
             row(["---"] * 6)]
    for name, about in (("600k", "above the views, seldom in one"), ("lamp", "a lamp in most views")):
        walk = walk_of(measured, name)
        faces, halves = (method_of(walk, method, 1024) for method in ("cube6-efc", "dpsm-pc"))

        def ratio(own, base):
            times = [statistics.median(method_of(walk, each, 1024)["frame_ms"])
                     for each in (own, base)]
            return f"{times[0] / times[1]:.2f}"

        lines.append(row([about, f"{mean(faces['maps']):.2f}",
                          f"{min(faces['maps'])}, {max(faces['maps'])}", f"{mean(halves['maps']):.2f}",
                          ratio("cube6-efc", "cube6-cull"), ratio("dpsm-pc", "dpsm-cull")]))
    return "\n".join(lines) + "\n"


def vpl_table(measured):
    lines = [row(["points", "", "maps a light", f"ms, {len(measured['vpl'][0]['ways'][0]['ms'])} lights",
                  "of `cube6-efc`"]), row(["---"] * 5)]
    for record in measured["vpl"]:
        by_name = {way["way"]: way for way in record["ways"]}
        for name, way in by_name.items():
            lines.append(row([f"{record['points']:,}".replace(",", " "), f"`{name}`",
                              f"{mean(way['maps']):.1f}", f"{sum(way['ms']):.0f}",
                              f"{sum(way['ms']) / sum(by_name['cube6-efc']['ms']):.2f}"]))
    return "\n".join(lines) + "\n"


def oracle_table(measured):
    lines = [row(["pairs", "in float", "missed", "kept in vain", "in double", "missed",
                  "kept in vain"]), row(["---"] * 7)]
    kinds = list(dict.fromkeys(each["class"] for each in measured["oracle"]))
    total = 0
    for kind in kinds:
        cells = [kind]
        for number in ("float", "double"):
            (one,) = (each for each in measured["oracle"]
                      if (each["class"], each["type"]) == (kind, number))
            total += one["pairs"]
            cells += [f"{one['pairs']:,}".replace(",", " "), str(one["false_negatives"]),
                      str(one["false_positives"])]
        lines.append(row(cells))
    return (f"{total:,} pairs in all:".replace(",", " ") + "\n\n" + "\n".join(lines) + "\n")


def culling_speed(measured):
    builds = list(measured["speed"])
    lines = [row(["", *(f"`{build}`" for build in builds)]), row(["---"] * (1 + len(builds)))]

    def times(name):
        return [measured["speed"][build][name] for build in builds]

    def ratios(over, under):
        return [f"{a / b:.1f}" for a, b in zip(times(over), times(under))]

    lines.append(row(["six-face mask, ns", *(f"{ns:.0f}" for ns in times("six_faces_warpshadow"))]))
    lines.append(row(["six scalar points-and-edges tests over it",
                      *ratios("six_faces_scalar", "six_faces_warpshadow")]))
    for faces, kind in ((0, "random frusta"), (1, "view and cube face")):
        for hit, outcome in ((0, "miss"), (1, "hit")):
            suffix = f"/faces:{faces}/hit:{hit}"
            own = "pair_warpshadow" + suffix
            lines.append(row([f"{kind}, {outcome}, ns", *(f"{ns:.0f}" for ns in times(own))]))
            for library in ("bullet", "libccd"):
                ways = [name for name in measured["speed"][builds[0]]
                        if name.startswith(f"pair_{library}") and name.endswith(suffix)]
                best = [min(measured["speed"][build][way] for way in ways) /
                        measured["speed"][build][own] for build in builds]
                lines.append(row([f"the faster way of {library.capitalize() if library == 'bullet' else library} over it",
                                  *(f"{each:.1f}" for each in best)]))
    return "\n".join(lines) + "\n"


def chord_line(measured):
    return (f"Over random scenes the worst edge is {measured['chord_texels']:.3f} texels off its arc; "
            "0.5 are allowed.\n")


def ticks(most):
    step = 10.0 ** math.floor(math.log10(most))
    for share in (0.1, 0.2, 0.5, 1.0):
        if most / (share * step) <= 6.0:
            step *= share
            break
    return [step * i for i in range(int(math.ceil(most / step - 1e-9)) + 1)]


def plot(series, x_name, y_name, x_from, x_to):
    """Values over whole numbers as a picture of its own, on white."""
    width, height, left, right, top, bottom = 720, 300, 56, 110, 14, 40
    marks = ticks(max(max(values) for _, values in series))
    most = marks[-1]

    def x_of(i, count):
        return left + (width - left - right) * i / max(count - 1, 1)

    def y_of(value):
        return height - bottom - (height - top - bottom) * value / most

    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
             'font-family="sans-serif" font-size="12">',
             f'<rect width="{width}" height="{height}" fill="#ffffff"/>']
    for mark in marks:
        lines.append(f'<line x1="{left}" x2="{width - right}" y1="{y_of(mark):.1f}" '
                     f'y2="{y_of(mark):.1f}" stroke="#dddddd"/>')
        lines.append(f'<text x="{left - 6}" y="{y_of(mark) + 4:.1f}" text-anchor="end" '
                     f'fill="#444444">{mark:g}</text>')
    lines.append(f'<text x="{left}" y="{height - 8}" fill="#444444">{x_from}</text>')
    lines.append(f'<text x="{width - right}" y="{height - 8}" text-anchor="end" '
                 f'fill="#444444">{x_to}</text>')
    lines.append(f'<text x="{(left + width - right) / 2}" y="{height - 8}" text-anchor="middle" '
                 f'fill="#444444">{x_name}</text>')
    lines.append(f'<text transform="translate(14 {(top + height - bottom) / 2}) rotate(-90)" '
                 f'text-anchor="middle" fill="#444444">{y_name}</text>')
    placed = []
    for name, values in sorted(series, key=lambda each: -each[1][-1]):
        colour = COLOURS[name]
        points = " ".join(f"{x_of(i, len(values)):.1f},{y_of(value):.1f}"
                          for i, value in enumerate(values))
        lines.append(f'<polyline points="{points}" fill="none" stroke="{colour}" '
                     'stroke-width="1.8"/>')
        y = y_of(values[-1]) + 4
        if placed:
            y = max(y, placed[-1] + 14)
        placed.append(y)
        lines.append(f'<text x="{width - right + 6}" y="{y:.1f}" fill="{colour}" '
                     f'font-weight="bold">{name}</text>')
    return "\n".join(lines) + "\n</svg>\n"


def plots(measured):
    walk = walk_of(measured, "600k")
    frames = len(walk["methods"][0]["maps"])

    def series(key, names):
        return [(name, method_of(walk, name, 1024)[key]) for name in names]

    def over_frames(key, names, y_name):
        return plot(series(key, names), "frame", y_name, "0", str(frames - 1))

    result = {
        "frame-ms.svg": over_frames("frame_ms", TABLE_2, "frame, ms"),
        "maps.svg": over_frames("maps", ["cube6-efc", "dpsm-pc"], "maps drawn"),
        "shadow-map-ms.svg": over_frames("shadow_map_ms",
                                         ["cube6-cull", "cube6-efc", "dpsm-cull", "dpsm-pc"],
                                         "shadow maps, ms"),
    }
    for record in measured["vpl"]:
        sums = []
        for way in record["ways"]:
            total = [0.0]
            for ms in way["ms"]:
                total.append(total[-1] + ms)
            sums.append((way["way"], total))
        lights = len(record["ways"][0]["ms"])
        result[f"vpl-{record['points']}.svg"] = plot(sums, "lights", "shadow maps, ms", "0",
                                                      str(lights))
    return result


def main():
    check = sys.argv[1:] == ["--check"]
    if sys.argv[1:] and not check:
        sys.exit(__doc__.strip())
    measured = json.loads((FOLDER / "measured.json").read_text(encoding="utf-8"))
    blocks = {
        "layered": layered_table(walk_of(measured, "3m")),
        "600k": speed_table(walk_of(measured, "600k"), TABLE_2),
        "3m": speed_table(walk_of(measured, "3m"), TABLE_3),
        "maps": maps_table(measured),
        "vpl": vpl_table(measured),
        "oracle": oracle_table(measured),
        "speed": culling_speed(measured),
        "chord": chord_line(measured),
    }
    keep_pictures(FOLDER, plots(measured), "docs/point-lights/write_page.py", check)
    fill(PAGE, blocks, "docs/point-lights/write_page.py", check)


if __name__ == "__main__":
    main()
