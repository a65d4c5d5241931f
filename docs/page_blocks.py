"""Blocks of a document that are written from measured results.

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
