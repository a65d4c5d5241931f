"""Runs warpshadow-lab on small views and checks what it writes.

usage: check_reports.py LAB DATA SCRATCH PART

PART is one of the names in PARTS, at the end. What a run writes is compared with what a second one
writes only where the environment variable WARPSHADOW_TWICE is 1. SCRATCH keeps the reports that are
looked at in a browser.
"""

import base64
import json
import os
import re
import shutil
import signal
import struct
import subprocess
import sys
import time
from pathlib import Path

lab, data, scratch, part = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3]), sys.argv[4]
TWICE = os.environ.get("WARPSHADOW_TWICE") == "1"
METHODS = ["sm", "stable", "min-sm", "dv", "pssm", "sdsm", "lispsm", "fitted", "fitted-2", "min-sm-notw",
           "lispsm-notw", "fitted-notw", "notw", "notw-fine", "notw-nodv", "notw-edges",
           "notw-oracle", "notw-hybrid", "rtw-forward", "rtw-backward", "rtw-hybrid"]
FOR_POINTS_ALONE = ["cube6", "cube6-cull", "cube6-efc", "cube6-gs", "cube6-cull-gs", "cube6-efc-gs",
                    "dpsm", "dpsm-cull", "dpsm-pc", "dpsm-gs", "dpsm-cull-gs", "dpsm-pc-gs",
                    "cube-notw", "dpsm-notw"]
NOT_FOR_POINTS = ["sm", "stable", "pssm", "sdsm", "fitted-2", "notw", "notw-fine", "notw-nodv",
                  "notw-edges", "notw-oracle", "notw-hybrid", "rtw-forward", "rtw-backward",
                  "rtw-hybrid"]
PARTITIONED = ("pssm", "sdsm", "fitted-2")
REPEAT = 2
SMALL = ["--view", "96x64", "--repeat", str(REPEAT)]
RUN_KEYS = {
    "scene", "camera", "light", "light_kind", "method", "map", "view", "samples", "wrong_pixel_ratio",
    "false_shadow_ratio", "false_light_ratio", "grazing", "frame_ms", "pass_ms", "cpu_setup_us",
    "bytes", "triangles", "maps", "angle_degrees", "status",
}
OPTIONAL_KEYS = {"bias", "filter", "filtered", "raster", "tables_format", "setup"}
METRIC_KEYS = {"m", "m_facing", "mer", "storage_factor"}
PATH_KEYS = ["scene", "camera", "light", "path", "method", "map", "view", "mean", "frames"]


def run(*arguments):
    return subprocess.run([lab, *arguments], cwd=scratch, capture_output=True, text=True)


def report(folder, *arguments):
    """Runs the lab, which must succeed; returns results.json after the checks that always hold."""
    done = run(*SMALL, "--out", folder, *arguments)
    assert done.returncode == 0, done.stderr
    assert done.stderr == "", f"no terminal, no progress bar: {done.stderr!r}"
    last_line = done.stdout.splitlines()[-1]
    assert last_line == str(scratch / folder / "report.html"), last_line
    check_files(scratch / folder)
    results = json.loads((scratch / folder / "results.json").read_text())
    check_results(results)
    command = " ".join(["warpshadow-lab", *SMALL, *arguments])
    assert results["command"].replace("'", "") == command, results["command"]
    assert f"<code class=\"command\">{results['command']}</code>" in (
        scratch / folder / "report.html").read_text().replace("&#39;", "'")
    for entry in results["runs"]:
        assert re.search(rf"^{entry['scene']} .* {entry['method']} ", done.stdout, re.M), done.stdout
    assert not list(scratch.glob(".*")), "a temporary folder is left"
    return results


def check_files(folder):
    pictures = sorted(folder.glob("*.png"))
    assert pictures
    assert {p.name for p in folder.iterdir()} == (
        {p.name for p in pictures} | {"results.json", "report.html"})
    for picture in pictures:
        width, height = png_size(picture.read_bytes())
        assert width > 0 and height > 0
        if picture.name.endswith("-wrong.png") and "-detail" not in picture.name:
            assert (width, height) == (96, 64), picture
    html = (folder / "report.html").read_text()
    sources = re.findall(r'(?:src|href)="([^"]*)"', html)
    inside = [s for s in sources if not s.startswith("#")]  # the others are links within the page
    assert inside and all(s.startswith("data:image/png;base64,") for s in inside)
    for source in inside:
        png_size(base64.b64decode(source.split(",", 1)[1], validate=True))
    assert "http:" not in html and "https:" not in html, "the page must need nothing but itself"
    results = json.loads((folder / "results.json").read_text())
    if "figures" in results:
        assert html.count('<section class="figure"') == html.count("</section>") > 0
        assert html.count("<svg") == 0
        return
    plots_of_a_section = 1 if results["runs"] else 6
    assert html.count("<section>") == html.count("</section>") > 0
    assert html.count("<svg") == plots_of_a_section * html.count("<section>")
    assert 'name="viewport"' in html and "prefers-color-scheme: dark" in html


def png_size(content):
    assert content[:8] == b"\x89PNG\r\n\x1a\n" and content[12:16] == b"IHDR"
    assert content[-8:-4] == b"IEND"
    return struct.unpack(">II", content[16:24])


