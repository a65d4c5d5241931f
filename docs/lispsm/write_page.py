#!/usr/bin/env python3
"""Writes the tables of docs/lispsm.md from docs/lispsm/results.json.

usage: docs/lispsm/write_page.py [--check | --gather FOLDER]

With --check nothing is written; the exit code tells whether the tables are what the results say.
With --gather the results are first collected from the reports in FOLDER, which are those of
`./run.sh measure lispsm`.
"""

import json
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from page_blocks import fill  # noqa: E402

FOLDER = pathlib.Path(__file__).resolve().parent
PAGE = FOLDER.parent / "lispsm.md"
RESULTS = FOLDER / "results.json"

# Measured at a smaller share of wrong pixels than this, a ratio of two methods is noise.
LEAST = 0.001


def gather(folder):
    def read(name):
        return json.loads((folder / name).read_text(encoding="utf-8"))

    def runs_of(report):
        return [{key: run[key] for key in ("scene", "camera", "light", "method", "map", "view",
                                           "samples", "wrong_pixel_ratio", "status")}
                for run in report["runs"]]

    def paths_of(report):
        return [{**{key: path[key] for key in ("scene", "camera", "light", "path", "method", "map",
                                               "view")},
                 "frames": len(path["frames"]),
                 "wrong_pixel_ratio": path["mean"]["wrong_pixel_ratio"],
                 "flip_ratio": path["mean"]["flip_ratio"]} for path in report["paths"]]

    def all_of(pattern, part):
        found = sorted(folder.glob(pattern + "/results.json"))
        return [each for report in found
                for each in part(json.loads(report.read_text(encoding="utf-8")))]

    device = read("path-yaw/results.json")["device"]
    results = {"schema": 1, "device": device, "accuracy": read("accuracy.json"),
               "pairs": all_of("pairs-*", runs_of), "views": all_of("views-*", runs_of),
               "paths": all_of("path-*", paths_of)}
    RESULTS.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")


def percent(ratio):
    return f"{100 * ratio:.1f} %" if ratio >= 0.01 else f"{100 * ratio:.2f} %"


def power(x):
    return "none" if x is None else f"{x:.0e}".replace("e-0", "e-").replace("e+0", "e")


def geometric_mean(numbers):
    return math.exp(sum(math.log(x) for x in numbers) / len(numbers))


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + " --- |" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def accuracy(results):
    data = results["accuracy"]
    groups = {}
    for c in data["configurations"]:
        groups.setdefault((c["gamma"], c["ratio"]), []).append(c)
    rows = []
    for (gamma, ratio), cells in groups.items():
        textbook = {c["distance"]: c["textbook_float_world"] for c in cells}
        rows.append([f"{gamma:g}", power(ratio), power(max(c["float"] for c in cells)),
                     power(max(c["double"] for c in cells))] +
                    [power(textbook[d]) for d in sorted(textbook)])
    distances = sorted({c["distance"] for c in data["configurations"]})
    head = ["angle (rad)", "far / near", "`lispsm<float>`", "`lispsm<double>`"]
    head += [f"textbook, float, eye at {power(d) if d else 0}" for d in distances]
    return (f"Largest error in texels of a map of {data['map']}, {len(data['configurations'])} "
            f"configurations; worst {power(data['worst']['float'])} in `float`, "
            f"{power(data['worst']['double'])} in `double`, promised {power(data['bound'])}:\n\n" +
            table(head, rows))


def numbers(label):
    return [float(x) for x in label.split(":")[-1].split(",")]


def angle_of(run):
    camera = numbers(run["camera"])
    view = [camera[i + 3] - camera[i] for i in range(3)]
    light = numbers(run["light"])
    dot = sum(a * b for a, b in zip(view, light))
    return math.degrees(math.acos(dot / math.hypot(*view) / math.hypot(*light)))


