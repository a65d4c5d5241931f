"""The tables of Milet 2015 and Rosen 2012 beside what the lab measures, as ratios to the plain map.

papers.json has the papers' figures, lab.json what is needed of the lab's reports.
"""

import statistics
import sys

from page_blocks import table

# Scene of the paper and the one of the lab that stands beside it: a room, a colonnade, open ground.
MILET_SCENES = (("Conf. room", "interior"), ("Sponza", "colonnade"), ("Observatory", "outdoor"))
LAB_SCENES = ("outdoor", "interior", "colonnade")

# What the passes of the lab are of the papers' steps.
IMPORTANCE = ("light image", "splat", "splat rows", "splat columns")
FUNCTIONS = ("collapse and build", "build rows", "build columns", "weaken")
DRAWING = ("unwarp centres", "set up triangles", "cut triangles", "shadow map")
MILET_STEPS = {"desired view": ("desired view",), "importance map": IMPORTANCE + FUNCTIONS,
               "desired view and importance map": ("desired view",) + IMPORTANCE + FUNCTIONS,
               "shadow map": DRAWING, "final pass": ("shadow test",)}
ROSEN_METHODS = ("sm", "rtw-forward", "rtw-backward", "rtw-hybrid")
NAMES = {"rtw": "rtw-backward"}


def rosen_steps(method):
    """Backward and hybrid analysis begin with the picture, which the others draw at the end."""
    first = method in ("rtw-backward", "rtw-hybrid")
    return {"importance map": IMPORTANCE + (("g-buffer", "desired view") if first else ()),
            "warping maps": FUNCTIONS, "shadow map": DRAWING,
            "output": ("shadow test",) if first else ("g-buffer", "shadow test")}


def gather(read):
    """What is needed of the reports: of each pass the median of all rounds, and the whole of each round.

    read: reads the results.json of a report by the name of its folder, or returns None.
    """
    def standing(*names):
        count = 0
        while read(f"{names[0]}-{count + 1}") is not None:
            count += 1
        reports = [read(f"{name}-{i + 1}") for name in names for i in range(count)]
        rounds = {}
        for run in (run for report in reports for run in report["runs"]):
            key = (run["scene"], run["method"], run.get("raster"))
            rounds.setdefault(key, []).append(run["pass_ms"])
        first = reports[0]["runs"][0]
        return {"view": first["view"], "map": first["map"], "rounds": count,
                "runs": [{"scene": scene, "method": method, **({"raster": raster} if raster else {}),
                          "round_ms": [round(sum_of(passes), 1) for passes in each],
                          "pass_ms": {name: round(statistics.median(passes[name] for passes in each), 2)
                                      for name in each[0]}}
                         for (scene, method, raster), each in rounds.items()]}

    def path(raster):
        return [{"scene": path["scene"], "method": path["method"],
                 "frame_ms": [round(frame["frame_ms"], 1) for frame in path["frames"]]}
                for path in read(f"rosen-path-{raster}")["paths"]]

    return {"renderer": read("milet-1")["device"]["renderer"], "milet": standing("milet"),
            "rosen": standing("rosen-cutting", "rosen-analyses"),
            "rosen paths": {raster: path(raster) for raster in ("none", "rule:2.5")}}


def run_of(measured, scene, method, raster=None):
    """A run; those of methods without tables do not depend on how edges are drawn."""
    (found,) = (run for run in measured["runs"] if run["scene"] == scene and
                run["method"] == method and run.get("raster") in (None, raster))
    return found


def times_of(measured, scene, method, raster=None):
    return run_of(measured, scene, method, raster)["pass_ms"]


def sum_of(passes, names=None):
    return sum(ms for name, ms in passes.items() if names is None or name in names)


def steps_of(passes, steps):
    """Time of each step; every pass must be of one."""
    found = {step: sum_of(passes, names) for step, names in steps.items()}
    if abs(sum(found.values()) - sum_of(passes)) > 1e-6 * sum_of(passes):
        sys.exit(f"passes {', '.join(passes)}: not each of one step")
    return found


def times(ratio):
    return f"{ratio:.2f}" if ratio < 10 else f"{ratio:.1f}"


def size(measured):
    width, height = measured["view"]
    return f"{width} × {height} pixels, maps of {measured['map']}²"


def here(scenes):
    return [f"{scene}, here" for scene in scenes]


