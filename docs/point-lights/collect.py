#!/usr/bin/env python3
"""Brings what `./run.sh measure point-lights` measured together in docs/point-lights/measured.json.

usage: docs/point-lights/collect.py FOLDER

FOLDER has the reports of warpshadow-lab in walk-*/ and vpl-*/, the output of bench/omni_culling in
omni_culling*.json, and what the tests print in oracle.txt and chord.txt.
"""

import json
import pathlib
import re
import statistics
import sys

PAGE = pathlib.Path(__file__).resolve().parent


def rounded(value, digits):
    return float(f"{value:.{digits}g}")


def report(folder):
    return json.loads((folder / "results.json").read_text(encoding="utf-8"))


def walk(folder):
    """One walk: per method and size of the map what was measured in each frame."""
    results = report(folder)
    first = results["paths"][0]
    methods = []
    for path in results["paths"]:
        frames = path["frames"]
        methods.append({
            "method": path["method"],
            "map": path["map"],
            "wrong_pixel_ratio": rounded(path["mean"]["wrong_pixel_ratio"], 4),
            "frame_ms": [rounded(frame["frame_ms"], 4) for frame in frames],
            "shadow_map_ms": [rounded(frame["shadow_map_ms"], 4) for frame in frames],
            "maps": [frame["maps"] for frame in frames],
        })
    return {
        "name": folder.name.removeprefix("walk-"),
        "renderer": results["device"]["renderer"],
        "scene": first["scene"],
        "light": first["light"],
        "path": first["path"],
        "view": first["view"],
        "methods": methods,
    }


def vpl(folder):
    (record,) = report(folder)["vpl"]
    for way in record["ways"]:
        way["ms"] = [rounded(ms, 4) for ms in way["ms"]]
    return record


def oracle(text):
    line = re.compile(r"^(float|double) +(.+?) +pairs (\d+) meet (\d+) exact \d+ "
                      r"false negatives (\d+) false positives (\d+)", re.MULTILINE)
    classes = [{"type": kind, "class": name, "pairs": int(pairs), "meet": int(meet),
                "false_negatives": int(missed), "false_positives": int(kept)}
               for kind, name, pairs, meet, missed, kept in line.findall(text)]
    if not classes:
        sys.exit("oracle.txt has no class of pairs")
    return classes


def speed(file):
    """Median nanoseconds per benchmark."""
    times = {}
    for run in json.loads(file.read_text(encoding="utf-8"))["benchmarks"]:
        if run["run_type"] == "iteration":
            times.setdefault(run["run_name"], []).append(run["cpu_time"])
    return {name: rounded(statistics.median(each), 4) for name, each in times.items()}


def chord(text):
    found = re.search(r"edges are ([0-9.]+) texels off their arcs at most", text)
    if not found:
        sys.exit("chord.txt does not say how far edges are off their arcs")
    return float(found.group(1))


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__.strip())
    folder = pathlib.Path(sys.argv[1])
    measured = {
        "walks": [walk(each) for each in sorted(folder.glob("walk-*"))],
        "vpl": [vpl(each) for each in sorted(folder.glob("vpl-*"))],
        "oracle": oracle((folder / "oracle.txt").read_text(encoding="utf-8")),
        "speed": {"-O2": speed(folder / "omni_culling.json"),
                  "-O3 -march=native": speed(folder / "omni_culling_native.json")},
        "chord_texels": chord((folder / "chord.txt").read_text(encoding="utf-8")),
    }
    text = json.dumps(measured, indent=1)
    # lists of numbers on one line each
    text = re.sub(r"\[\s+([-0-9.,e\s]+?)\s+\]",
                  lambda found: "[" + re.sub(r"\s+", " ", found.group(1)) + "]", text)
    (PAGE / "measured.json").write_text(text + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