def check_results(results):
    assert [key for key in results if key != "figures"] == [
        "schema", "command", "device", "timing", "runs", "paths", "not_applicable"]
    assert results["schema"] == 1
    assert results["device"]["renderer"] and results["device"]["version"]
    assert results["timing"] in ("timer_query", "glfinish")
    software = any(s in results["device"]["renderer"].lower() for s in ("llvmpipe", "softpipe"))
    assert results["timing"] == ("glfinish" if software else "timer_query")
    assert bool(results["runs"]) != bool(results["paths"]), "one or the other"
    for entry in results["runs"]:
        # a paraboloid has no matrix, and what has no map no texels
        measured = not entry["method"].startswith(("dpsm", "sv", "raytraced"))
        keys = RUN_KEYS | (METRIC_KEYS if measured else set())
        if measured and ("notw" in entry["method"] or entry["method"].startswith("rtw")):
            keys |= {"weakened", "predicted_texel_side"}
        assert set(entry) - OPTIONAL_KEYS == keys, set(entry) ^ keys
        for m in (entry["m"], entry["m_facing"]) if measured else ():
            assert 0 <= m["p50"] <= m["p99"] <= m["max"] and 0 <= m["share_above_1"] <= 1
            assert (m["max"] > 0) == (entry["samples"] > 0)
        if "weakened" in entry:
            # a table that is weakened to the identity is off by its rounding
            assert all(side >= 0.999 * entry["map"] for side in entry["mer"]), entry["mer"]
        elif measured and entry["method"] not in PARTITIONED:
            assert entry["mer"] == [entry["map"]] * 2
        assert entry["view"] == [96, 64]
        assert 0 <= entry["samples"] <= 96 * 64
        wrong, shadow, light = (
            entry[k] for k in ("wrong_pixel_ratio", "false_shadow_ratio", "false_light_ratio"))
        if entry["samples"] == 0:
            assert wrong is None and shadow is None and light is None
        else:
            counts = [r * entry["samples"] for r in (wrong, shadow, light)]
            assert all(abs(c - round(c)) < 1e-6 for c in counts), "ratios are of whole samples"
            assert round(counts[0]) == round(counts[1]) + round(counts[2])
        grazing = entry["grazing"]
        assert (grazing["wrong_pixel_ratio"] is None) == (grazing["samples"] == 0)
        times = entry["frame_ms"]
        assert 0 < times["min"] <= times["median"] <= times["max"] and times["n"] == REPEAT
        assert entry["pass_ms"] and all(t >= 0 for t in entry["pass_ms"].values())
        assert entry["bytes"] > 0
        assert (entry["triangles"] > 0) == (entry.get("raster") != "ideal")
        if entry["method"] == "raytraced":
            assert entry["map"] == 0 and not wrong and not entry["grazing"]["wrong_pixel_ratio"]
        elif entry["method"] == "sv":
            assert entry["map"] == 0 and entry["maps"] == 0 and wrong < 0.005
            assert list(entry["pass_ms"]) == ["g-buffer", "silhouettes", "shadow volumes",
                                              "shadow test"]
        else:
            # partitions share the texels of one map, but for the rounding of their sides
            assert entry["bytes"] >= 3.9 * entry["map"] ** 2, "at least the depth of the map"


def methods_of(results):
    return [(r["method"], r["map"]) for r in results["runs"]]


def facts(results):
    """What must not change from run to run: everything but times."""
    return [{k: v for k, v in r.items() if k not in ("frame_ms", "pass_ms", "cpu_setup_us")}
            for r in results["runs"]]


def check_every_method():
    first = report("every", "--scene", "leaves", "--methods", "all", "--map", "64,128")
    assert methods_of(first) == (
        [(m, 64) for m in METHODS] + [("sv", 0), ("raytraced", 0)] +
        [(m, 128) for m in METHODS])
    assert [e["method"] for e in first["not_applicable"]] == FOR_POINTS_ALONE
    by_name = {(r["method"], r["map"]): r["wrong_pixel_ratio"] for r in first["runs"]}
    assert by_name["sm", 128] < by_name["sm", 64], "a larger map is wrong less often"
    assert by_name["pssm", 128] < by_name["pssm", 64]
    assert by_name["dv", 64] < 0.5, "better than a coin"
    memory = {r["method"]: r["bytes"] for r in first["runs"] if r["map"] == 128}
    assert memory["pssm"] == memory["sdsm"] == memory["sm"], "partitions share the texels of one map"
    check_metric(first)
    if not TWICE:
        return
    kept = {p.name: p.read_bytes() for p in (scratch / "every").glob("*.png")}
    again = report("every", "--scene=leaves", "--methods=all", "--map=64,128")
    assert facts(first) == facts(again)
    assert kept == {p.name: p.read_bytes() for p in (scratch / "every").glob("*.png")}


