#!/usr/bin/env python3
"""Writes the tables of docs/accuracy.md and of README.md from sweep.json beside this file.

usage: docs/accuracy/write_page.py [--check | --gather RESULTS]

With --gather, sweep.json is made of the results.json of a sweep first. With --check nothing is
written; the exit code tells whether the pages are what the file says.
"""

import json
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from page_blocks import fill  # noqa: E402

FOLDER = pathlib.Path(__file__).resolve().parent
PAGE = FOLDER.parent / "accuracy.md"
README = FOLDER.parents[1] / "README.md"
KINDS = {"sun": "suns", "spot": "spot lights", "point": "point lights"}


def gather(source):
    """What the page needs of a sweep."""
    results = json.loads(pathlib.Path(source).read_text())
    keys = ("scene", "camera", "light", "light_kind", "method", "map", "variant",
            "wrong_pixel_ratio", "bytes")
    runs = [{**{k: r[k] for k in keys if k in r}, "frame_ms": round(r["frame_ms"]["median"], 3)}
            for r in results["runs"]]
    kept = {"device": results["device"], "view": results["runs"][0]["view"],
            "frames": max(r["frame_ms"]["n"] for r in results["runs"]),
            "accuracy": results["accuracy"],
            "paths": [{**{k: p[k] for k in ("scene", "camera", "light", "path", "method", "map")},
                       "frames": len(p["frames"]), "flip_ratio": p["mean"]["flip_ratio"],
                       "wrong_pixel_ratio": p["mean"]["wrong_pixel_ratio"]}
                      for p in results["paths"]]}
    text = json.dumps(kept, indent=1)[:-2] + ',\n "runs": [\n'
    text += ",\n".join("  " + json.dumps(run) for run in runs) + "\n ]\n}\n"
    (FOLDER / "sweep.json").write_text(text)


def row(cells):
    return "| " + " | ".join(cells) + " |"


def times(ratio):
    return f"{ratio:.2f}" if ratio < 10 else f"{ratio:.0f}"


def percent(ratio):
    return f"{100 * ratio:.2f} %"


def mean(ratios):
    return math.exp(sum(map(math.log, ratios)) / len(ratios)) if ratios else None


def about(sweep):
    width, height = sweep["view"]
    return (f"{width} × {height} pixels, median of up to {sweep['frames']} frames, a round each, on "
            f"{sweep['device']['renderer'].split(' (')[0]}")


def answer(sweep, scenes=None):
    accuracy = sweep["accuracy"]
    budgets = list(dict.fromkeys(b["budget"] for b in accuracy["budgets"]))
    head = ["any time" if b is None else f"≤ {b:g}×" for b in budgets]
    lines = [row(["scene", "lights", *head]), row(["---"] * (2 + len(head)))]
    groups = dict.fromkeys((b["scene"], b["light_kind"]) for b in accuracy["budgets"])
    for scene, kind in groups:
        if scenes and scene not in scenes:
            continue
        best = {b["budget"]: b for b in accuracy["budgets"]
                if (b["scene"], b["light_kind"]) == (scene, kind)}
        cells = [f"`{best[b]['method']}` {best[b]['map']}²: {percent(best[b]['wrong_pixel_ratio'])}"
                 if b in best else "–" for b in budgets]
        lines.append(row([scene, KINDS[kind], *cells]))
    return (f"Fewest wrong pixels for a frame time. 1 is the frame of `sm` at {accuracy['map']}², "
            f"of `cube6` for point lights; {about(sweep)}.\n\n" + "\n".join(lines) + "\n")


def scores(sweep):
    size = sweep["accuracy"]["map"]
    text = ""
    for kind, name in KINDS.items():
        chosen = sorted((s for s in sweep["accuracy"]["scores"]
                         if s["light_kind"] == kind and s["map"] == size
                         and " " not in s["method"]), key=lambda s: s["wrong"])
        if not chosen:
            continue
        text += f"{name.capitalize()}, {max(s['views'] for s in chosen)} views, maps of {size}²:\n\n"
        text += row(["method", "wrong", "frame time", "bytes", "better", "worse"]) + "\n"
        text += row(["---"] + ["--:"] * 5) + "\n"
        for s in chosen:
            text += row([f"`{s['method']}`", times(s["wrong"]), times(s["frame_time"]),
                         times(s["bytes"]), str(s["better"]), str(s["worse"])]) + "\n"
        text += "\n"
    return text