def pairs(results):
    by_pair = {}
    for run in results["pairs"]:
        by_pair.setdefault((run["camera"], run["light"]), {})[run["method"]] = run
    order = list(dict.fromkeys(camera for camera, _ in by_pair))
    rows = []
    for (camera, _), runs in by_pair.items():
        wrong = {m: runs[m]["wrong_pixel_ratio"] for m in runs}
        rows.append([chr(ord("A") + order.index(camera)), f"{angle_of(runs['sm']):.0f}°",
                     percent(wrong["sm"]), percent(wrong["min-sm"]), percent(wrong["lispsm"]),
                     f"{wrong['lispsm'] / wrong['min-sm']:.2f}",
                     f"{wrong['lispsm'] / wrong['sm']:.2f}",
                     ", ".join(f"`{s}`" for s in runs["lispsm"]["status"]) or "warped"])
    rows.sort(key=lambda row: (row[0], -int(row[1][:-1])))

    def means(select):
        chosen = [r for r in by_pair.values() if select(r)]
        ratio = [geometric_mean([r["lispsm"]["wrong_pixel_ratio"] / r[m]["wrong_pixel_ratio"]
                                 for r in chosen]) for m in ("min-sm", "sm")]
        return f"{ratio[0]:.2f} and {ratio[1]:.2f}"

    def in_view(r):
        return "light_in_view" in r["lispsm"]["status"]

    first = results["pairs"][0]
    return (f"The scene {first['scene']} at {first['map']}², {first['view'][0]} × "
            f"{first['view'][1]} pixels. Geometric means of `lispsm` over `min-sm` and over `sm`:\n"
            f"{means(lambda r: angle_of(r['sm']) > 80)} with the sun at right angles, "
            f"{means(lambda r: angle_of(r['sm']) <= 80 and not in_view(r))} with the sun behind "
            f"the camera but outside\nthe view cone, {means(in_view)} inside it, where the map "
            "stays uniform.\n\n" +
            table(["camera", "light to view", "`sm`", "`min-sm`", "`lispsm`", "over `min-sm`",
                   "over `sm`", "status"], rows))


def views(results):
    methods = list(dict.fromkeys(run["method"] for run in results["views"]))
    maps = sorted({run["map"] for run in results["views"]})
    by_view = {}
    for run in results["views"]:
        place = (run["scene"], run["camera"], run["light"])
        by_view.setdefault(place, {})[run["map"], run["method"]] = run["wrong_pixel_ratio"]
    text = ""
    for size in maps:
        rows = [[f"{scene} {camera} {light}"] +
                [percent(wrong[size, m]) for m in methods]
                for (scene, camera, light), wrong in by_view.items()]
        for reference in ("dv", "sm"):
            row = [f"**over `{reference}`**"]
            for m in methods:
                ratios = [w[size, m] / w[size, reference] for w in by_view.values()
                          if w[size, reference] >= LEAST and w[size, m] > 0.0]
                row.append(f"**{geometric_mean(ratios):.3f}**, at most {max(ratios):.2f}")
            rows.append(row)
        text += f"At {size}²:\n\n"
        text += table(["scene camera light"] + [f"`{m}`" for m in methods], rows) + "\n"
    return text.rstrip("\n") + "\n"


def paths(results):
    by_path = {}
    for run in results["paths"]:
        place = (run["scene"], run["path"], run["frames"], run["map"])
        by_path.setdefault(place, {})[run["method"]] = run
    methods = list(dict.fromkeys(run["method"] for run in results["paths"]))
    rows = [[f"{scene}, {path}, {frames} frames, {size}²"] +
            [f"{100 * runs[m]['flip_ratio']:.3f} % / {percent(runs[m]['wrong_pixel_ratio'])}"
             for m in methods]
            for (scene, path, frames, size), runs in by_path.items()]
    return table(["path"] + [f"`{m}`" for m in methods], rows)


def main():
    arguments = sys.argv[1:]
    check = arguments == ["--check"]
    if len(arguments) == 2 and arguments[0] == "--gather":
        gather(pathlib.Path(arguments[1]))
    elif arguments and not check:
        sys.exit(__doc__.strip())
    results = json.loads(RESULTS.read_text(encoding="utf-8"))
    blocks = {"accuracy": accuracy(results), "pairs": pairs(results), "views": views(results),
              "paths": paths(results)}
    fill(PAGE, blocks, "docs/lispsm/write_page.py", check)


if __name__ == "__main__":
    main()