def check_metric(results):
    """A texel of a map of twice the size covers half as many pixels, where the map is uniform."""
    of = {(r["method"], r["map"]): r for r in results["runs"]}
    for method in ("sm", "min-sm", "lispsm"):
        small, large = (of[method, size] for size in (64, 128))
        for m in ("m", "m_facing"):
            for share in ("max", "p99", "p50"):
                # min-sm leaves half a texel free at each border: its texels shrink a little less
                assert abs(small[m][share] / large[m][share] - 2) < 0.05, (method, m, share)


def check_spot_and_point():
    camera = "-1,1.5,1,0.5,0.6,-0.5,60"
    spot = report("spot", "--scene", "interior", "--camera", camera, "--light",
                  "spot:0.2,1.97,-0.1,0.2,0,-0.1,120", "--map", "64", "--methods",
                  "sm,min-sm,dv,lispsm,fitted,fitted-2,notw,sv")
    assert all(r["camera"] == camera for r in spot["runs"])
    assert {r["samples"] for r in spot["runs"]} == {spot["runs"][0]["samples"]}
    assert spot["runs"][0]["samples"] > 0

    # the tables of six faces take long: one method of them stands for all
    seen = ["min-sm", "dv", "lispsm", "fitted"] + FOR_POINTS_ALONE
    point = report("point", "--scene", "interior", "--camera", camera, "--light",
                   "point:0.2,1.97,-0.1", "--map", "64", "--methods",
                   ",".join(NOT_FOR_POINTS + seen + ["sv", "raytraced"]))
    assert methods_of(point) == [(m, 64) for m in seen] + [("sv", 0), ("raytraced", 0)]
    assert [(e["method"], e["light"]) for e in point["not_applicable"]] == (
        [(m, "point:0.2,1.97,-0.1") for m in NOT_FOR_POINTS])
    assert all(e["reason"] and e["scene"] == "interior" for e in point["not_applicable"])
    by_name = {r["method"]: r for r in point["runs"]}
    # culling leaves out what no pixel asks for
    for plain, culled in (("cube6", "cube6-cull"), ("cube6", "cube6-efc"), ("dpsm", "dpsm-cull"),
                          ("cube6", "cube6-gs"), ("cube6", "cube6-cull-gs"),
                          ("cube6", "cube6-efc-gs"), ("dpsm", "dpsm-pc"), ("dpsm", "dpsm-gs"),
                          ("dpsm", "dpsm-cull-gs"), ("dpsm", "dpsm-pc-gs")):
        assert (by_name[plain]["wrong_pixel_ratio"] == by_name[culled]["wrong_pixel_ratio"]), culled
    # the lamp hangs in front of the camera: all six faces may be needed
    assert by_name["dv"]["maps"] == 6 and by_name["dv"]["bytes"] >= 6 * 4 * 64 * 64
    for m in seen:
        assert by_name[m]["wrong_pixel_ratio"] < 0.2, (m, by_name[m]["wrong_pixel_ratio"])

    # a lamp behind the camera's back: the face away from the view is not drawn
    behind = report("behind", "--scene", "interior", "--camera", camera, "--light",
                    "point:-1.6,1.5,1.5", "--map", "64", "--methods", "min-sm,dv")
    by_name = {r["method"]: r for r in behind["runs"]}
    assert 0 < by_name["min-sm"]["maps"] < 6 and by_name["dv"]["maps"] == 6


def check_virtual_lights():
    """Virtual lights: every way to draw their maps, and no map that culling could leave out."""
    done = run("--preset", "vpl:3000", "--map", "32", "--repeat", "1", "--out", "vpl")
    assert done.returncode == 0 and done.stderr == "", done.stderr
    (record,) = json.loads((scratch / "vpl" / "results.json").read_text())["vpl"]
    assert (record["scene"], record["points"], record["map"]) == ("interior", 3000, 32)
    maps = {way["way"]: way["maps"] for way in record["ways"]}
    assert list(maps) == ["cube6", "cube6-efc", "dpsm", "dpsm-pc"]
    assert all(m == 6 for m in maps["cube6"]) and all(m == 2 for m in maps["dpsm"])
    assert all(m <= 5 for m in maps["cube6-efc"]) and all(m == 1 for m in maps["dpsm-pc"])
    assert all(t > 0 for way in record["ways"] for t in way["ms"])
    assert {len(way["ms"]) for way in record["ways"]} == {len(maps["cube6"])}
    assert (scratch / "vpl" / "report.html").read_text().count("<svg") == 1


def check_finer_scene():
    """Triangles are cut into k² equal ones: the surfaces, and hence the shadows, stay."""
    fine = report("fine", "--scene", "leaves:660000", "--methods", "sm", "--map", "64")
    plain = report("plain", "--scene", "leaves", "--methods", "sm", "--map", "64")
    (one,), (other,) = fine["runs"], plain["runs"]
    assert one["triangles"] == 4 * other["triangles"]
    assert one["scene"] == f"leaves:{3 * one['triangles']}"
    assert abs(one["wrong_pixel_ratio"] - other["wrong_pixel_ratio"]) < 0.01


