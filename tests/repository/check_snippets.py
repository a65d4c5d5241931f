#!/usr/bin/env python3
"""Keeps the snippets in the documentation equal to the files that the tests compile.

A snippet is a fenced block after a line `<!-- snippet: FILE -->`. It has to be the part of FILE
between two lines that hold `[snippet]`. With --write the blocks are replaced by what FILE has.
"""

import re
import sys
import textwrap
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BLOCK = re.compile(r"(<!-- snippet: (\S+) -->\n```\w*\n)(.*?)(```\n)", re.DOTALL)


def snippet(name):
    parts = re.split(r"^.*\[snippet\].*\n", (ROOT / name).read_text(), flags=re.MULTILINE)
    if len(parts) != 3:
        sys.exit(f"{name}: needs two lines with [snippet]")
    return textwrap.dedent(parts[1])


def main():
    write = sys.argv[1:] == ["--write"]
    count = stale = 0
    for page in [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]:
        old = page.read_text()
        new = BLOCK.sub(lambda m: m[1] + snippet(m[2]) + m[4], old)
        count += len(BLOCK.findall(old))
        if new != old:
            stale += 1
            if write:
                page.write_text(new)
            print(f"{page.relative_to(ROOT)}: {'rewritten' if write else 'differs from its source'}")
    print(f"{count} snippets")
    if stale and not write:
        print("mend it with: python3 tests/repository/check_snippets.py --write")
        sys.exit(1)


if __name__ == "__main__":
    main()
