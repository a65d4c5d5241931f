#!/usr/bin/env python3
"""Prints the cells of a figure in results.json as Markdown.

usage: warpshadow-lab --preset figure6 --out figure6 && table.py figure6/results.json
"""

import json
import sys


def cell_text(cell, run):
    bias = run["bias"]
    texels = bias["displacement_texels"]
    texels = "–" if texels is None else f"{texels:.2f}"
    if "mean_light_error" in cell:
        return (f"{100 * cell['filtered_acne_ratio']:.3f} % / {texels} / "
                f"{100 * cell['mean_light_error']:.1f} %")
    return f"{100 * bias['acne_ratio']:.1f} % / {texels} / {100 * run['wrong_pixel_ratio']:.1f} %"


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        results = json.load(file)
    for figure in results["figures"]:
        cells = figure["cells"]
        rows = list(dict.fromkeys(cell["row"] for cell in cells))
        columns = list(dict.fromkeys(cell["column"] for cell in cells))
        by_place = {(cell["row"], cell["column"]): cell for cell in cells}
        print("| | " + " | ".join(columns) + " |")
        print("| --- |" + " --- |" * len(columns))
        for row in rows:
            texts = [cell_text(by_place[row, c], results["runs"][by_place[row, c]["run"]])
                     if (row, c) in by_place else "" for c in columns]
            print(f"| {row} | " + " | ".join(texts) + " |")


main()