def check_tables():
    """Options of the warp tables: what they change, and what they leave alone."""
    arguments = ["--scene", "leaves", "--map", "64"]
    methods = "notw,notw-edges,notw-hybrid,rtw-forward,rtw-backward,rtw-hybrid"
    usual = report("tables", *arguments, "--methods", methods)
    wrong = {r["method"]: r["wrong_pixel_ratio"] for r in usual["runs"]}
    options = ["--importance", "desired-view,distance,normal", "--tables", "32", "--window", "0.4",
               "--floor", "0.2", "--order", "v", "--power", "0.7", "--subset", "2", "--cells",
               "max", "--collapse", "max", "--sigma", "0.05", "--edge-share", "0.3"]
    other = report("others", *arguments, "--methods", methods, *options)
    assert all(r["wrong_pixel_ratio"] != wrong[r["method"]] for r in other["runs"])
    # a wide window and one table node: nothing is warped, whoever analyses
    level = report("level", *arguments, "--methods", "dv,notw,rtw-backward", "--floor", "1")
    level = {r["method"]: r["wrong_pixel_ratio"] for r in level["runs"]}
    assert abs(level["notw"] - level["dv"]) < 0.01 and abs(level["rtw-backward"] - level["dv"]) < 0.01
    turned = report("turned", *arguments, "--methods", "dv,fitted-notw," + methods, "--align")
    for entry in turned["runs"]:
        assert entry["pass_ms"].get("align", -1) >= 0 or entry["method"] in ("dv", "fitted-notw")
        assert (entry["angle_degrees"] == 0) == (entry["method"] in ("dv", "fitted-notw")), entry
    # what an edge is to hybrid analysis: each has its own by default
    hybrid = report("ends", *arguments, "--methods", "notw-hybrid,rtw-hybrid", "--importance", "ends")
    for entry in hybrid["runs"]:
        same = entry["wrong_pixel_ratio"] == wrong[entry["method"]]
        assert same == (entry["method"] == "notw-hybrid"), entry
    # triangles whole: the number of their pieces would follow the tables
    sizes = [report("coarse", *arguments, "--methods", "notw", "--raster", "none", *tables)
             for tables in ([], ["--tables", "8"])]
    assert sizes[0]["runs"][0]["bytes"] > sizes[1]["runs"][0]["bytes"]
    for option, value in (("--smooth", "tent"), ("--smooth", "gaussian"), ("--shear", "0.5")):
        other = report("rows", *arguments, "--methods", "notw,rtw-backward", option, value)
        other = {r["method"]: r["wrong_pixel_ratio"] for r in other["runs"]}
        assert other["notw"] != wrong["notw"]
        assert other["rtw-backward"] == wrong["rtw-backward"], "one function has no neighbours"
    path = report("edges", *arguments, "--methods", "notw-edges", "--path", "yaw", "--frames", "3")
    assert [p["method"] for p in path["paths"]] == ["notw-edges"]


def check_table_formats():
    """Tables in 16 bits: half the memory of their nodes, and few pixels that see it."""
    # triangles whole: the number of their pieces would follow the tables
    arguments = ["--scene", "leaves", "--map", "64", "--methods", "dv,notw,rtw-backward",
                 "--raster", "none"]
    floats = report("floats", *arguments, "--shear", "0.5", "--tables-format", "r32f")
    halves = report("halves", *arguments, "--shear", "0.5", "--tables-format", "unorm16")
    for of_float, of_half in zip(floats["runs"], halves["runs"]):
        assert "tables_format" not in of_float
        if of_float["method"] == "dv":
            assert "tables_format" not in of_half
            continue
        assert of_half["tables_format"] == "unorm16"
        # rows and columns of 65 nodes, and the function that they share under a shear limit
        nodes = 65 * (2 if of_float["method"] == "rtw-backward" else 2 * 64 + 1)
        assert of_float["bytes"] - of_half["bytes"] == 2 * nodes, of_float["method"]
        # half a step is 1/2048 of a texel of this map, and more where functions differ: few samples
        # lie so near the border of a texel, and most of those see the same from the next one
        off = abs(of_float["wrong_pixel_ratio"] - of_half["wrong_pixel_ratio"])
        assert off < 0.003, (of_float["method"], off)
        assert of_float["m"] != of_half["m"], "it must show"


def check_bytes():
    """What a run needs of memory does not depend on the runs before it."""
    arguments = ["--scene", "leaves", "--map", "128", "--methods", "notw", "--raster"]
    _, after = report("after", *arguments, "bound:0.2,exact")["runs"]
    (alone,) = report("alone", *arguments, "exact")["runs"]
    assert after["bytes"] == alone["bytes"]


def check_set_up():
    """Matrices at float are those at double but for rounding, which few pixels see."""
    differ = 0
    for scene, methods in (("leaves", "sm,stable,min-sm,lispsm,fitted"),
                           ("interior", "min-sm,fitted")):
        arguments = ["--scene", scene, "--map", "128", "--methods", methods]
        doubles = report("doubles", *arguments)
        floats = report("floats", *arguments, "--setup", "float")
        for at_double, at_float in zip(doubles["runs"], floats["runs"]):
            assert at_float["setup"] == "float" and "setup" not in at_double
            off = abs(at_double["wrong_pixel_ratio"] - at_float["wrong_pixel_ratio"])
            assert off * at_double["samples"] < 6, (scene, at_double["method"], off)
            differ += at_double["m"] != at_float["m"]
    assert differ > 0, "it must show"
    none = report("point-floats", "--scene", "interior", "--light", "point:0.2,1.97,-0.1", "--map",
                  "64", "--methods", "dv,cube6,dpsm", "--setup", "float")
    assert methods_of(none) == [("dv", 64)]
    assert [e["method"] for e in none["not_applicable"]] == ["cube6", "dpsm"]


