#!/usr/bin/env python3
"""Writes the first block of README.md from docs/first-light/results.json.

usage: docs/first-light/write_readme.py [--check]

With --check nothing is written; the exit code tells whether the block is what the results say.
The results and pictures come from `./run.sh measure first-light`.
"""

import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from page_blocks import fill  # noqa: E402

FOLDER = pathlib.Path(__file__).resolve().parent
README = FOLDER.parent.parent / "README.md"
NAMES = {
    "sm": "plain shadow map",
    "dv": "focused on what is seen (`dv`)",
    "fitted": "warped by one matrix (`fitted`)",
    "notw": "warped by tables (`notw`)",
    "notw-hybrid": "warped by tables to where shadows end (`notw-hybrid`)",
    "raytraced": "ray traced",
}


def per_cent(run):
    return f"{100.0 * run['wrong_pixel_ratio']:.3g} %"


def block():
    results = json.loads((FOLDER / "results.json").read_text(encoding="utf-8"))
    runs = results["runs"]
    shown = {r["method"]: r for r in runs if r["scene"] == "outdoor"}
    side = shown["sm"]["map"]
    lines = [
        f"| {per_cent(shown['sm'])} of the lit-facing pixels wrong: plain shadow map, {side}² "
        f"| {per_cent(shown['notw-hybrid'])} wrong: warped, {side}² |",
        "|---|---|",
        "| ![plain shadow map](docs/first-light/outdoor-sm.png) "
        "| ![warped shadow map](docs/first-light/outdoor-notw-hybrid.png) |",
        "",
        "| scene | method | wrong pixels | frame | memory, MiB |",
        "|---|---|---:|---:|---:|",
    ]
    plain = {r["scene"]: r for r in runs if r["method"] == "sm"}
    for run in runs:
        ratio = run["frame_ms"]["median"] / plain[run["scene"]]["frame_ms"]["median"]
        lines.append(
            f"| {run['scene']} | {NAMES.get(run['method'], run['method'])} | {per_cent(run)} "
            f"| {ratio:.2f} | {run['bytes'] / 2**20:.1f} |"
        )
    width, height = runs[0]["view"]
    lines += [
        "",
        f"{width} × {height} pixels, {side}² texels, against ray-traced shadows; a frame is everything "
        "from the G-buffer to the shadow test, as a multiple of that of the plain map "
        f"({plain['outdoor']['frame_ms']['median']:.0f} ms outdoors), on {results['device']['renderer']}, which is "
        "a processor and no GPU. Written by `./run.sh measure first-light`.",
        "",
    ]
    return "\n".join(lines)


def main():
    check = sys.argv[1:] == ["--check"]
    if sys.argv[1:] and not check:
        sys.exit(__doc__.strip())
    fill(README, {"first-light": block()}, "docs/first-light/write_readme.py", check)


if __name__ == "__main__":
    main()
