#!/usr/bin/env python3
"""Writes the tables of docs/rasterising.md from the JSON files beside this script.

usage: docs/rasterising/write_page.py [--check | --figure FOLDER]

With --check nothing is written; the exit code tells whether the tables are what the results say.
With --figure the results and the details of the picture are first taken from the lab's report of
--preset figure7 in FOLDER.
The results come from `./run.sh measure rasterising`.
"""

import json
import math
import pathlib
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from page_blocks import fill  # noqa: E402

FOLDER = pathlib.Path(__file__).resolve().parent
PAGE = FOLDER.parent / "rasterising.md"


def load(name):
    return json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))


def geometric_mean(values):
    return math.exp(sum(math.log(v) for v in values) / len(values))


def picture_of(entry, cell, kind=""):
    """Name of the detail of a cell, or with "-map" of its map, as the lab writes it."""
    parts = (entry["figure"], entry["scene"], f"c{entry['camera']}", f"l{entry['light']}", cell["row"],
             cell["column"])
    return "-".join(parts).replace(":", "_") + kind + ".png"


def take_figure(folder):
    """Keeps what the page shows of figure7: its numbers and the details of the picture."""
    whole = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    kept = ("method", "raster", "map", "view", "wrong_pixel_ratio", "frame_ms", "triangles")
    (entry,) = whole["figures"]
    for old in FOLDER.glob("figure7-*.png"):
        old.unlink()
    for cell in entry["cells"]:
        for kind in ("", "-map"):
            shutil.copy(folder / picture_of(entry, cell, kind), FOLDER)
    small = {"device": whole["device"], "figures": [entry],
             "runs": [{key: run[key] for key in kept} for run in whole["runs"]]}
    (FOLDER / "figure7.json").write_text(json.dumps(small, indent=1) + "\n", encoding="utf-8")


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


def figure7():
    results = load("figure7")
    (entry,) = results["figures"]
    first = results["runs"][0]
    lines = [f"{entry['scene']}, camera {entry['camera']}, light {entry['light']}, map {first['map']}², "
             f"view {first['view'][0]} × {first['view'][1]}, on {results['device']['renderer']}."]
    for method in dict.fromkeys(cell["row"] for cell in entry["cells"]):
        cells = [cell for cell in entry["cells"] if cell["row"] == method]
        across = 3 if len(cells) % 3 == 0 else 4  # no short row
        plain = results["runs"][cells[0]["run"]]["frame_ms"]["median"]
        lines += ["", f"`{method}`:", ""]
        for begin in range(0, len(cells), across):
            part = cells[begin:begin + across]
            names, pictures, maps, texts = [], [], [], []
            for cell in part:
                run = results["runs"][cell["run"]]
                names.append(f"`{cell['column']}`")
                for kind, shown in (("", pictures), ("-map", maps)):
                    name = picture_of(entry, cell, kind)
                    if not (FOLDER / name).exists():
                        sys.exit(f"docs/rasterising/{name} is missing")
                    shown.append(f"![{method}, {cell['column']}{kind.replace('-', ', ')}]"
                                 f"(rasterising/{name})")
                text = (f"{100 * run['wrong_pixel_ratio']:.2f} % pixels, "
                        f"{100 * cell['wrong_texel_ratio']:.2f} % texels")
                if cell["column"] != "ideal":
                    text += (f", {thousands(run['triangles'])} triangles, "
                             f"{run['frame_ms']['median'] / plain:.1f}")
                texts.append(text)
            if begin == 0:
                lines += ["| " + " | ".join(names) + " |", "|" + " --- |" * across]
            else:
                lines.append("| " + " | ".join(names) + " |")
            lines += ["| " + " | ".join(row) + " |" for row in (pictures, maps, texts)]
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
    arguments = sys.argv[1:]
    check = arguments == ["--check"]
    if arguments[:1] == ["--figure"] and len(arguments) == 2:
        take_figure(pathlib.Path(arguments[1]))
    elif arguments and not check:
        sys.exit(__doc__.strip())
    blocks = {name: "\n".join(table()) + "\n"
              for name, table in (("chain", chain), ("figure7", figure7), ("views", views),
                                  ("folds", folds))}
    fill(PAGE, blocks, "docs/rasterising/write_page.py", check)


if __name__ == "__main__":
    main()