def check_paths():
    """A camera that moves: frame by frame, and against what must hold for any camera."""
    arguments = ["--scene", "leaves", "--methods", "sm,stable,min-sm,dv,pssm,sv,raytraced", "--map",
                 "64"]
    yaw = report("yaw", *arguments, "--path", "yaw", "--frames", "4")
    maps = {"sm": 1, "stable": 1, "min-sm": 1, "dv": 1, "pssm": 4, "sv": 0}
    assert [p["method"] for p in yaw["paths"]] == list(maps)
    for path in yaw["paths"]:
        assert list(path) == PATH_KEYS and path["path"] == "yaw" and len(path["frames"]) == 4
        frames = path["frames"]
        assert frames[0]["flip_ratio"] is None, "nothing goes before the first"
        assert all(0 <= f["flip_ratio"] <= 1 for f in frames[1:])
        assert all(f["frame_ms"] > 0 and f["maps"] == maps[path["method"]] for f in frames)
        flips = [f["flip_ratio"] for f in frames[1:]]
        assert abs(path["mean"]["flip_ratio"] - sum(flips) / len(flips)) < 1e-12
    flips = {p["method"]: p["mean"]["flip_ratio"] for p in yaw["paths"]}
    assert flips["sm"] == 0, "the map of the whole scene does not know the camera"
    assert flips["sv"] == 0, "volumes do not know it either"
    assert max(flips["stable"], flips["pssm"]) < 0.01 < flips["dv"], flips
    # what does not move does not flip, and the first frame is the view that stands still
    still = report("still", *arguments)
    first = {p["method"]: p["frames"][0] for p in yaw["paths"]}
    for entry in still["runs"]:
        if entry["method"] != "raytraced":
            assert first[entry["method"]]["wrong_pixel_ratio"] == entry["wrong_pixel_ratio"]
            assert first[entry["method"]]["angle_degrees"] == entry["angle_degrees"]

    keys = scratch / "keys.txt"
    keys.write_text("# two cameras of the scene\n0\n1\n")
    walk = report("walk", *arguments, "--path", str(keys), "--frames", "3")
    assert all(len(p["frames"]) == 3 for p in walk["paths"])
    assert walk["paths"][0]["frames"][0]["wrong_pixel_ratio"] == (
        yaw["paths"][0]["frames"][0]["wrong_pixel_ratio"]), "it begins at the first camera"
    keys.unlink()


def check_biases():
    arguments = ["--scene", "leaves", "--methods", "sm,lispsm,fitted,notw,raytraced", "--map", "64"]
    plain = report("plain", *arguments)
    assert not any("bias" in r or "filter" in r for r in plain["runs"]), "not asked for"
    kinds = ["plane", "none", "constant", "slope", "footprint", "linear", "back-face",
             "footprint+back-face"]
    compared = report("biases", *arguments, "--bias", ",".join(kinds))
    by_name = {(r["method"], r["bias"]["kind"]): r for r in compared["runs"] if r["map"] != 0}
    with_tables = [k for k in kinds if "linear" not in k and "back-face" not in k]
    assert list(by_name) == [
        (m, k) for m in ("sm", "lispsm", "fitted", "notw")
        for k in (with_tables if m == "notw" else kinds)]
    assert sorted(e["method"] for e in compared["not_applicable"]) == ["notw"] * 3
    for method in ("sm", "lispsm", "fitted", "notw"):
        of_bias = {k: by_name[method, k]["bias"] for k in kinds if (method, k) in by_name}
        for bias in of_bias.values():
            assert 0 <= bias["acne_ratio"] <= 1 and 0 <= bias["leak_ratio"] <= 1
            assert bias["displacement_texels"] >= 0
        # the exact test is the one that runs when nothing is said
        known = next(r for r in plain["runs"] if r["method"] == method)
        assert by_name[method, "plane"]["wrong_pixel_ratio"] == known["wrong_pixel_ratio"]
        assert of_bias["plane"]["acne_ratio"] == of_bias["plane"]["leak_ratio"] == 0
        assert of_bias["none"]["acne_ratio"] > 0.1 and of_bias["none"]["displacement_texels"] == 0
        assert of_bias["constant"]["acne_ratio"] == of_bias["footprint"]["acne_ratio"] == 0
        # the constant is what the worst pixel needs, the footprint what each does
        assert 0 < of_bias["footprint"]["displacement_texels"]
        assert of_bias["footprint"]["displacement_texels"] < of_bias["slope"]["displacement_texels"]
    # the constant is the smallest: a little less, and there is acne
    value = by_name["lispsm", "constant"]["bias"]["value"]
    less = report("less", "--scene", "leaves", "--methods", "lispsm", "--map", "64", "--bias",
                  f"constant:{0.999 * value:.9f},constant:{1.001 * value:.9f}")
    assert [r["bias"]["acne_ratio"] > 0 for r in less["runs"]] == [True, False]
    # a filter changes pictures and nothing that is counted
    for kind in ("pcf", "blur", "pcf-texels:2", "pcf-light:1", "pcf-footprint:1"):
        filtered = report(kind, *arguments, "--filter", kind)
        assert [r.get("filter") for r in filtered["runs"]] == [kind] * 4 + [None]
        for soft, hard in zip(facts(filtered), facts(plain)):
            soft.pop("filter", None)
            errors = soft.pop("filtered", None)
            assert soft == hard
            if errors:
                # light that is wrong by more than half, against all that is missing or too much
                assert 0 < errors["wrong_pixel_ratio"] < 2 * errors["mean_light_error"] < 1
        assert all(("filter" in r["pass_ms"]) == (r["map"] != 0) for r in filtered["runs"])
        name = "leaves-c0-l0-m64-sm.png"
        pictures = [(scratch / folder / name).read_bytes() for folder in (kind, "plain")]
        assert pictures[0] != pictures[1]
    # nor what a method remembers from one frame to the next
    edges = ["--scene", "leaves", "--methods", "notw-edges", "--map", "64"]
    (hard,) = facts(report("hard", *edges))
    (soft,) = facts(report("soft", *edges, "--filter", "pcf"))
    assert soft["wrong_pixel_ratio"] == hard["wrong_pixel_ratio"]


