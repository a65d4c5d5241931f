#!/usr/bin/env python3
"""Writes the tables of docs/warp-cost.md from the JSON files beside this script.

usage: docs/warp-cost/write_page.py [--check | --gather FOLDER]

With --check nothing is written; the exit code tells whether the tables are what the results say.
With --gather the results are first collected from FOLDER, to which `./run.sh measure warp-cost`
writes what the benchmarks and the lab say. papers.json is not measured: it is what papers say.
"""

import json
import pathlib
import re
import statistics
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import paper_tables  # noqa: E402
from page_blocks import fill, table  # noqa: E402

FOLDER = pathlib.Path(__file__).resolve().parent
PAGE = FOLDER.parent / "warp-cost.md"

# What a pipeline of the passes is asked to cost at most, in passes over the G-buffer.
PASSES_AIM = 1.0
# What building on the CPU is asked to cost at most, in copies of the map, per compilation and size.
BUILD_AIMS = {("native", 1024): 1.3, ("native", 2048): 1.6,
              **{("o2", size): 4.0 for size in (512, 1024, 2048)}}
# How much faster than the plain way points are asked to be.
POINT_AIMS = {"warp": 2.0, "unwarp": 4.0}
COMPILED = {"o2": "-O2", "native": "-O3 -march=native"}


def load(name):
    return json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))


def rounded(value, digits=4):
    return float(f"{value:.{digits}g}")


def gather(folder):
    def read(name):
        return json.loads((folder / name).read_text(encoding="utf-8"))

    def save(name, content):
        text = json.dumps(content, indent=1)
        # what is short on one line
        text = re.sub(r"[\[{]\s+([^\[\]{}]{1,160}?)\s+[\]}]",
                      lambda found: re.sub(r"\s+", " ", found.group(0)), text)
        (FOLDER / f"{name}.json").write_text(text + "\n", encoding="utf-8")

    passes = read("passes.json")
    for line in passes["lines"]:
        line["ratio"] = rounded(line["ratio"])
        line["steps"] = {name: rounded(ratio) for name, ratio in line["steps"].items()}
    passes["g_buffer_ms"] = rounded(passes["g_buffer_ms"])
    save("passes", passes)

    def medians(name):
        times = {}
        for run in read(name)["benchmarks"]:
            if run["run_type"] == "iteration":
                times.setdefault(run["run_name"], []).append(run["cpu_time"])
        return {name: rounded(statistics.median(each)) for name, each in times.items()}

    def report(name):
        found = folder / name / "results.json"
        return json.loads(found.read_text(encoding="utf-8")) if found.exists() else None

    save("lab", paper_tables.gather(report))
    save("cpu", {"microseconds": {"o2": medians("warp_build_bench.json"),
                                  "native": medians("warp_build_bench_native.json")}})


def ratio(value):
    return f"{value:.2f}"


def passes():
    found = load("passes")
    names = list(found["lines"][0]["steps"])
    rows = []
    for line in found["lines"]:
        cells, every = re.fullmatch(r"tables (\d+), every (\d+)", line["name"]).groups()
        share = "all" if every == "1" else f"1 in {int(every) ** 2}"
        kept = line["ratio"] <= PASSES_AIM
        rows.append([f"{cells}²", share] + [f"{line['steps'][name]:.3f}" for name in names] +
                    [f"**{line['ratio']:.2f}**" if kept else f"{line['ratio']:.2f}"])
    return (f"{found['triangles'] // 1000} k triangles, {found['view']} × {found['view']} pixels, median of "
            f"{found['rounds']} rounds, on {found['renderer']}. Bold: no more than the G-buffer.\n\n" +
            table(["tables", "samples"] + names + ["sum"], rows))


def cpu():
    times = load("cpu")["microseconds"]

    def aim(asked, met):
        return "" if asked is None else f"{asked:g}, {'kept' if met else 'missed'}"

    rows = []
    for compiled, flags in COMPILED.items():
        found = times[compiled]
        for size in (512, 1024, 2048):
            copy = found[f"copy/{size}"]
            mine = found[f"build/window/{size}"] / copy
            asked = BUILD_AIMS.get((compiled, size))
            rows.append([f"`{flags}`, {size}²", ratio(mine),
                         aim(asked, asked is not None and mine <= asked),
                         ratio(found[f"build/radius20/{size}"] / copy),
                         ratio(found[f"build/plain20/{size}"] / copy)])
    text = table(["build, in copies of the map", "default window", "asked", "radius 20",
                  "the same, one function after the other, in float"], rows) + "\n"
    rows = []
    for compiled, flags in COMPILED.items():
        found = times[compiled]
        for order in ("coherent", "random"):
            for size in (512, 1024):
                row = [f"`{flags}`, {size}², {order} points"]
                for what, plain in (("warp", "bilinear"), ("unwarp", "bisection")):
                    faster = (found[f"{what}/{plain}/{order}/{size}"] /
                              found[f"{what}/points/{order}/{size}"])
                    row += [ratio(faster), aim(POINT_AIMS[what], faster >= POINT_AIMS[what])]
                rows.append(row)
    return text + table(["times as fast", "`warp_points` as two bilinear look-ups", "asked",
                         "`unwarp_points` as bisection", "asked"], rows)


def main():
    arguments = sys.argv[1:]
    check = arguments == ["--check"]
    if arguments[:1] == ["--gather"] and len(arguments) == 2:
        gather(pathlib.Path(arguments[1]))
    elif arguments and not check:
        sys.exit(__doc__.strip())
    blocks = {"passes": passes(), "cpu": cpu(),
              **paper_tables.blocks(load("papers"), load("lab"))}
    fill(PAGE, blocks, "docs/warp-cost/write_page.py", check)


if __name__ == "__main__":
    main()
