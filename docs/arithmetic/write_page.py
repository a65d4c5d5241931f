#!/usr/bin/env python3
"""Writes the tables of docs/arithmetic.md and the plots beside this file from arithmetic.json.

usage: docs/arithmetic/write_page.py [--check]

With --check nothing is written; the exit code tells whether page and plots are what the file says.
It comes from `./run.sh measure arithmetic`.
"""

import json
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from page_blocks import fill, keep_pictures  # noqa: E402

import plots  # noqa: E402

FOLDER = pathlib.Path(__file__).resolve().parent
PAGE = FOLDER.parent / "arithmetic.md"

# What one pays for what: kernel, from which variant to which, in which kinds of inputs.
STEPS = [
    ("warp", "float", "double", ("view",)),
    ("warp", "float", "float, UNORM16 nodes", ("view",)),
    ("warp", "float, row by floor", "float", ("view",)),
    ("unwarp", "float, bisection", "double, bisection", ("sheared",)),
    ("unwarp", "float, bisection", "float, guide", ("view",)),
    ("unwarp", "float, guide", "float, `unwarp_points`", ("view",)),
    ("table build", "plain: sums in float", "float", ("heavy cells",)),
    ("orientation", "float", "double", ("near a line",)),
    ("orientation of doubles", "double", "adaptive, `orient2d`", ("random", "near a line")),
    ("hull", "float, plain chain", "float, `convex_hull`", ("near a line",)),
    ("rectangle", "float, plain", "float, `min_area_rectangle`", ("random",)),
    ("rectangle", "float, `min_area_rectangle`", "double, `min_area_rectangle`", ("far off",)),
    ("n_opt", "float, sine from the dot product", "double, `inverse_n_opt`", ("small angle",)),
    ("light matrix", "float, naive, world space", "float, `lispsm`",
     ("typical", "light along the view")),
    ("paraboloid", "float, xy / (|p| + z)", "float, `paraboloid_uv`",
     ("front", "near the far pole")),
    ("footprint bias", "float, `footprint_bias`", "double, `footprint_bias`", ("sheared",)),
    ("frustum test", "float, no bounds", "prepared, `intersects`", ("anywhere", "touching")),
    ("cube faces", "fast", "refined", ("light anywhere",)),
    ("clipping", "float, a + t (b - a)", "float, `intersection_vertices`", ("view and box",)),
    ("clipping", "float, `intersection_vertices`", "double, `intersection_vertices`",
     ("view and box",)),
]


def digits(value, count):
    return f"{value:.{count}g}"


def duration(ns):
    if ns < 1000.0:
        return digits(ns, 3 if ns >= 100.0 else 2) + " ns"
    return digits(ns / 1000.0, 3) + " µs"


def size(value):
    """An error: two digits."""
    if value is None:
        return "undefined"
    if value == 0.0:
        return "0"
    if 100.0 <= value < 1000.0:
        return f"{value:.0f}"
    if 0.01 <= value < 100.0:
        return digits(value, 2)
    return f"{value:.1e}".replace("e-0", "e-").replace("e+0", "e").replace("e+", "e")


def wrong(row):
    return row["missed_per_million"] + row["in_vain_per_million"]


def count(value):
    return "0" if value == 0.0 else f"{value:.0f}" if value < 1000.0 else f"{value / 1000.0:.3g} k"


def decided(row, missing_matters):
    if missing_matters and row["missed_per_million"] > 0.0:
        return f"{count(row['missed_per_million'])} missed + {count(row['in_vain_per_million'])}"
    return count(wrong(row))


def error(kernel, row):
    if kernel["decisions"]:
        return decided(row, True)
    if row["undefined"] > 0:
        return f"undefined in {digits(100.0 * row['undefined'] / row['inputs'], 2)} %"
    return size(row["p999"])


def rows_of(kernel, build):
    return [row for row in kernel["rows"] if row["build"] == build]


def row_of(kernel, variant, envelope, build=0):
    (found,) = (row for row in kernel["rows"]
                if (row["variant"], row["envelope"], row["build"]) == (variant, envelope, build))
    return found


def variants_of(kernel):
    return list(dict.fromkeys(row["variant"] for row in kernel["rows"]))