def check_figures():
    global REPEAT
    REPEAT = 1
    for figure, columns in (("figure6", ["none", "constant", "slope", "footprint"]),
                            ("figure8", ["0×", "1×", "2×", "4×", "8×", "16×"])):
        arguments = ["--preset", figure, "--scene", "leaves", "--map", "64", "--repeat", "1"]
        results = figure_report(figure, *arguments)
        (entry,) = results["figures"]
        assert [entry[k] for k in ("figure", "scene", "camera", "light")] == (
            [figure, "leaves", "0", "0"])
        cells = entry["cells"]
        assert [c["run"] for c in cells] == list(range(len(results["runs"])))
        rows = list(dict.fromkeys(c["row"] for c in cells))
        assert [(c["row"], c["column"]) for c in cells] == [(r, c) for r in rows for c in columns]
        html = (scratch / figure / "report.html").read_text()
        assert html.count("displacement&nbsp;") == len(cells) == html.count("acne&nbsp;") - (
            1 if "acne&nbsp;%</th>" in html else 0)
        if figure == "figure6":
            of_bias = {(c["row"], c["column"]): results["runs"][c["run"]]["bias"] for c in cells}
            for row in rows:
                assert of_bias[row, "none"]["acne_ratio"] > 0
                assert of_bias[row, "constant"]["acne_ratio"] == 0
                assert of_bias[row, "footprint"]["acne_ratio"] == 0
        else:
            by_place = {(c["row"], c["column"]): c for c in cells}
            for row in rows:
                assert by_place[row, "0×"]["mean_light_error"] < (
                    by_place[row, "16×"]["mean_light_error"]), "a blur costs detail"
            assert by_place["sm, blur less with depth", "16×"]["mean_light_error"] < (
                by_place["sm, blur everywhere", "16×"]["mean_light_error"])
        if not TWICE:
            continue
        kept = {p.name: p.read_bytes() for p in (scratch / figure).glob("*.png")}
        again = figure_report(figure, *arguments)
        assert facts(again) == facts(results) and again["figures"] == results["figures"]
        assert kept == {p.name: p.read_bytes() for p in (scratch / figure).glob("*.png")}
    REPEAT = 2


def check_raster_figure():
    """Rosen's figure 7: what is done about bent edges, from worst to best."""
    global REPEAT
    REPEAT = 1
    results = figure_report("figure7", "--preset", "figure7", "--scene", str(data / "two_quads.gltf"),
                            "--map", "64", "--repeat", "1")
    REPEAT = 2
    (entry,) = results["figures"]
    cells, runs = entry["cells"], results["runs"]
    ways = ["none", "fragment", "rule:5", "rule:2.5", "rule:1", "bound:0.5", "hull", "exact",
            "ideal"]
    methods = ["rtw-backward", "notw"]
    assert [(c["row"], c["column"]) for c in cells] == [(m, w) for m in methods for w in ways]
    assert [(runs[c["run"]]["method"], runs[c["run"]]["raster"]) for c in cells] == (
        [(m, w) for m in methods for w in ways])
    for method in methods:
        off = {c["column"]: c["wrong_texel_ratio"] for c in cells if c["row"] == method}
        assert off["ideal"] == 0 and max(off["hull"], off["exact"]) < 0.002, off
        assert off["exact"] < off["bound:0.5"] <= off["fragment"] < off["none"], off
        assert off["exact"] <= off["rule:1"] <= off["rule:2.5"] <= off["rule:5"] < off["fragment"], off
    folder = scratch / "figure7"
    for name in [f"figure7-{entry['scene']}-c0-l0-{m}-{w}" for m in methods for w in ways]:
        name = name.replace(":", "_")
        assert png_size((folder / f"{name}.png").read_bytes()) == (48, 32), name
        assert png_size((folder / f"{name}-map.png").read_bytes()) == (32, 32), name
    html = (folder / "report.html").read_text()
    assert html.count("<figure>") == len(cells) and html.count("a&nbsp;ray&nbsp;per&nbsp;texel") == 2


