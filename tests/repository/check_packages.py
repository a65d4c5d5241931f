#!/usr/bin/env python3
"""Proves packages.txt: every package of the given groups is used, and nothing outside them is.

usage: check_packages.py GROUP[,GROUP...] BUILD_FOLDER...

Reads what the builds really did: ninja's recorded header dependencies, the commands in build.ninja,
the programs in CMakeCache.txt and in the ctest files, and the libraries that warpshadow-lab opens.
"""

import functools
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def read_list(groups):
    """Yields (package, kind, name) for each line of packages.txt that is of one of the groups."""
    for line in (ROOT / "packages.txt").read_text().splitlines():
        if line.strip() and not line.lstrip().startswith("#"):
            group, package, proof = line.split()
            kind, name = proof.split(":", 1)
            if group in groups:
                yield package, kind, name


def spellings(path):
    """The names under which dpkg may know a file: /lib and /usr/lib are one folder."""
    names = {path, os.path.normpath(path), os.path.realpath(path)}
    names |= {n[4:] for n in names if n.startswith("/usr/")} | {"/usr" + n for n in names}
    return names


@functools.cache
def dpkg_files():
    """All files that dpkg knows: path -> set of packages."""
    files = {}
    for listing in Path("/var/lib/dpkg/info").glob("*.list"):
        package = listing.stem.split(":")[0]
        for path in listing.read_text().splitlines():
            files.setdefault(path, set()).add(package)
    return files


def owners(path):
    return set().union(*(dpkg_files().get(name, set()) for name in spellings(path)))


@functools.cache
def dependencies():
    """Installed packages: name -> names it depends on (every alternative that is installed)."""
    query = "${db:Status-Status}\t${Package}\t${Provides}\t${Pre-Depends}, ${Depends}\n"
    text = subprocess.run(["dpkg-query", "--show", "--showformat", query],
                          capture_output=True, text=True, check=True).stdout
    rows = [row.split("\t")[1:] for row in text.splitlines() if row.startswith("installed\t")]
    bare = lambda text: [re.split(r"[ (:]", item.strip())[0] for item in re.split(r"[,|]", text)]
    provided = {}
    for package, provides, _ in rows:
        for name in [package, *bare(provides)]:
            provided.setdefault(name, set()).add(package)
    result = {}
    for package, _, depends in rows:
        result.setdefault(package, set()).update(*(provided.get(n, set()) for n in bare(depends)))
    return result


def closure(packages):
    graph = dependencies()
    done, open_ = set(), set(packages)
    while open_:
        package = open_.pop()
        done.add(package)
        open_ |= graph.get(package, set()) - done
    return done


class Builds:
    """What the given build folders used."""

    def __init__(self, folders):
        self.folders = [Path(f) for f in folders]
        self.headers, self.libraries, texts = set(), set(), []
        for folder in self.folders:
            deps = subprocess.run(["ninja", "-C", str(folder), "-t", "deps"],
                                  capture_output=True, text=True, check=True).stdout
            self.headers |= {line.strip() for line in deps.splitlines() if line.startswith("    /")}
            ninja = (folder / "build.ninja").read_text()
            self.libraries |= set(re.findall(r"/[^\s:]+\.(?:so[.\d]*|a)(?=\s)", ninja))
            texts += [ninja, (folder / "CMakeCache.txt").read_text()]
            texts += [f.read_text() for f in folder.rglob("CTestTestfile.cmake")]
        ours = (str(ROOT) + "/", *(f"{folder.resolve()}/" for folder in self.folders))
        self.headers = {h for h in self.headers if not h.startswith(ours)}
        self.libraries = {l for l in self.libraries if not l.startswith(ours)}
        texts.append((ROOT / "run.sh").read_text())
        self.commands = "\n".join(texts)

    def calls(self, program):
        return re.search(r"(?<![\w+-])" + re.escape(program) + r"(?![\w+-])", self.commands)

    def imports(self, module):
        scripts = {Path(p) for p in re.findall(r"/[^\s\"]+\.py(?![\w])", self.commands)}
        line = re.compile(rf"^\s*(?:from|import) {re.escape(module)}\b", re.M)
        return any(line.search(script.read_text()) for script in scripts if script.exists())

    @functools.cache
    def loaded(self):
        """Libraries that a small run of warpshadow-lab opens."""
        labs = [f / "bin/warpshadow-lab" for f in self.folders]
        lab = next((path for path in labs if path.exists()), None)
        if lab is None:
            return set()
        with tempfile.TemporaryDirectory() as folder:
            log = Path(folder) / "libraries"
            subprocess.run([lab, "--methods", "sm", "--map", "64", "--view", "64x64",
                            "--repeat", "1", "--out", f"{folder}/report"],
                           env={**os.environ, "LD_DEBUG": "libs", "LD_DEBUG_OUTPUT": str(log)},
                           check=True, stdout=subprocess.DEVNULL)
            text = "".join(f.read_text(errors="replace") for f in Path(folder).glob("libraries.*"))
        return set(re.findall(r"calling init: (\S+)", text))


def fault(builds, package, kind, name, listed):
    """Why the proof of one package fails, or None."""
    # python3 and libboost-dev leave their files to packages of other names: these stand for them.
    stands_for = {package} | (dependencies().get(package, set()) - listed)
    ends_with = lambda paths: [p for p in paths if p.endswith("/" + name)]
    if kind == "program":
        if not builds.calls(name):
            return f"nothing calls {name}"
        places = (shutil.which(name, path=p) for p in os.get_exec_path())
        found = [p for p in places if p]
    elif kind == "header":
        found = ends_with(builds.headers)
    elif kind == "library":
        found = ends_with(builds.libraries)
    elif kind == "loaded":
        found = ends_with(builds.loaded())
    elif kind == "python":
        if not builds.imports(name):
            return f"no script of a test imports {name}"
        where = f"import importlib.util as u; s = u.find_spec('{name}'); print(s.origin if s else '')"
        path = subprocess.run(["/usr/bin/python3", "-c", where],
                              capture_output=True, text=True, check=True).stdout.strip()
        found = [path] if path else []
    elif kind == "runtime":
        if "-fsanitize=address" not in builds.commands:
            return "no build uses -fsanitize=address"
        path = subprocess.run(["clang++", f"--print-file-name={name}"],
                              capture_output=True, text=True, check=True).stdout.strip()
        found = [path] if os.path.isabs(path) else []
    else:
        return f"unknown kind of proof {kind}"
    if not found:
        return f"no {kind} {name} in use"
    if not any(stands_for & owners(path) for path in found):
        return f"{found[0]} belongs to {', '.join(sorted(owners(found[0]))) or 'no package'}"
    return None


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    builds = Builds(sys.argv[2:])
    faults = []
    rows = list(read_list(sys.argv[1].split(",")))
    listed = {package for package, _, _ in rows}
    for package, kind, name in rows:
        problem = fault(builds, package, kind, name, listed)
        if problem:
            faults.append(f"{package}: listed, but {problem}")

    known = closure(listed)
    strangers = {}
    for path in builds.headers | builds.libraries:
        if not owners(path) & known and os.path.exists(path):
            strangers.setdefault(", ".join(sorted(owners(path))) or "no package", []).append(path)
    for package, paths in sorted(strangers.items()):
        faults.append(f"{package}: used, but not listed ({min(paths)} and {len(paths) - 1} more)")

    for line in faults:
        print(line)
    print(f"{len(listed)} packages listed, {len(builds.headers)} headers and "
          f"{len(builds.libraries)} libraries used, {len(faults)} faults")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