def frames(papers, lab):
    """Table 1 of Milet 2015: whole frames."""
    paper, measured = papers["milet"]["table 1"], lab["milet"]
    order = sorted((name for name in paper if name not in ("about", "sm")), key=paper.get)

    def ratio(scene, method, raster):
        return (sum_of(times_of(measured, scene, method, raster)) /
                sum_of(times_of(measured, scene, "sm")))

    rows = []
    for name in order:
        label = f"`{NAMES.get(name, name)}`"
        theirs = times(paper[name] / paper["sm"])
        ways = ([(f"{label}, edges cut", theirs, "rule:2.5"), (f"{label}, `exact`", "", "exact")]
                if name in NAMES or name == "notw" else [(label, theirs, None)])
        rows += [[text, cell] + [times(ratio(scene, NAMES.get(name, name), raster)) for scene in LAB_SCENES]
                 for text, cell, raster in ways]

    found = [{name: ratio(scene, NAMES.get(name, name), "rule:2.5") for name in order}
             for scene in LAB_SCENES]
    ordered = ("sm", "dv", "rtw-backward", "notw")
    kept = [list(together) == sorted(together) for scene in LAB_SCENES
            for together in zip(*(run_of(measured, scene, method, "rule:2.5")["round_ms"]
                                  for method in ordered))]
    slowest = sum(each["sv"] == max(each.values()) for each in found)
    smallest = [each["min-sm"] for each in found]
    listed = ", ".join(f"`{NAMES.get(name, name)}`" for name in ["sm"] + order)
    return (f"In the paper the methods take longer in the order {listed}. Here, with edges cut, `sm`, `dv`, "
            f"`rtw-backward` and `notw` are in that order in {sum(kept)} of {len(kept)} rounds over all scenes; "
            f"`min-sm` takes {times(min(smallest))} to {times(max(smallest))} of `sm`, and `sv` is the slowest in "
            f"{slowest} of {len(LAB_SCENES)} scenes.\n\n" +
            table(["frame, over that of `sm`", "Observatory, paper"] + here(LAB_SCENES), rows) +
            f"\n{size(measured)} and tables of 512², as in the paper. Median of each pass in "
            f"{measured['rounds']} rounds, on {lab['renderer']}.\n")


def steps(papers, lab):
    """Tables 2 and 3 of Milet 2015: methods without the G-buffer, and their steps."""
    shares, whole = papers["milet"]["table 2"], papers["milet"]["table 3"]
    scenes = [scene for _, scene in MILET_SCENES]
    plain = [times_of(lab["milet"], scene, "sm") for scene in scenes]

    def beside_g_buffer(method, raster=None):
        found = [dict(times_of(lab["milet"], scene, method, raster)) for scene in scenes]
        for passes in found:
            del passes["g-buffer"]
        return found

    rows = []

    def add(label, theirs, ours):
        cells = []
        for i, passes in enumerate(plain):
            cells += [times(theirs[i] / whole["sm"][i]) if theirs else "",
                      times(ours[i] / (sum_of(passes) - passes["g-buffer"]))]
        rows.append([label] + cells)

    add("G-buffer", whole["g-buffer"], [passes["g-buffer"] for passes in plain])
    add("`sv`", whole["sv"], [sum_of(passes) for passes in beside_g_buffer("sv")])
    making = []
    for name in ("rtw", "notw"):
        method = NAMES.get(name, name)
        found = beside_g_buffer(method, "rule:2.5")
        add(f"**`{method}`**, edges cut", whole[name], [sum_of(passes) for passes in found])
        wanted = {step: MILET_STEPS[step] for step in shares[name]}
        of_lab = [steps_of(passes, wanted) for passes in found]
        for step, per_cent in shares[name].items():
            add(f"– {step}", [share / 100 * ms for share, ms in zip(per_cent, whole[name])],
                [each[step] for each in of_lab])
        add(f"`{method}`, `exact`", None, [sum_of(p) for p in beside_g_buffer(method, "exact")])
        of_warp = [step for step in wanted if step not in ("shadow map", "final pass")]
        paper = [sum(shares[name][step][i] for step in of_warp) for i in range(len(scenes))]
        ours = [100 * sum(each[step] for step in of_warp) / sum(each.values()) for each in of_lab]
        making.append(f"{min(paper):.0f} to {max(paper):.0f} % of `{method}` in the paper and "
                      f"{min(ours):.0f} to {max(ours):.0f} % here")
    head = ["over `sm`, both without G-buffer"]
    for theirs, scene in MILET_SCENES:
        head += [f"{theirs}, paper", f"{scene}, here"]
    return (f"Without the G-buffer and with edges cut, making the warp is {'; '.join(making)}.\n\n" +
            table(head, rows) + "\nThe same run as above.\n")


def middle_ratio(ranges, base):
    """Middle of a range of times over the middle of another."""
    return sum(ranges) / sum(base)


