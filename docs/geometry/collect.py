#!/usr/bin/env python3
"""Reduces what was measured to what docs/geometry.md shows of it.

usage: docs/geometry/collect.py speed O2.json NATIVE.json    writes docs/geometry/speed.json
       docs/geometry/collect.py frames RESULTS.json          writes docs/geometry/frames.json

The inputs are the output of `geometry_bench` and `geometry_bench_native` (--benchmark_out), and
results.json of warpshadow-lab. `./run.sh measure geometry` makes them.
"""

import json
import pathlib
import sys

FOLDER = pathlib.Path(__file__).resolve().parent
NANOSECONDS = {"ns": 1.0, "us": 1e3, "ms": 1e6, "s": 1e9}


def read(path):
    return json.loads(pathlib.Path(path).read_text(encoding="utf-8"))


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return "unknown processor"


def speed(names):
    result = {"processor": processor()}
    for build, path in zip(("o2", "native"), names, strict=True):
        measured = read(path)
        times = {}
        for run in measured["benchmarks"]:
            if run["run_type"] == "iteration":
                times.setdefault(run["run_name"], []).append(
                    run["cpu_time"] * NANOSECONDS[run["time_unit"]])
        context = measured["context"]
        result[build] = {
            "compiler": context["compiler"],
            "doubles_at_once": int(context["lanes"]),
            "repetitions": len(next(iter(times.values()))),
            "nanoseconds": {name: float(f"{min(t):.4g}")
                            for name, t in sorted(times.items())},
        }
    return result


def frames(names):
    (path,) = names
    results = read(path)
    kept = ("scene", "light", "method", "map", "view", "wrong_pixel_ratio", "frame_ms",
            "cpu_setup_us")
    return {"device": results["device"],
            "runs": [{key: run[key] for key in kept} for run in results["runs"]]}


def main():
    kinds = {"speed": speed, "frames": frames}
    if len(sys.argv) < 3 or sys.argv[1] not in kinds:
        sys.exit(__doc__.strip())
    kind = sys.argv[1]
    collected = kinds[kind](sys.argv[2:])
    (FOLDER / f"{kind}.json").write_text(json.dumps(collected, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
