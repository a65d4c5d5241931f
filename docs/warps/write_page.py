#!/usr/bin/env python3
"""Writes the tables of docs/warps.md from docs/warps/results.json.

usage: docs/warps/write_page.py [--check | --from RESULTS]

With --check nothing is written; the exit code tells whether the tables are what the results say.
With --from, docs/warps/results.json is first made from the lab's results.json: what the page needs
of it. The results come from `./run.sh measure warps`.
"""

import json
import math
import pathlib
import statistics
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from page_blocks import fill, table  # noqa: E402

FOLDER = pathlib.Path(__file__).resolve().parent
PAGE = FOLDER.parent / "warps.md"
RESULTS = FOLDER / "results.json"
KEPT = ("scene", "camera", "light", "method", "map", "samples", "wrong_pixel_ratio", "pass_ms",
        "bytes", "triangles")
# method, against what, and the share of its wrong pixels that was aimed at
AIMS = (("notw", "sm", 0.40), ("notw", "dv", 0.50), ("notw", "rtw-backward", 0.85),
        ("notw-fine", "sm", 0.40), ("notw-fine", "dv", 0.50), ("notw-fine", "rtw-backward", 0.85),
        ("notw-hybrid", "sm", 0.40), ("notw-hybrid", "dv", 0.50),
        ("notw-hybrid", "rtw-backward", 0.85),
        ("notw-edges", "notw", 0.70), ("notw-hybrid", "notw", 0.70),
        ("notw-hybrid", "notw-fine", 0.70))


def reduce(source):
    whole = json.loads(pathlib.Path(source).read_text(encoding="utf-8"))
    runs = [{key: run[key] for key in KEPT} for run in whole["runs"]]
    for run in runs:
        run["pass_ms"] = {name: round(ms, 3) for name, ms in run["pass_ms"].items()}
    small = {"device": whole["device"], "view": whole["runs"][0]["view"], "runs": runs}
    RESULTS.write_text(json.dumps(small, indent=0) + "\n", encoding="utf-8")


class Runs:
    def __init__(self, runs):
        self.runs = runs
        self.by = {(r["scene"], r["camera"], r["light"], r["map"], r["method"]): r for r in runs}
        self.views = list(dict.fromkeys((r["scene"], r["camera"], r["light"]) for r in runs))
        self.maps = list(dict.fromkeys(r["map"] for r in runs))
        self.methods = list(dict.fromkeys(r["method"] for r in runs))

    def wrong(self, view, side, method):
        run = self.by[(*view, side, method)]
        # a view without a wrong pixel would make every geometric mean zero: half a pixel instead
        return max(run["wrong_pixel_ratio"], 0.5 / run["samples"])

    def ratios(self, method, other, maps):
        return [(self.wrong(v, m, method) / self.wrong(v, m, other), v, m)
                for v in self.views for m in maps]


def mean(values):
    return math.exp(statistics.fmean(math.log(v) for v in values))


def name_of(view, side=None):
    text = f"{view[0]}, camera {view[1]}, light {view[2]}"
    return text if side is None else f"{text}, {side}²"


def claims(runs):
    rows = []
    for method, other, aim in AIMS:
        all_ratios = runs.ratios(method, other, runs.maps)
        worst = max(all_ratios)
        row = [f"`{method}` / `{other}`", f"{aim:.2f}", f"{mean([r[0] for r in all_ratios]):.3f}"]
        row += [f"{mean([r[0] for r in runs.ratios(method, other, [m])]):.3f}" for m in runs.maps]
        row += [f"{worst[0]:.2f} ({name_of(*worst[1:])})",
                f"{sum(r[0] > 1 for r in all_ratios)} of {len(all_ratios)}"]
        rows.append(row)
    return table(["wrong pixels", "aim", "geometric mean"] + [f"{m}²" for m in runs.maps] +
                 ["worst view", "views above 1"], rows)


def methods(runs):
    rows = []
    for method in runs.methods:
        row = [f"`{method}`"]
        for side in runs.maps:
            row.append(f"{100 * mean([runs.wrong(v, side, method) for v in runs.views]):.3g} %")
        for other in ("sm", "dv", "notw"):
            row.append(f"{mean([r[0] for r in runs.ratios(method, other, runs.maps)]):.3f}")
        rows.append(row)
    return table(["method"] + [f"wrong pixels, {m}²" for m in runs.maps] +
                 ["against `sm`", "against `dv`", "against `notw`"], rows)