def paths(papers, lab):
    """Table 1 of Rosen 2012: frames along a path."""
    paper, walks = papers["rosen"]["table 1"], lab["rosen paths"]

    def of_lab(raster, scene, method):
        found = {path["method"]: path["frame_ms"] for path in walks[raster] if path["scene"] == scene}
        return statistics.median(mine / plain for mine, plain in zip(found[method], found["sm"]))

    rows = []
    for method in ROSEN_METHODS[1:]:
        for raster, label in (("none", ""), ("rule:2.5", ", cut")):
            rows.append([f"`{method}`{label}"] +
                        [times(middle_ratio(mine, plain))
                         for mine, plain in zip(paper[method + label], paper["sm"])] +
                        [times(of_lab(raster, scene, method)) for scene in LAB_SCENES])

    def dearer(method, other):
        of_paper = [sum(mine) > sum(others) for cut in ("", ", cut")
                    for mine, others in zip(paper[method + cut], paper[other + cut])]
        ours = [of_lab(raster, scene, method) > of_lab(raster, scene, other)
                for raster in walks for scene in LAB_SCENES]
        return f"in {sum(of_paper)} of {len(of_paper)} cases of the paper and in {sum(ours)} of {len(ours)} here"

    count = len(walks["none"][0]["frame_ms"])
    return (f"Hybrid analysis takes longer than backward analysis {dearer('rtw-hybrid', 'rtw-backward')}; forward "
            f"analysis takes longer than backward analysis {dearer('rtw-forward', 'rtw-backward')}.\n\n" +
            table(["frame, over that of `sm`"] + [f"{scene}, paper" for scene in paper["scenes"]] +
                  here(LAB_SCENES), rows) +
            f"\n{size(lab['rosen'])}, which is half the paper's in both directions, and tables of 512². Of the paper "
            f"the middle between the least and the most of a path. Ours: median of {count} frames of `--path walk`, "
            "each over the frame of `sm` at the same place.\n")


def analysis(papers, lab):
    """Table 2 of Rosen 2012: the steps of the four methods, over the whole of the plain one."""
    paper, measured = papers["rosen"]["table 2"], lab["rosen"]
    scene = LAB_SCENES[0]
    plain_here = sum_of(times_of(measured, scene, "sm"))

    def of_lab(method):
        def found(raster):
            passes = times_of(measured, scene, method, raster)
            return {step: ms / plain_here for step, ms in steps_of(passes, rosen_steps(method)).items()}

        flat, cut = found("none"), found("rule:2.5")
        return {**flat, "shadow map, cut": cut["shadow map"], "total": sum(flat.values()),
                "total, cut": sum(cut.values())}

    ours = {method: of_lab(method) for method in ROSEN_METHODS}
    plain = paper["sm"][paper["steps"].index("total")]
    rows = []
    for i, step in enumerate(paper["steps"]):
        row = [step]
        for method in ROSEN_METHODS:
            theirs = paper[method][i]
            row += ["", ""] if theirs is None else [times(theirs / plain), times(ours[method][step])]
        rows.append(row)
    head = ["over the frame of `sm`"]
    for method in ROSEN_METHODS:
        head += [f"`{method}`, paper", "here"]
    backward = times_of(measured, scene, "rtw-backward", "none")
    set_up = 100 * backward["set up triangles"] / sum_of(backward, DRAWING)
    return (f"Playground in the paper, `{scene}` here, sizes as above. Of our uncut shadow map of `rtw-backward` "
            f"{set_up:.0f} % is setting up triangles in a compute pass, which the paper leaves to vertex stage and "
            "rasteriser.\n\n" + table(head, rows))


def cutting(papers, lab):
    """Table 3 of Rosen 2012: what cutting edges costs."""
    paper, measured = papers["rosen"]["table 3"], lab["rosen"]
    plain = papers["rosen"]["table 1"]["sm"]
    labels = {"none": "not cut", "rule:5": "5 %", "rule:2.5": "2.5 %", "rule:1": "1 %"}

    def of_lab(scene, raster):
        return (sum_of(times_of(measured, scene, "rtw-backward", raster)) /
                sum_of(times_of(measured, scene, "sm")))

    rows = [[label] + [times(middle_ratio(mine, base)) for mine, base in zip(paper[raster], plain)] +
            [times(of_lab(scene, raster)) for scene in LAB_SCENES] for raster, label in labels.items()]
    theirs = [sum(finest) / sum(flat) for finest, flat in zip(paper["rule:1"], paper["none"])]
    ours = [of_lab(scene, "rule:1") / of_lab(scene, "none") for scene in LAB_SCENES]
    return (f"Edges of at most 1 % of the map make the frame {times(min(theirs))} to {times(max(theirs))} times as "
            f"long as uncut ones in the paper, and {times(min(ours))} to {times(max(ours))} times here.\n\n" +
            table(["`rtw-backward`, longest edge"] + [f"{scene}, paper" for scene in paper["scenes"]] +
                  here(LAB_SCENES), rows) +
            f"\nFrames over those of `sm`, sizes as above, one view. Median of each pass in {measured['rounds']} "
            "rounds.\n")


def noise(lab):
    """How much the rounds of one run differ."""
    apart = [max(run["round_ms"]) / min(run["round_ms"]) for part in ("milet", "rosen")
             for run in lab[part]["runs"]]
    return (f"Ours are of one run on a machine that did other work as well: the slowest of "
            f"{lab['milet']['rounds']} rounds of one and the same frame took {times(statistics.median(apart))} times "
            f"as long as the fastest (median), at most {times(max(apart))} times. Look for what is several times as "
            "dear, not for tenths.\n")


def blocks(papers, lab):
    return {"papers-noise": noise(lab), "milet-frames": frames(papers, lab), "milet-steps": steps(papers, lab),
            "rosen-paths": paths(papers, lab), "rosen-steps": analysis(papers, lab),
            "rosen-cutting": cutting(papers, lab)}
