#!/usr/bin/env python3
"""Checks the links of all pages: files move, and a page does not see it.

    docs_links.py [TREE]

Each relative link of each *.md below TREE (else of this repository) must lead to a file or folder of the tree; its
anchor must be a heading of the page it leads to. A text that reads like a file name (`wall_segments.h`) must be the end
of the path that the link leads to: readers look for the name they read. Addresses of the web are not asked.

Ends with 1 and a line per wrong link, else with 0.
"""
import os
import re
import sys
import unicodedata

# What is no part of the repository: builds, their outputs, packages, tools.
LEFT_OUT = re.compile(r"^(build(-.*)?|out|node_modules|__pycache__|\..*)$")
FENCE = re.compile(r"^ *(`{3,}|~{3,})")
CODE = r"(?P<ticks>`+)(?!`).*?(?<!`)(?P=ticks)(?!`)"
TEXT = r"(?:[^\[\]`]|`[^`]*`|!\[[^\]]*\]\([^)]*\))*"
INLINE = re.compile(rf"\[(?P<text>{TEXT})\]\(\s*<?(?P<target>[^()<>\s]+)>?(?:\s+\"[^\"]*\")?\s*\)|{CODE}", re.S)
# [text]: target
REFERENCE = re.compile(r"^ {0,3}\[(?P<text>[^\]^]+)\]:\s+<?(?P<target>[^<>\s]+)>?", re.M)
ELSEWHERE = re.compile(r"^([a-z][a-z0-9+.-]*:|//)", re.I)
FILE_NAME = re.compile(r"^[\w.-]+(/[\w.-]+)*\.(cga|cmake|cpp|csv|h|json|md|mjs|osm|png|py|sh|toml|txt)$")


def without_fences(text):
    """The page with empty lines for blocks of code, so that lines keep their numbers."""
    lines, fence = [], None
    for line in text.split("\n"):
        mark = FENCE.match(line)
        if fence is None and mark:
            fence = mark.group(1)
            lines.append("")
        elif fence is not None:
            if mark and mark.group(1).startswith(fence) and line.strip() == mark.group(1):
                fence = None
            lines.append("")
        else:
            lines.append(line)
    return "\n".join(lines)


def links(text):
    """(line, text, target) of each link of a page."""
    page = without_fences(text)
    found = [m for m in INLINE.finditer(page) if m.group("target")] + list(REFERENCE.finditer(page))
    for match in sorted(found, key=lambda m: m.start()):
        yield page.count("\n", 0, match.start()) + 1, " ".join(match.group("text").split()), match.group("target")


def anchors(text):
    """The anchors of a page as GitHub makes them: of headings, and those written as <a id>."""
    found, seen = set(re.findall(r"""<a\s+(?:id|name)=["']([^"']+)["']""", text)), {}
    lines = without_fences(text).split("\n")
    for line, below in zip(lines, lines[1:] + [""]):
        heading = re.match(r"^ {0,3}#{1,6}\s+(.*?)\s*#*\s*$", line)
        if not heading and re.match(r"^ {0,3}(=+|-+)\s*$", below) and re.match(r"^ {0,3}[^\s#>|*-]", line):
            heading = re.match(r"^ *(.*?)\s*$", line)
        if not heading:
            continue
        words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading.group(1)).lower()
        slug = "".join("-" if c == " " else c for c in words
                       if c in " -_" or unicodedata.category(c)[0] in "LN" or unicodedata.category(c) == "Mn")
        count = seen.get(slug, 0)
        seen[slug] = count + 1
        found.add(f"{slug}-{count}" if count else slug)
    return found


def read(path):
    with open(path, encoding="utf-8") as page:
        return page.read()


def exists(tree, path):
    """As a file system that tells capitals apart has it, whatever this one does."""
    folder = tree
    for name in path.split("/"):
        if not os.path.isdir(folder) or name not in os.listdir(folder):
            return False
        folder = os.path.join(folder, name)
    return True


def fault(tree, page, text, target):
    """What is wrong with a link of `page` (a path below `tree`); empty where nothing is."""
    file, _, anchor = target.partition("#")
    path = os.path.normpath(os.path.join(os.path.dirname(page), file)) if file else page
    if path.startswith(".."):
        return "leads out of the repository"
    if path != "." and not exists(tree, path):
        return "leads nowhere"
    if anchor and path.endswith(".md") and anchor not in anchors(read(os.path.join(tree, path))):
        return f"{path} has no heading for #{anchor}"
    name = text.strip("`")
    if FILE_NAME.match(name) and not f"/{path}".endswith(f"/{name}"):
        return "its text is the name of another file"
    return ""


def pages(tree):
    for folder, folders, names in os.walk(tree):
        folders[:] = sorted(f for f in folders if not LEFT_OUT.match(f))
        yield from (os.path.relpath(os.path.join(folder, n), tree) for n in sorted(names) if n.endswith(".md"))


def faults(tree):
    """(number of relative links, a line for each that is wrong)."""
    count, wrong = 0, []
    for page in pages(tree):
        for line, text, target in links(read(os.path.join(tree, page))):
            if ELSEWHERE.match(target):
                continue
            count += 1
            what = fault(tree, page, text, target)
            if what:
                wrong.append(f"{page}:{line}: [{text}]({target}): {what}")
    return count, wrong


def main():
    if len(sys.argv) > 2 or sys.argv[1:] in (["-h"], ["--help"]):
        raise SystemExit(__doc__)
    tree = sys.argv[1] if len(sys.argv) == 2 else os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    count, wrong = faults(tree)
    print("\n".join(wrong + [f"{count} links, {len(wrong)} of them wrong"]))
    # A tree without links is not this one.
    sys.exit(1 if wrong or count == 0 else 0)


if __name__ == "__main__":
    main()
