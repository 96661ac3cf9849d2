"""Checks that pages, help texts and messages use the field's words and none that only this repository uses.

usage: words.py PROJECT_ROOT
words.csv lists the words, as regular expressions of whole words without regard to case, and what to write instead. What is checked:
  every *.md page, without its code blocks, code spans and link targets
  string literals with a space in C++ and C of runtime, baker, samples and perf
  string literals with a space, and usage texts, in Python of baker, python, perf, assets, docs and samples
  string literals with a space in JavaScript, and the text of HTML, of samples and perf
  echo lines of shell scripts, and strings with a space in double quotes that a script passes to its own functions
Exit 1 with a line a use, or where nothing is found to check.
"""
import ast
import csv
import html.parser
import os
import pathlib
import re
import sys

SOURCES = {
    "runtime": (".cpp", ".hpp", ".h", ".c", ".inl"),
    "baker": (".cpp", ".hpp", ".h", ".c", ".inl", ".py"),
    "samples": (".cpp", ".hpp", ".h", ".c", ".py", ".js", ".mjs", ".html"),
    "perf": (".cpp", ".hpp", ".h", ".c", ".py", ".js", ".mjs"),
    "python": (".py",),
    "assets": (".py",),
    "docs": (".py",),
}
# Folders that hold no source and no page, here and in pages.py; those whose names begin with a dot are skipped too.
SKIPPED = {"build", "out", "shared", "node_modules", "__pycache__"}
HERE = pathlib.Path(__file__).parent


# ---- Texts of a file: (line, text) each. Replacements keep the line breaks, so that an offset in a text gives its line.

def blank(match):
    return re.sub(r"[^\n]", " ", match.group())


def without_escapes(text):
    """The text with its escaped quotes as quotes and all other escapes as spaces, so that \\nword is the word."""
    return re.sub(r"\\(?:x[0-9a-fA-F]+|u[0-9a-fA-F]{4}|\n|.)", lambda m: m.group()[1] if m.group()[1] in "\"'`" else blank(m), text)


def line_of(text, offset):
    return text.count("\n", 0, offset) + 1


PAGE_FENCE = re.compile(r"^ {0,3}(```+|~~~+)")
PAGE_ITEM = re.compile(r"^\s*([-*+]|\d+[.)]) ")


def page_texts(page):
    """Paragraphs of Markdown, one text each, so that a term may run over a line's end."""
    fence, in_item, in_code, after_break, lines = None, False, False, True, []
    for line in page.split("\n"):
        opened = PAGE_FENCE.match(line)
        if fence:
            if opened and opened.group(1).startswith(fence) and not line.strip(" `~"):
                fence = None
            line = ""
        elif opened:
            fence, line = opened.group(1), ""
        elif not line.strip():
            after_break = True
            lines.append("")
            continue
        elif line.startswith(("    ", "\t")) and not in_item and (in_code or after_break):
            in_code, line = True, ""
        else:
            in_code = False
            in_item = bool(PAGE_ITEM.match(line)) or (in_item and (line.startswith(" ") or not after_break))
        after_break = line.startswith("#")
        lines.append(line)
    text = re.sub(r"<!--.*?-->", blank, "\n".join(lines), flags=re.DOTALL)
    text = re.sub(r"(`+)(?!`)(?:(?!\n\n).)*?(?<!`)\1(?!`)", blank, text, flags=re.DOTALL)
    text = re.sub(r"(?<=\])\([^)\s]*\)|https?://\S+", blank, text)
    for block in re.finditer(r"[^\n]+(?:\n[^\n]+)*", text):
        yield line_of(text, block.start()), block.group()


def joined_texts(source, tokens, glue):
    """String literals, of which those that follow one another are one; tokens are (text of a literal or None, begin, end), glue may lie between."""
    joined, begin, end = [], 0, 0
    for text, token_begin, token_end in tokens:
        if text is not None:
            if joined:
                joined.append("\n" * source.count("\n", end, token_begin))
            else:
                begin = token_begin
            joined.append(text)
            end = token_end
        elif joined and not glue.fullmatch(source, token_begin, token_end):
            yield line_of(source, begin), "".join(joined)
            joined = []
    if joined:
        yield line_of(source, begin), "".join(joined)