def figure_report(folder, *arguments):
    """As report, which gives --repeat and hence may not be given it twice."""
    global SMALL
    kept, SMALL = SMALL, SMALL[:2]
    results = report(folder, *arguments)
    SMALL = kept
    return results


def check_sweep():
    """A sweep that is stopped goes on where it was; errors fall as maps grow."""
    methods = "sm,pssm,sdsm,dv,fitted,notw,sv,raytraced"
    arguments = ["--sweep", "--scene", "leaves", "--view", "96x64", "--map", "32,64,256", "--out",
                 "sweep"]
    unfinished = scratch / ".sweep.unfinished"

    def stop_after_a_view(*more):
        """Stops a sweep when it has kept another view than stood there; returns what it kept."""
        before = [p.read_bytes() for p in unfinished.glob("*.cbor")]
        going = subprocess.Popen([lab, *arguments, "--methods", *more], cwd=scratch,
                                 stderr=subprocess.PIPE, text=True)
        while going.poll() is None and (
                [p.read_bytes() for p in unfinished.glob("*.cbor")] in (before, [])):
            time.sleep(0.01)
        going.send_signal(signal.SIGINT)
        assert "interrupted" in going.communicate()[1] and going.returncode == 1
        (kept,) = (p for p in unfinished.glob("*.cbor") if "-path-" not in p.name)
        return kept.read_bytes()

    # what stands there of other options is measured again, not taken
    other = stop_after_a_view("sm,dv,fitted", "--seed", "2")
    first = stop_after_a_view(methods)
    assert first != other
    assert not (scratch / "sweep").exists()
    done = run(*arguments, "--methods", methods)
    assert done.returncode == 0, done.stderr
    assert not unfinished.exists() and not list((scratch / "sweep").glob("*.cbor"))
    results = json.loads((scratch / "sweep" / "results.json").read_text())
    runs = results["runs"]
    # the third round leaves out what two settled
    for entry in runs:
        times = entry["frame_ms"]
        assert times["n"] == 3 or (times["n"] == 2 and times["max"] <= 1.05 * times["min"]), entry
    taken = [t for r in runs for t in (r["frame_ms"]["min"], r["frame_ms"]["max"])]
    assert all(struct.pack(">d", t) in first for t in taken), "times of the first attempt"
    for method in dict.fromkeys(r["method"] for r in runs if r["map"]):
        of_size = {m: sum(r["wrong_pixel_ratio"] for r in runs if r["method"] == method
                          and r["map"] == m and "variant" not in r) for m in (32, 64, 256)}
        assert of_size[32] > of_size[64] > of_size[256], (method, of_size)
    html = (scratch / "sweep" / "report.html").read_text()
    accuracy = results["accuracy"]
    assert accuracy["map"] == 32 and accuracy["scores"] and accuracy["equal_quality"]
    timed = {(r["camera"], r["method"], r["map"]): r for r in runs if "variant" not in r}
    assert {e["target"] for e in accuracy["equal_time"]} == {"sm", "fitted", "notw"}
    for entry in (e for e in accuracy["equal_time"] if e["map"]):
        one, target = (timed[entry["camera"], m, s] for m, s in
                       ((entry["method"], entry["map"]), (entry["target"], 32)))
        assert one["frame_ms"]["median"] <= target["frame_ms"]["median"], entry
        assert abs(entry["wrong"] * target["wrong_pixel_ratio"] - one["wrong_pixel_ratio"]) < 1e-9
    check_variants(accuracy["variants"], runs, html)
    best = [b for b in accuracy["budgets"] if b["scene"] == "leaves"]
    errors = [b["wrong_pixel_ratio"] for b in best]
    assert errors == sorted(errors, reverse=True), "more time is never worse"
    # a view with two plots, and a path with six
    assert "Which method to take" in html and html.count("<section>") == 2
    assert html.count("<svg") == 2 + 6 and html.count('class="compare"') == 1
    assert "pixels that flip" in html
    paths = {p["method"]: p for p in results["paths"]}
    assert list(paths) == ["sm", "dv", "fitted", "notw"]
    for path in paths.values():
        assert (path["path"], path["camera"], path["map"]) == ("yaw", "0", 32)
        assert len(path["frames"]) == 12
        still = next(r for r in runs if (r["camera"], r["method"], r["map"])
                     == ("0", path["method"], 32) and "variant" not in r)
        assert path["frames"][0]["wrong_pixel_ratio"] == still["wrong_pixel_ratio"]
    assert paths["sm"]["mean"]["flip_ratio"] == 0 < paths["dv"]["mean"]["flip_ratio"]