def exact(sweep):
    """Methods without a map: how far they agree, and what they cost."""
    views = {}
    for run in sweep["runs"]:
        views.setdefault((run["scene"], run["camera"], run["light"]), []).append(run)
    lines = [row(["scene", "light", "`sv` and rays differ", "frame of `sv`", "of `raytraced`"]),
             row(["---", "---", "--:", "--:", "--:"])]
    for (scene, _, light), runs in views.items():
        plain = next((r for r in runs if r["method"] in ("sm", "cube6")
                      and r["map"] == sweep["accuracy"]["map"]), None)
        by_name = {r["method"]: r for r in runs if r["map"] == 0}
        if plain is None or "sv" not in by_name:
            continue
        lines.append(row([scene, light, f"{100 * by_name['sv']['wrong_pixel_ratio']:.3f} %",
                          *(times(by_name[m]["frame_ms"] / plain["frame_ms"])
                            for m in ("sv", "raytraced"))]))
    return "\n".join(lines) + "\n"


def matched(sweep, rows, head, key):
    """What matches each target on each view: the size of the map, and a ratio to the target."""
    methods = [m for m in dict.fromkeys(r["method"] for r in rows) if " " not in m]
    shown = [m for m in ("sm", "pssm", "sdsm", "min-sm", "dv", "fitted", "notw", "cube6", "dpsm")
             if m in methods]
    size = sweep["accuracy"]["map"]
    lines = [row(["view", head, *(f"`{m}`" for m in shown)]), row(["---"] * (2 + len(shown)))]
    for scene, camera, light, target in dict.fromkeys(
            (r["scene"], r["camera"], r["light"], r["target"]) for r in rows):
        cells = []
        for method in shown:
            found = next((r for r in rows if (r["scene"], r["camera"], r["light"], r["target"],
                                              r["method"])
                          == (scene, camera, light, target, method)), None)
            cells.append("" if found is None else "none" if found["map"] is None else
                         f"{found['map']}²: {times(found[key])}")
        view = scene if camera == "0" else f"{scene}, camera {camera}"
        lines.append(row([f"{view}, {light}", f"`{target}` {size}²", *cells]))
    return "\n".join(lines) + "\n"


def equal_quality(sweep):
    return matched(sweep, sweep["accuracy"]["equal_quality"], "as good as", "frame_time")


def equal_time(sweep):
    return matched(sweep, sweep["accuracy"]["equal_time"], "no longer than", "wrong")


def doubling(sweep):
    """What twice the side of a map leaves of the wrong pixels."""
    by = {(r["scene"], r["camera"], r["light"], r["method"], r["map"]): r["wrong_pixel_ratio"]
          for r in sweep["runs"] if "variant" not in r}
    ratios = {}
    for (*view, method, size), wrong in by.items():
        half = by.get((*view, method, size // 2))
        if size and half and wrong:
            ratios.setdefault(method, []).append(wrong / half)
    return ("Twice the side of the map leaves this share of the wrong pixels (geometric mean over views "
            "and sizes): " + ", ".join(f"`{m}` {times(mean(r))}" for m, r in ratios.items()) + ".\n")


def temporal(sweep):
    """What flips while the camera turns, in every thousand pixels."""
    paths = sweep["paths"]
    methods = list(dict.fromkeys(p["method"] for p in paths))
    lines = [row(["view", *(f"`{m}`" for m in methods)]), row(["---"] + ["--:"] * len(methods))]
    for scene, light in dict.fromkeys((p["scene"], p["light"]) for p in paths):
        of = {p["method"]: p for p in paths if (p["scene"], p["light"]) == (scene, light)}
        lines.append(row([f"{scene}, {light}", *(
            f"{1000 * of[m]['flip_ratio']:.2f}" if m in of else "" for m in methods)]))
    first = paths[0]
    return (f"`--path {first['path']}`, {first['frames']} frames, maps of {first['map']}²:\n\n"
            + "\n".join(lines) + "\n")


def variants(sweep):
    """What is varied one by one, against the same method without."""
    scores = sweep["accuracy"]["variants"]
    lines = [row(["method", "with", "views", "wrong", "light error", "frame time", "bytes", "set-up"]),
             row(["---", "---"] + ["--:"] * 6)]
    for s in scores:
        lines.append(row([f"`{s['method']}`", s["variant"], str(s["views"]), times(s["wrong"]),
                          "" if s["light_error"] is None else times(s["light_error"]),
                          *(times(s[k]) for k in ("frame_time", "bytes", "cpu_setup"))]))
    return "\n".join(lines) + "\n"


def main():
    arguments = sys.argv[1:]
    if arguments[:1] == ["--gather"] and len(arguments) == 2:
        gather(arguments[1])
    elif arguments not in ([], ["--check"]):
        sys.exit(__doc__)
    check = arguments == ["--check"]
    sweep = json.loads((FOLDER / "sweep.json").read_text())
    script = "docs/accuracy/write_page.py"
    fill(PAGE, {"answer": answer(sweep), "doubling": doubling(sweep), "scores": scores(sweep), "exact": exact(sweep),
                "equal": equal_quality(sweep),
                "equal-time": equal_time(sweep), "temporal": temporal(sweep),
                "variants": variants(sweep)}, script, check)
    fill(README, {"accuracy": answer(sweep, {"all"})}, script, check)


main()