C_TOKEN = re.compile(r"""
    (?P<comment>//(?:\\\n|[^\n])*|/\*.*?\*/)
  | (?P<include>^[ \t]*\#[ \t]*include[^\n]*)
  | (?P<raw>\b(?:u8|u|U|L)?R"(?P<mark>[^()\\\s"]*)\((?P<body>.*?)\)(?P=mark)")
  | (?P<string>(?:\b(?:u8|u|U|L))?"(?P<content>(?:\\.|[^"\\\n])*)")
  | (?P<char>'(?:\\.|[^'\\\n])+')
  | (?P<number>\b[0-9](?:[\w.]|'\w)*)
  | (?P<space>\s+)
  | (?P<name>\w+)
  | (?P<other>.)
""", re.VERBOSE | re.DOTALL | re.MULTILINE)
# A macro of a format, such as PRIu64, joins literals too.
C_GLUE = re.compile(r"\s+|//.*|/\*.*|(?:PRI|SCN)\w+", re.DOTALL)


def c_texts(source):
    def tokens():
        for token in C_TOKEN.finditer(source):
            text = token.group("body") if token.group("raw") else without_escapes(token.group("content")) if token.group("string") else None
            yield text, token.start(), token.end()
    return joined_texts(source, tokens(), C_GLUE)


PYTHON_TOKEN = re.compile(r"""
    (?P<comment>\#[^\n]*)
  | (?P<string>(?P<prefix>\b[rbfuRBFU]{1,2})?(?P<quote>\"{3}|\'{3}|"|')(?P<content>(?:\\.|.)*?)(?P=quote))
  | (?P<space>\s+)
  | (?P<name>\w+)
  | (?P<other>.)
""", re.VERBOSE | re.DOTALL)
PYTHON_GLUE = re.compile(r"\s+|\#.*")


def python_texts(source):
    """String literals that are no docstring, and the docstring of a module where it says how a program is used."""
    starts = [0]
    for line in source.split("\n"):
        starts.append(starts[-1] + len(line) + 1)
    docstrings = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)) and ast.get_docstring(node, clean=False) is not None:
            text = node.body[0].value
            if not isinstance(node, ast.Module) or ("usage:" not in text.value.lower() and "__doc__" not in source):
                docstrings.add(starts[text.lineno - 1] + text.col_offset)

    def tokens():
        for token in PYTHON_TOKEN.finditer(source):
            text = None
            if token.group("string") and token.start() not in docstrings:
                prefix, text = (token.group("prefix") or "").lower(), token.group("content")
                text = text if "r" in prefix else without_escapes(text)
                for _ in range(2 if "f" in prefix else 0):  # names in braces, and in the format of such
                    text = re.sub(r"\{[^{}\"']*\}", blank, text)
            yield text, token.start(), token.end()
    return joined_texts(source, tokens(), PYTHON_GLUE)


JS_TOKEN = re.compile(r"""
    (?P<comment>//[^\n]*|/\*.*?\*/)
  | (?P<regex>(?<=[(,=:\[!&|?{};\n])[ ]*/(?![/*])(?:\\.|\[(?:\\.|[^\]\\\n])*\]|[^/\\\n\[])+/)
  | (?P<string>"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*')
  | (?P<template>`(?:\\.|[^`\\])*`)
  | (?P<other>.)
""", re.VERBOSE | re.DOTALL)


def js_texts(source):
    for token in JS_TOKEN.finditer(source):
        if token.lastgroup in ("string", "template"):
            text = without_escapes(token.group()[1:-1])
            yield line_of(source, token.start()), re.sub(r"\$\{[^}]*\}", blank, text) if token.lastgroup == "template" else text


