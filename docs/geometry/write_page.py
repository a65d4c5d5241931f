#!/usr/bin/env python3
"""Writes the tables of docs/geometry.md from the results in docs/geometry.

usage: docs/geometry/write_page.py [--check]

With --check nothing is written; the exit code tells whether the tables are what the results say.
The results come from `./run.sh measure geometry`.
"""

import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from page_blocks import fill  # noqa: E402

FOLDER = pathlib.Path(__file__).resolve().parent
PAGE = FOLDER.parent / "geometry.md"

# What was asked of the geometry before it was written: build, ours, theirs, times as fast.
GOALS = [
    ("smallest rectangle of 8 to 16 points, bodies", "rectangle", "body_0", ["opencv"], (3, 7)),
    ("8 points of a disk", "rectangle", "disk_8", ["opencv"], (3, 7)),
    ("16 points", "rectangle", "disk_16", ["opencv"], (3, 7)),
    ("24 points", "rectangle", "disk_24", ["opencv", "cgal", "geos"], (1, 1)),
    ("64 points", "rectangle", "disk_64", ["opencv", "cgal", "geos"], (1, 1)),
    ("1000 points", "rectangle", "disk_1000", ["opencv", "cgal", "geos"], None),
    ("convex hull of bodies", "hull", "body_0", ["opencv", "cgal", "boost", "geos"], None),
    ("64 points", "hull", "disk_64", ["opencv", "cgal", "boost", "geos"], None),
    ("1000 points", "hull", "disk_1000", ["opencv", "cgal", "boost", "geos"], (3, 3)),
    ("100 000 points", "hull", "disk_100000", ["opencv", "cgal", "boost", "geos"], None),
    ("100 000 points, all on the hull", "hull", "rim_100000", ["opencv", "cgal", "boost", "geos"],
     None),
]
LIBRARIES = {"opencv": "OpenCV", "cgal": "CGAL", "boost": "Boost", "geos": "GEOS"}


def load(name):
    return json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))


def lines_of(header, rows, align):
    marks = {"l": "---", "r": "---:"}
    lines = ["| " + " | ".join(header) + " |", "|" + "|".join(marks[a] for a in align) + "|"]
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def failures():
    parts = []
    for title, classes in load("failures").items():
        libraries = list(next(iter(classes.values())))
        total = dict.fromkeys(libraries, 0)
        rows = []
        for kind, answers in classes.items():
            sets = sum(answers[libraries[0]].values())
            cells = []
            for library in libraries:
                bad = {how: n for how, n in answers[library].items() if how != "passed"}
                total[library] += sum(bad.values())
                cells.append(", ".join(f"{n} {how}" for how, n in bad.items()) or "0")
            rows.append([f"{kind} ({sets})", *cells])
        rows.append(["**all**", *(f"**{n}**" for n in total.values())])
        parts.append(f"### {title}\n\n" + lines_of(["class (sets)", *libraries], rows,
                                                   "l" + "r" * len(libraries)))
    return "\n".join(parts)


def duration(nanoseconds):
    if nanoseconds < 1000:
        return f"{nanoseconds:.3g} ns"
    if nanoseconds < 1e6:
        return f"{nanoseconds / 1e3:.3g} µs"
    return f"{nanoseconds / 1e6:.3g} ms"


def times(value):
    return f"{value:.2f}" if value < 10 else f"{value:.0f}"


def goal_text(goal, build):
    if goal is None:
        return ""
    return "1" if goal[build] == 1 else f"{goal[build]}"


