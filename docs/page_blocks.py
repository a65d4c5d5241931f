"""Blocks of a document, tables in them, and plots beside it, written from measured results.

A block lies between <!-- NAME:begin --> and <!-- NAME:end -->.
"""

import re
import sys


def fill(page, blocks, script, check):
    """Puts the text of each block (NAME: text) into the page; with `check` it must be there."""
    text = page.read_text(encoding="utf-8")
    updated = text
    for name, content in blocks.items():
        block = re.compile(rf"(<!-- {name}:begin -->\n).*?(<!-- {name}:end -->)", re.DOTALL)
        if not block.search(updated):
            sys.exit(f"{page.name} has no block {name}")
        # a function, so that backslashes of the content stay as they are
        updated = block.sub(lambda found, new=content: found.group(1) + new + found.group(2), updated)
    if not check:
        page.write_text(updated, encoding="utf-8")
    elif updated != text:
        sys.exit(f"{page.name} does not say what was measured: run {script}")


def table(head, rows):
    """A table whose first column is text and whose others are numbers."""
    lines = ["| " + " | ".join(head) + " |", "| --- |" + " --: |" * (len(head) - 1)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def keep_pictures(folder, pictures, script, check):
    """Writes the SVG files (name: text) of a folder; with `check` they must be all that is there."""
    stale = []
    for name, content in pictures.items():
        file = folder / name
        if not file.exists() or file.read_text(encoding="utf-8") != content:
            stale.append(name)
            if not check:
                file.write_text(content, encoding="utf-8")
    stale += sorted(file.name for file in folder.glob("*.svg") if file.name not in pictures)
    if check and stale:
        sys.exit(f"{', '.join(stale)}: not what was measured: run {script}")
