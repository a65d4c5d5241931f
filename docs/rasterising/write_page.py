#!/usr/bin/env python3
"""Writes the tables of docs/rasterising.md from the JSON files beside this script.

usage: docs/rasterising/write_page.py [--check]

With --check nothing is written; the exit code tells whether the tables are what the results say.
The results come from `./run.sh measure rasterising`.
"""

import json
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from page_blocks import fill  # noqa: E402

FOLDER = pathlib.Path(__file__).resolve().parent
PAGE = FOLDER.parent / "rasterising.md"


def load(name):
    return json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))


def geometric_mean(values):
    return math.exp(sum(math.log(v) for v in values) / len(values))


def thousands(n):
    return f"{n:,}".replace(",", " ")


def chain():
    runs = load("chain")["runs"]
    scenes = list(dict.fromkeys(run["scene"] for run in runs))
    ways = list(dict.fromkeys(run.get("raster", run["method"]) for run in runs))
    by_place = {(run["scene"], run.get("raster", run["method"])): run for run in runs}
    first = runs[0]
    lines = [f"Camera 0, light 0, map {first['map']}², view {first['view'][0]} × "
             f"{first['view'][1]}: wrong pixels / triangles drawn / time of a frame as a ratio to "
             "`dv`.", "",
             "| | " + " | ".join(scenes) + " |", "| --- |" + " --- |" * len(scenes)]
    for way in ways:
        texts = []
        for scene in scenes:
            run = by_place[scene, way]
            time = run["frame_ms"]["median"] / by_place[scene, "dv"]["frame_ms"]["median"]
            drawn = "–" if way == "ideal" else thousands(run["triangles"])
            frame = "–" if way == "ideal" else f"{time:.1f}"
            texts.append(f"{100 * run['wrong_pixel_ratio']:.2f} % / {drawn} / {frame}")
        lines.append(f"| `{way}` | " + " | ".join(texts) + " |")
    return lines


def views():
    runs = load("views")["runs"]
    by_place = {}
    for run in runs:
        key = (run["scene"], run["camera"], run["light"])
        by_place.setdefault(key, {})[run["map"], run["method"]] = run
    sizes = sorted({run["map"] for run in runs})
    lines = ["| view | " + " | ".join(f"{m}²: `dv` | `notw` | ratio | weakened" for m in sizes) +
             " |", "| --- |" + " --: |" * (4 * len(sizes))]
    ratios = {m: [] for m in sizes}
    for (scene, camera, light), found in by_place.items():
        texts = []
        for m in sizes:
            plain = found[m, "dv"]["wrong_pixel_ratio"]
            warped = found[m, "notw"]["wrong_pixel_ratio"]
            ratio = warped / plain if plain > 0 else 1.0
            ratios[m].append(ratio)
            texts.append(f"{100 * plain:.2f} % | {100 * warped:.2f} % | {ratio:.2f} | "
                         f"{found[m, 'notw']['weakened']:.2f}")
        lines.append(f"| {scene}, camera {camera}, light {light} | " + " | ".join(texts) + " |")
    lines.append("| geometric mean | " +
                 " | ".join(f" | | {geometric_mean(ratios[m]):.2f} | " for m in sizes) + " |")
    return lines


def folds():
    results = load("folds")
    sizes = list(results["entries"][0]["flipped"])
    lines = [f"Map {results['map']}², {thousands(results['triangles_per_size'])} triangles of each "
             "size.", "",
             "| scene | s | λ | " + " | ".join(f"{size} texel{'s' if size != '1' else ''}"
                                              for size in sizes) +
             " | all | none turns over in pieces of |",
             "| --- | --: | --: |" + " --: |" * (len(sizes) + 2)]
    for entry in results["entries"]:
        limit = "∞" if entry["shear_limit"] is None else f"{entry['shear_limit']:g}"
        cells = [f"{entry['flipped'][size]:.1e}" if entry["flipped"][size] else "0"
                 for size in sizes]
        every = f"{entry['flipped_of_all']:.1e}" if entry["flipped_of_all"] else "0"
        enough = entry["none_at_subdivision"]
        pieces = "none tried" if enough is None else "1" if enough == 1 else f"1/{enough}"
        lines.append(f"| {entry['scene']} | {limit} | {max(entry['mix']):.2f} | " +
                     " | ".join(cells) + f" | {every} | {pieces} |")
    limits = list(dict.fromkeys(entry["shear_limit"] for entry in results["entries"]))
    for limit in limits:
        found = [entry for entry in results["entries"] if entry["shear_limit"] == limit]
        shares = [sum(entry["flipped"][size] for entry in found) / len(found) for size in sizes]
        shares.append(sum(entry["flipped_of_all"] for entry in found) / len(found))
        cells = [f"{share:.1e}" if share else "0" for share in shares]
        lines.append(f"| all scenes | {'∞' if limit is None else f'{limit:g}'} | | " +
                     " | ".join(cells) + " | |")
    return lines


def main():
    check = sys.argv[1:] == ["--check"]
    if sys.argv[1:] and not check:
        sys.exit(__doc__.strip())
    blocks = {name: "\n".join(table()) + "\n"
              for name, table in (("chain", chain), ("views", views), ("folds", folds))}
    fill(PAGE, blocks, "docs/rasterising/write_page.py", check)


if __name__ == "__main__":
    main()