def speed():
    measured = load("speed")
    parts = []
    for build, (key, flags) in enumerate((("o2", "`-O2`"), ("native", "`-O3 -march=native`"))):
        ns = measured[key]["nanoseconds"]
        rows = []

        def add(text, ours, in_double, theirs, goal):
            quotients = {name: ns[bench] / ns[ours] for name, bench in theirs.items()}
            cells = [f"{name} {times(q)}" for name, q in quotients.items()]
            in_double = duration(ns[in_double]) if in_double else ""
            rows.append([text, duration(ns[ours]), in_double, ", ".join(cells),
                         goal_text(goal, build)])

        for text, what, size, libraries, goal in GOALS:
            add(text, f"{what}_warpshadow/{size}", f"{what}_warpshadow_double/{size}",
                {LIBRARIES[name]: f"{what}_{name}/{size}" for name in libraries}, goal)
        add("vertices of frustum ∩ box", "body_warpshadow_vertices", None,
            {"voro++": "body_voro", "Bullet": "body_bullet"}, (1, 12))
        add("frustum, box, light plane, rectangle", "chain_warpshadow", None,
            {"voro++ and OpenCV": "chain_voro_opencv"}, None)
        add("orientation, random points", "orientation_warpshadow/random",
            "orientation_warpshadow_double/random", {"CGAL": "orientation_cgal/random"}, None)
        add("orientation, points on a line", "orientation_warpshadow/on_a_line",
            "orientation_warpshadow_double/on_a_line", {"CGAL": "orientation_cgal/on_a_line"}, None)
        lanes = measured[key]["doubles_at_once"]
        parts.append(f"### {flags}, {lanes} doubles at once\n\n" + lines_of(
            ["", "float", "double", "times as fast, float", "asked for"], rows, "lrrlr"))
    parts.append(f"{measured['processor']}, {measured['o2']['compiler']}, the fastest of "
                 f"{measured['o2']['repetitions']} interleaved repetitions.\n")
    return "\n".join(parts)


def per_cent(value):
    return f"{100 * value:.0f} %"


def waste():
    entry = load("fits")["waste"]

    def spread(row, key, text):
        if key not in row:
            return "–"
        v = row[key]
        return f"{text(v['median'])} ({text(v['p10'])} to {text(v['p90'])})"

    rows = [[row["fit"], spread(row, "outside_body", per_cent),
             spread(row, "outside_ground", per_cent),
             spread(row, "relative_area", lambda v: f"{v:.2f}")] for row in entry["rows"]]
    return lines_of(["map", "outside the footprint", "outside the ground seen",
                     "area to smallest rectangle"], rows, "lrrr") + (
        f"\n{entry['views']} views; median (10 % to 90 %).\n")


def yaw():
    entry = load("fits")["yaw"]
    rows = [[row["policy"], f"{100 * row['mean_excess_area']:.1f} %",
             f"{100 * row['largest_excess_area']:.1f} %", f"{row['largest_step_degrees']:.2f}°",
             f"{row['steps_above_1_degree']}"] for row in entry["rows"]]
    return lines_of(["frame", "mean excess area", "largest", "largest step", "steps above 1°"],
                    rows, "lrrrr") + (
        f"\nYaw through 360° in {entry['frames']} frames under {entry['lights']} suns.\n")


def frames():
    results = load("frames")
    runs = results["runs"]
    rows = []
    for run in runs:
        first = next(r for r in runs if (r["scene"], r["light"]) == (run["scene"], run["light"]))
        cpu = sum(run["cpu_setup_us"].values())
        ratio = run["frame_ms"]["median"] / first["frame_ms"]["median"]
        rows.append([run["scene"], f"`{run['method']}`", f"{100 * run['wrong_pixel_ratio']:.2f} %",
                     f"{run['frame_ms']['median']:.1f}", f"{ratio:.2f}", f"{cpu:.1f}"])
    width, height = runs[0]["view"]
    return lines_of(["scene", "method", "wrong pixels", "frame, ms", f"to `{runs[0]['method']}`",
                     "fit on the CPU, µs"], rows, "llrrrr") + (
        f"\n{width} × {height} pixels, maps of {runs[0]['map']}², on "
        f"{results['device']['renderer']}, which is a processor and no GPU.\n")


def main():
    check = sys.argv[1:] == ["--check"]
    if sys.argv[1:] and not check:
        sys.exit(__doc__.strip())
    blocks = {"failures": failures(), "speed": speed(), "waste": waste(), "yaw": yaw(),
              "frames": frames()}
    fill(PAGE, blocks, "docs/geometry/write_page.py", check)


if __name__ == "__main__":
    main()
