#!/usr/bin/env python3
"""Checks what no compiler checks: layout of text files, words, links, names, rules for headers."""

import os
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SUFFIXES = {".hpp", ".cpp", ".h", ".c", ".glsl", ".vert", ".frag", ".comp", ".tesc", ".tese", ".geom",
            ".py", ".sh", ".cmake", ".in", ".txt", ".md", ".json", ".yml", ""}
SKIP = {".git", "build", "report", "__pycache__", ".cache"}

# Spelt in two parts, so that this file does not contain what it looks for.
PHRASES = {
    "a path of one machine": r"(?<![\w.~-])/(?:wo" r"rk|ro" r"ot|ho" r"me)/",
    "unfinished work": r"\b(?:TO" r"DO|FIX" r"ME|XX" r"X|HA" r"CK)\b|\bplace" r"holder\b",
    "an issue number": r"(?i)\bissue\s+#?\d",
}

# Macros of windows.h: no name in a header may be one.
MACROS = r"(?<![\w.])(?:near|far)\b|\.(?:near|far)\b"
# Reserved in GLSL or HLSL: no public function or type may be named so. (The translator renames
# local variables and refuses what it cannot rename.)
RESERVED = "|".join("""
    active asm buffer centroid coherent common discard filter fixed flat half image in inout input
    interface invariant layout noise noperspective out output partition patch precise precision
    readonly resource restrict sample sampler shared smooth subroutine superp texture uniform varying
    writeonly
""".split())
RESERVED_NAME = rf"\b(?:struct|class|enum)\s+(?:{RESERVED})\b|^[A-Za-z].*\s(?:{RESERVED})\s*\("

# The GLSL as text: for programs that write shaders, so strings are what it is about.
TEXT_HEADERS = {"include/warpshadow/glsl.hpp", "include/warpshadow/detail/glsl_text.hpp"}

HEADER_INCLUDE = re.compile(
    r'#include\s+(?:"warpshadow/[\w/]+\.hpp"|<(?:warpshadow|glm)/[\w/]+\.hpp>|<[a-z_]+>)\s*(?://.*)?$')
BANNED = {
    r"\b(?:throw|try|catch|dynamic_cast|typeid)\b": "exceptions and RTTI stay out of the headers",
    r"\bnew\b|\bdelete\b(?!\s*;)|\bmalloc\b|\bstd::(?:vector|string|map|list|deque|function|unique_ptr"
    r"|shared_ptr)\b": "headers allocate nothing",
    r"\bw?[A-Za-z]\w*__\w*": "names with two underscores are reserved",
    r"\bround\s*\(": "round is not portable to GLSL: floor(x + 0.5)",
    r"\bassert\s*\(": "functions are total: no assert",
}
COMPILER_MACROS = re.compile(r"\b__\w+__\b|\b__has_\w+|\b__clang\w*|\b__cpp\w*|\b__GNU\w*")
TOKEN = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', re.DOTALL)


def text_files():
    for folder, folders, names in os.walk(ROOT):
        folders[:] = sorted(f for f in folders if f not in SKIP)
        for name in sorted(names):
            path = Path(folder, name)
            if path.suffix in SUFFIXES:
                yield path


def code_only(text):
    """The text with comments and literals blanked, lines kept."""
    return TOKEN.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), text)


def check_text(path, text):
    for number, line in enumerate(text.split("\n"), 1):
        if line != line.rstrip():
            yield number, "blanks at the end of the line"
        if "\t" in line and path.suffix not in {".txt"}:
            yield number, "a tab"
        for name, pattern in PHRASES.items():
            if re.search(pattern, line):
                yield number, name
    if text and not text.endswith("\n"):
        yield text.count("\n") + 1, "no line feed at the end"


def check_links(path, text):
    for match in re.finditer(r"\]\((?!\w+:)([^)#\s]+)", text):
        if not (path.parent / match[1]).exists():
            yield text.count("\n", 0, match.start()) + 1, f"a link to {match[1]}, which is not there"


def check_header(text):
    if "#pragma once" not in text:
        yield 1, "no #pragma once"
    for number, (line, code) in enumerate(zip(text.split("\n"), code_only(text).split("\n")), 1):
        if line.lstrip().startswith("#"):
            if line.lstrip().startswith("#include") and not HEADER_INCLUDE.match(line):
                yield number, "headers include <warpshadow/...>, <glm/...> and the standard library alone"
            continue
        code = COMPILER_MACROS.sub(" ", code)
        if re.search(MACROS, code):
            yield number, "near and far are macros of windows.h"
        if re.search(RESERVED_NAME, code):
            yield number, "a word that is reserved in a shading language"
        for pattern, reason in BANNED.items():
            if re.search(pattern, code):
                yield number, reason


def main():
    faults = count = 0
    for path in text_files():
        name = path.relative_to(ROOT)
        try:
            text = path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            print(f"{name}: not UTF-8")
            faults += 1
            continue
        count += 1
        found = list(check_text(path, text))
        if path.suffix == ".md":
            found += check_links(path, text)
        if name.parts[0] == "include" and str(name) not in TEXT_HEADERS:
            found += check_header(text)
        for number, fault in found:
            print(f"{name}:{number}: {fault}")
        faults += len(found)
    print(f"{count} files, {faults} faults")
    sys.exit(1 if faults or not count else 0)


if __name__ == "__main__":
    main()
