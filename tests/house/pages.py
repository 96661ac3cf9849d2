"""Checks the pages: links lead somewhere, pages are short, say for whom they are, name the command of each generated table, and have no placeholders.

usage: pages.py PROJECT_ROOT
Exit 1 with a line an offence. It first checks itself on what must be refused.
"""
import pathlib
import re
import sys
import tempfile

from words import files

MOST_WORDS = 20000  # in all; of single pages:
LIMITS = {"README.md": 500, "perf/README.md": 1500, "perf/trade/README.md": 600, "assets/evaluation/README.md": 700, "runtime/README.md": 2000}
LINK = re.compile(r"(?<!\\)\[(?:[^\[\]]|!\[[^\]]*\]\([^)]*\))*\]\(([^)\s]+)\)")
PLACEHOLDERS = {"EVAL", "FIGURES", "TBD", "TODO"}
BLOCK = re.compile(r"<!-- (?!end of )(\S+) -->\n(.*?)<!-- end of \1 -->", re.DOTALL)


def pages(root):
    return [root / path for path in files(root) if path.suffix == ".md"]


def without_code(text):
    text = re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE)
    return re.sub(r"`[^`\n]*`", "", text)


def anchors(text):
    """Of a page's headings, as forges make them."""
    found = set()
    for heading in re.findall(r"^#+ (.*)$", re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE), re.MULTILINE):
        slug = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        found.add(slug if slug not in found else next(f"{slug}-{k}" for k in range(1, 99) if f"{slug}-{k}" not in found))
    return found


def broken_links(root, path, text):
    for target in LINK.findall(without_code(text)):
        if re.match(r"[a-z]+:", target):
            continue
        file, _, anchor = target.partition("#")
        there = (path.parent / file if file else path).resolve()
        if not there.exists():
            yield f"leads to {file}, which does not exist"
        elif not there.is_relative_to(root.resolve()):
            yield f"leads to {file}, outside of the project"
        elif anchor and anchor not in anchors(there.read_text()):
            yield f"leads to #{anchor}, a heading that {there.name} does not have"


def tables_without_command(root, text):
    for name, block in BLOCK.findall(text):
        named = re.findall(r"`([^`\s]+)[^`]*`", block.lstrip().split("\n")[0])
        if not any((root / command).is_file() for command in named):
            yield f"does not begin the generated table {name} with the `command` that writes it"


def placeholders(text):
    for row in re.findall(r"^[ \t]*\|(.*)$", without_code(text), re.MULTILINE):
        for cell in row.split("|"):
            if cell.strip(" \t*_") in PLACEHOLDERS:
                yield f"has a table with the placeholder {cell.strip()}: write its figures"


def offences(root):
    total, found = 0, pages(root)
    if not found:
        yield f"{root}: no page to check"
    for path in found:
        name, text = str(path.relative_to(root)), path.read_text()
        words = len(text.split())
        total += words
        if name in LIMITS and words > LIMITS[name]:
            yield f"{name} has {words} words, more than {LIMITS[name]}: move tables to reports, or delete"
        if name.startswith("docs/") and not re.match(r"# .*\n\nFor ", text):
            yield f"{name} does not say, below its title, for whom it is (\"For ...\")"
        for offence in [*broken_links(root, path, text), *tables_without_command(root, text), *placeholders(text)]:
            yield f"{name} {offence}"
    if total > MOST_WORDS:
        yield f"all pages have {total} words, more than {MOST_WORDS}: shorten what is longest"


def refuses():
    """Whether each kind of offence is found in a made-up project, and a good page passes."""
    good = "# A page\n\nFor readers.\n\n## One, two\n[here](#one-two), [there](b.md), `[no](link)`\n<!-- t -->\n`run.sh`, one machine\n<!-- end of t -->\n"
    bad = {"[x](none.md)": "does not exist", "[x](b.md#none)": "heading", "[x](../../..)": "outside",
           "<!-- t -->\n| 1 |\n<!-- end of t -->": "command", "| a |\n|---|\n| **EVAL** |": "placeholder", "word " * MOST_WORDS: "all pages"}
    for extra, expected in {"": None, **bad}.items():
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "docs").mkdir()
            (root / "run.sh").touch()
            (root / "docs" / "b.md").write_text("# B\n\nFor readers.\n")
            (root / "docs" / "a.md").write_text(good + extra + "\n")
            found = list(offences(root))
            if (len(found) != 1 or expected not in found[0]) if expected else found:
                print(f"pages.py is broken: of {extra[:40]!r} it says {found}")
                return False
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for empty in (root, root / "none"):
            if [*offences(empty)] != [f"{empty}: no page to check"]:
                print("pages.py is broken: it passes where no page is")
                return False
        for left_out in ("shared", ".venv"):
            (root / left_out).mkdir()
            (root / left_out / "a.md").write_text("[x](none.md)")
        (root / "docs").mkdir()
        (root / "docs" / "a.md").write_text("# A page\n\nWithout readers.\n")
        (root / "README.md").write_text("word " * 501)
        found = list(offences(root))
        if len(found) != 2:
            print(f"pages.py is broken: of two pages without readers and too long it says {found}")
        return len(found) == 2


def main(root):
    if not refuses():
        return 1
    found = list(offences(pathlib.Path(root)))
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