class Html(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.texts, self.tag = [], None

    def handle_starttag(self, tag, attributes):
        self.tag = tag
        for name, value in attributes:
            if value and name in ("title", "alt", "content", "placeholder", "aria-label", "aria-description"):
                self.texts.append((self.getpos()[0], value))

    def handle_endtag(self, tag):
        self.tag = None

    def handle_data(self, data):
        if self.tag == "script":
            self.texts += [(self.getpos()[0] + line - 1, text) for line, text in js_texts(data) if " " in text]
        elif self.tag != "style":
            self.texts.append((self.getpos()[0], data))


def html_texts(source):
    reader = Html()
    reader.feed(source)
    return reader.texts


SHELL_COMMAND = r"(?:^|[;&|({]|\bthen|\belse|\bdo)\s*"


def shell_texts(source):
    says = re.compile(SHELL_COMMAND + r"(?:echo|printf)\s(.*)")
    functions = "|".join(re.findall(r"^[ \t]*(\w+)[ \t]*\(\)", source, re.MULTILINE))
    calls = re.compile(SHELL_COMMAND + rf"(?:{functions})\s(.*)") if functions else None
    for number, line in enumerate(source.split("\n"), 1):
        found = [line[said.start(1):] for said in says.finditer(line)]
        if calls and (call := calls.search(says.sub("", line))):
            found += [text for text in re.findall(r'"((?:\\.|[^"\\])*)"', call.group(1)) if " " in text]
        for text in found:
            yield number, without_escapes(re.sub(r"\$\{?\w+\}?", blank, text))


READERS = {".md": page_texts, ".py": python_texts, ".js": js_texts, ".mjs": js_texts, ".html": html_texts, ".sh": shell_texts}
# Of these a single word is a text too.
WHOLE = (".md", ".html", ".sh")


def files(root):
    for folder, folders, names in os.walk(root):
        folders[:] = sorted(f for f in folders if f not in SKIPPED and not f.startswith("."))
        for name in sorted(names):
            path = pathlib.Path(folder, name).relative_to(root)
            if path.suffix in (".md", ".sh") or path.suffix in SOURCES.get(path.parts[0], ()):
                yield path


def texts(root, path):
    reader = READERS.get(path.suffix, c_texts)
    for line, text in reader((root / path).read_text(encoding="utf-8")):
        if path.suffix in WHOLE or " " in text.strip():
            yield line, text


# ---- Words

LOOKBEHIND = re.compile(r"(\(\?<[!=][^)]*\))")


def whole(pattern):
    """A word of its own: no part of an identifier, an option or a file's path, and no name in quotes. A space stands for any white space."""
    parts = LOOKBEHIND.split(pattern)
    pattern = "".join(part.replace(" ", r"\s" if i % 2 else r"\s+") for i, part in enumerate(parts))
    return re.compile(rf"(?<![\w/.-])(?!(?<=[\"'`])(?:{pattern})[\"'`])(?:{pattern})(?![\w/=-]|\.\w)", re.IGNORECASE)


def read_words(path):
    with path.open(encoding="utf-8", newline="") as file:
        return [(row["id"], whole(row["pattern"]), row["instead"]) for row in csv.DictReader(file)]


def uses(root, words):
    """Of every file: [(line, id, word as found, what to write instead)]."""
    found = {}
    for path in files(root):
        for line, text in texts(root, path):
            for name, pattern, instead in words:
                for match in pattern.finditer(text):
                    found.setdefault(path.as_posix(), []).append(
                        (line + text.count("\n", 0, match.start()), name, " ".join(match.group().split()), instead))
    return found


def main(root, folder=HERE):
    root = pathlib.Path(root)
    wrong = [f'{file}:{line}: "{word}" -> use "{instead}"'
             for file, uses_in_file in uses(root, read_words(folder / "words.csv")).items() for line, _, word, instead in sorted(uses_in_file)]
    if not any(files(root)):
        wrong = [f"{root}: no page and no source to check"]
    print("\n".join(wrong) or "pages, help texts and messages use the field's words")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