def check_variants(scores, runs, html):
    """One thing changed at a time: what must change, and what must not."""
    of = {(s["method"], s["variant"]): s for s in scores}
    assert set(of) == {(r["method"], r["variant"]) for r in runs if "variant" in r}
    assert all(s["views"] == 1 and s["frame_time"] > 0 for s in scores)
    assert "One thing at a time" in html and all(f"<td>{name}</td>" in html for _, name in of)
    for (method, name), score in of.items():
        if name == "float":
            # the same matrices but for rounding
            assert abs(score["wrong"] - 1) < 0.01 and score["bytes"] == 1, (method, score)
            assert all(r["setup"] == "float" for r in runs if r.get("variant") == name)
        assert (score["light_error"] is not None) == name.startswith("filter "), name
    assert {m for m, name in of if name == "float"} == {"sm", "dv", "fitted", "notw"}
    # half a step of 16 bits is 1/4096 of a texel here
    assert abs(of["notw", "unorm16"]["wrong"] - 1) < 0.02 and of["notw", "unorm16"]["bytes"] < 1
    assert of["notw", "raster none"]["wrong"] > 1.1 > of["notw", "raster bound:0.25"]["wrong"]
    # hard edges err by all of the light at a pixel, soft ones by a part of it, in more pixels
    for name in ("filter pcf", "filter pcf-texels:2"):
        assert of["notw", name]["light_error"] > of["notw", name]["wrong"] > 0


def check_files_as_scenes():
    # seen from where the light is, the raised square hides its own shadow
    both = report("gltf", "--scene", str(data / "two_quads.gltf"), "--camera",
                  "0.01,20,0,0,0,0,40", "--light", "sun:0,-1,0", "--methods", "sm,raytraced",
                  "--map", "256")
    assert {r["scene"] for r in both["runs"]} == {"two_quads"}
    assert {r["triangles"] for r in both["runs"]} == {4}
    assert both["runs"][0]["wrong_pixel_ratio"] < 0.01
    obj = report("obj", "--scene", str(data / "quad_and_line.obj"), "--methods", "sm", "--map", "64")
    assert obj["runs"][0]["triangles"] == 2
    assert obj["runs"][0]["samples"] > 0, "the camera derived from the box sees the mesh"
    assert obj["runs"][0]["wrong_pixel_ratio"] == 0, "a flat square casts no shadow on itself"


def check_views():
    several = report("views", "--scene", "leaves", "--camera", "0", "--camera", "1", "--light", "0",
                     "--light", "1", "--methods", "sm", "--map", "64")
    assert [(r["camera"], r["light"]) for r in several["runs"]] == [
        ("0", "0"), ("0", "1"), ("1", "0"), ("1", "1")]


def check_folders():
    mine = scratch / "mine"
    mine.mkdir()
    (mine / "notes.txt").write_text("keep")
    refused = run(*SMALL, "--scene", "leaves", "--methods", "sm", "--map", "64", "--out", "mine")
    assert refused.returncode != 0 and "other than a report" in refused.stderr
    assert [p.name for p in mine.iterdir()] == ["notes.txt"]
    (scratch / "hollow").mkdir()
    report("hollow", "--scene", "leaves", "--methods", "sm", "--map", "64")
    report("made/on/the/way", "--scene", "leaves", "--methods", "sm", "--map", "64")
    # an earlier report is still there when a run fails
    before = (scratch / "hollow" / "results.json").read_bytes()
    failed = run(*SMALL, "--scene", "leaves", "--map", "1000000", "--out", "hollow")
    assert failed.returncode != 0
    assert (scratch / "hollow" / "results.json").read_bytes() == before


def check_help():
    done = run("--help")
    assert done.returncode == 0 and done.stderr == ""
    for option in ("--scene", "--list-scenes", "--camera", "--light", "--methods", "--map",
                   "--view", "--repeat", "--bias", "--setup", "--importance", "--tables",
                   "--tables-format", "--window", "--floor",
                   "--smooth", "--shear", "--align", "--order", "--power", "--subset", "--cells",
                   "--collapse", "--sigma", "--filter", "--preset", "--sweep", "--path", "--frames",
                   "--seed", "--out", "Examples:"):
        assert option in done.stdout, option
    listed = run("--list-scenes")
    assert listed.returncode == 0 and listed.stderr == ""
    for name in ("outdoor", "colonnade", "interior", "leaves"):
        assert re.search(rf"^{name}: ", listed.stdout, re.M), name
    assert not list(scratch.iterdir()), "neither help nor list writes anything"


shutil.rmtree(scratch, ignore_errors=True)
scratch.mkdir(parents=True)
scratch = scratch.resolve()
PARTS = {
    "folders": (check_help, check_folders, check_files_as_scenes, check_finer_scene, check_views),
    "methods": (check_every_method,),
    "lights": (check_spot_and_point, check_virtual_lights),
    "tables": (check_tables, check_table_formats, check_bytes, check_set_up),
    "paths": (check_paths,),
    "biases": (check_biases,),
    "figures": (check_figures, check_raster_figure),
    "sweep": (check_sweep,),
}
for check in PARTS[part]:
    check()
for path in scratch.iterdir():
    if path.name not in ("sweep", "biases", "yaw", "figure8", "vpl"):
        shutil.rmtree(path)
