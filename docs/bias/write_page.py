#!/usr/bin/env python3
"""Writes the tables of docs/bias.md from docs/bias/figure6.json and figure8.json.

usage: docs/bias/write_page.py [--check]

With --check nothing is written; the exit code tells whether the tables are what the results say.
The results come from `./run.sh measure bias`.
"""

import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from page_blocks import fill  # noqa: E402

FOLDER = pathlib.Path(__file__).resolve().parent
PAGE = FOLDER.parent / "bias.md"


def cell_text(cell, run):
    bias = run["bias"]
    texels = bias["displacement_texels"]
    texels = "–" if texels is None else f"{texels:.2f}"
    if "mean_light_error" in cell:
        return (f"{100 * cell['filtered_acne_ratio']:.3f} % / {texels} / "
                f"{100 * cell['mean_light_error']:.1f} %")
    return f"{100 * bias['acne_ratio']:.1f} % / {texels} / {100 * run['wrong_pixel_ratio']:.1f} %"


def table(figure):
    results = json.loads((FOLDER / f"{figure}.json").read_text(encoding="utf-8"))
    (entry,) = results["figures"]
    cells = entry["cells"]
    rows = list(dict.fromkeys(cell["row"] for cell in cells))
    columns = list(dict.fromkeys(cell["column"] for cell in cells))
    by_place = {(cell["row"], cell["column"]): cell for cell in cells}
    first = results["runs"][0]
    lines = [
        f"The scene {entry['scene']} at {first['map']}², {first['view'][0]} × {first['view'][1]} "
        "pixels:",
        "",
        "| | " + " | ".join(columns) + " |",
        "| --- |" + " --- |" * len(columns),
    ]
    for row in rows:
        texts = [cell_text(by_place[row, c], results["runs"][by_place[row, c]["run"]])
                 if (row, c) in by_place else "" for c in columns]
        lines.append(f"| {row} | " + " | ".join(texts) + " |")
    return "\n".join(lines) + "\n"


def main():
    check = sys.argv[1:] == ["--check"]
    if sys.argv[1:] and not check:
        sys.exit(__doc__.strip())
    fill(PAGE, {figure: table(figure) for figure in ("figure6", "figure8")},
         "docs/bias/write_page.py", check)


if __name__ == "__main__":
    main()