def views(runs):
    text = ""
    for side in runs.maps:
        rows = [[name_of(v)] + [f"{100 * runs.by[(*v, side, m)]['wrong_pixel_ratio']:.3g}"
                                for m in runs.methods] for v in runs.views]
        text += f"Per cent of the lit-facing pixels that are wrong, {side}²:\n\n"
        text += table(["view"] + [f"`{m}`" for m in runs.methods], rows) + "\n"
    return text


def times(runs):
    """Time of each pass over that of the G-buffer, and of all of them over sm's."""
    text = ""
    for side in runs.maps:
        names = list(dict.fromkeys(n for r in runs.runs for n in r["pass_ms"]))
        names.remove("g-buffer")
        names.sort(key=lambda n: (n == "shadow test", n == "keep shadows"))

        def total(view, method, side=side):
            return sum(runs.by[(*view, side, method)]["pass_ms"].values())

        rows = []
        for name in names:
            row = [name]
            for method in runs.methods:
                shares = [runs.by[(*v, side, method)]["pass_ms"][name] /
                          runs.by[(*v, side, method)]["pass_ms"]["g-buffer"]
                          for v in runs.views if name in runs.by[(*v, side, method)]["pass_ms"]]
                row.append(f"{statistics.median(shares):.2f}" if shares else "")
            rows.append(row)
        building = [
            statistics.median(sum(ms for n, ms in runs.by[(*v, side, m)]["pass_ms"].items()
                                  if n not in DRAWING) /
                              runs.by[(*v, side, m)]["pass_ms"]["g-buffer"] for v in runs.views)
            for m in runs.methods]
        rows.append(["**making the warp**"] + [f"**{b:.2f}**" if b else "" for b in building])

        def against(method, other, passes, side=side):
            """Of the passes of a kind, the median over the views of the ratio to another method's."""
            def spent(view, name):
                return sum(ms for n, ms in runs.by[(*view, side, name)]["pass_ms"].items()
                           if passes(n))
            return statistics.median(spent(v, method) / spent(v, other) for v in runs.views)

        rows.append(["**making the warp, against `notw`**"] + [
            f"**{against(m, 'notw', lambda n: n not in DRAWING):.2f}**" if b else ""
            for m, b in zip(runs.methods, building)])
        rows.append(["**drawing the map, against `dv`**"] + [
            f"**{against(m, 'dv', lambda n: n in MAP):.2f}**" for m in runs.methods])
        rows.append(["**all passes, against `sm`**"] + [
            f"**{mean([total(v, m) / total(v, 'sm') for v in runs.views]):.2f}**"
            for m in runs.methods])
        text += f"Time over that of the G-buffer, median over the views, {side}²:\n\n"
        text += table(["pass"] + [f"`{m}`" for m in runs.methods], rows) + "\n"
    return text


# passes that are not of the making of a warp
DRAWING = ("g-buffer", "unwarp centres", "set up triangles", "cut triangles", "shadow map",
           "shadow test")
# passes that draw the map
MAP = ("set up triangles", "cut triangles", "shadow map")


def note(results, runs):
    width, height = results["view"]
    sides = " and ".join(f"{m}²" for m in runs.maps)
    return (f"{len(runs.views)} views, maps of {sides}, {width} × {height} pixels, against ray-traced shadows, on "
            f"{results['device']['renderer']}. Written by `./run.sh measure warps`.\n")


def main():
    arguments = sys.argv[1:]
    check = arguments == ["--check"]
    if arguments[:1] == ["--from"] and len(arguments) == 2:
        reduce(arguments[1])
    elif arguments and not check:
        sys.exit(__doc__.strip())
    results = json.loads(RESULTS.read_text(encoding="utf-8"))
    runs = Runs(results["runs"])
    blocks = {"claims": claims(runs) + "\n" + note(results, runs), "methods": methods(runs),
              "views": views(runs), "times": times(runs)}
    fill(PAGE, blocks, "docs/warps/write_page.py", check)


if __name__ == "__main__":
    main()