def table(head, align, rows):
    marks = {"l": "---", "r": "---:"}
    lines = ["| " + " | ".join(head) + " |", "|" + "|".join(marks[a] for a in align) + "|"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def unit_of(kernel):
    return "wrong per million" if kernel["decisions"] else kernel["unit"]


def steps(kernels):
    rows = []
    for name, before, after, envelopes in STEPS:
        kernel = kernels[name]
        for envelope in envelopes:
            a = row_of(kernel, before, envelope)
            b = row_of(kernel, after, envelope)
            ratio = b["ns"]["fastest"] / a["ns"]["fastest"]
            rows.append([f"{name}, {envelope}", f"{before} → {after}",
                         f"{duration(a['ns']['fastest'])} → {duration(b['ns']['fastest'])}",
                         f"**× {digits(ratio, 2)}**",
                         f"{error(kernel, a)} → {error(kernel, b)}", unit_of(kernel)])
    return table(["kernel, inputs", "step", "time", "", "error", "in"], "llrrrl",
                 [[cell.replace("|", "\\|") for cell in row] for row in rows])


def native_ratio(kernel, variant):
    ratios = [row_of(kernel, variant, e["name"], 1)["ns"]["fastest"] /
              row_of(kernel, variant, e["name"], 0)["ns"]["fastest"]
              for e in kernel["envelopes"]]
    return "× " + digits(math.exp(sum(map(math.log, ratios)) / len(ratios)), 2)


def kernel_table(kernel):
    envelopes = [each["name"] for each in kernel["envelopes"]]
    head = ["", "variant", *envelopes, "native"]
    rows = []
    for i, variant in enumerate(variants_of(kernel), 1):
        cells = []
        for envelope in envelopes:
            row = row_of(kernel, variant, envelope)
            text = error(kernel, row)
            if not kernel["decisions"] and row["largest"] is not None:
                text += f" ({size(row['largest'])})"
            cells.append(f"{duration(row['ns']['fastest'])}: {text}")
        rows.append([str(i), variant.replace("|", "\\|"), *cells, native_ratio(kernel, variant)])
    return table(head, "rl" + "r" * len(envelopes) + "r", rows)


def file_of(kernel):
    return kernel["name"].replace(" ", "-").replace("_", "-") + ".svg"


def sections(measured):
    parts = []
    for kernel in measured["kernels"]:
        counts = [row["inputs"] for row in rows_of(kernel, 0)]
        inputs = " to ".join(str(n) for n in sorted({min(counts), max(counts)}))
        # a name in code style: an underscore is one
        title = f"`{kernel['name']}`" if "_" in kernel["name"] else kernel["name"].capitalize()
        text = f"### {title}\n\n{kernel['what'][0].upper()}{kernel['what'][1:]}.\n"
        judged = "decisions" if kernel["decisions"] else "results"
        text += (f"Time per {kernel['per']}, error in {unit_of(kernel)}; {inputs} {judged} of each "
                 "kind:\n\n")
        text += "".join(f"- *{e['name']}*: {e['text']}\n" for e in kernel["envelopes"])
        text += f"\n![{kernel['name']}: error against time](arithmetic/{file_of(kernel)})\n\n"
        parts.append(text + kernel_table(kernel))
    return "\n".join(parts)


def fused(measured):
    """Where the second build, which fuses products and sums, differs by more than a factor of 2."""
    rows = []
    for kernel in measured["kernels"]:
        for row in rows_of(kernel, 0):
            other = row_of(kernel, row["variant"], row["envelope"], 1)
            value = wrong if kernel["decisions"] else lambda r: r["p999"]
            a, b = value(row), value(other)
            if a is None and b is None:
                continue
            # too few cases to be more than chance
            few = kernel["decisions"] and max(a, b) < 10e6 / row["inputs"]
            if a is None or b is None or (max(a, b) > 2.0 * min(a, b) and not few):
                rows.append([kernel["name"], row["envelope"], row["variant"].replace("|", "\\|"),
                             error(kernel, row), error(kernel, other), unit_of(kernel)])
    flags = [f"`{build['flags']}`" for build in measured["builds"]]
    return table(["kernel", "inputs", "variant", *flags, "in"], "lllrrl", rows)


def machine(measured):
    flags = ", ".join(f"`{build['flags']}` ({build['doubles_at_once']} doubles at once)"
                      for build in measured["builds"])
    return (f"{measured['processor']}, {measured['compiler']}; builds {flags}. The fastest of "
            f"{measured['rounds']} interleaved rounds.\n")


def main():
    check = sys.argv[1:] == ["--check"]
    if sys.argv[1:] and not check:
        sys.exit(__doc__.strip())
    measured = json.loads((FOLDER / "arithmetic.json").read_text(encoding="utf-8"))
    kernels = {kernel["name"]: kernel for kernel in measured["kernels"]}
    pictures = {}
    for kernel in measured["kernels"]:
        series = [(envelope["name"], [
            (str(i), row["ns"]["fastest"], wrong(row) if kernel["decisions"] else row["p999"])
            for i, variant in enumerate(variants_of(kernel), 1)
            for row in [row_of(kernel, variant, envelope["name"])]])
            for envelope in kernel["envelopes"]]
        unit = unit_of(kernel) if kernel["decisions"] else f"{kernel['unit']}, 99.9 %"
        pictures[file_of(kernel)] = plots.scatter(series, variants_of(kernel),
                                                  f"ns per {kernel['per']}", unit)
    keep_pictures(FOLDER, pictures, "docs/arithmetic/write_page.py", check)
    blocks = {"steps": steps(kernels), "machine": machine(measured), "kernels": sections(measured),
              "fused": fused(measured)}
    fill(PAGE, blocks, "docs/arithmetic/write_page.py", check)


if __name__ == "__main__":
    main()
