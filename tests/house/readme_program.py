"""Checks that each page's first program is the file that the build compiles and a test runs, line by line.

usage: readme_program.py PROJECT_ROOT
"""
import pathlib
import re
import sys

PROGRAMS = {"README.md": "samples/hello/hello.cpp", "runtime/README.md": "tests/house/tracy_hook.hpp",
            "docs/in-your-engine.md": "samples/engine/engine.c"}


def shows(root, page, file):
    shown = re.search(r"```c(?:pp)?\n(.*?)```", (root / page).read_text(), re.DOTALL)
    if not shown:
        print(f"{page} shows no program")
        return False
    program = (root / file).read_text()
    program = program[program.index("#include"):]
    if shown.group(1).strip() != program.strip():
        print(f"{page} shows another program than {file}: copy it there")
        return False
    return True


def main(root):
    return 0 if all([shows(pathlib.Path(root), page, file) for page, file in PROGRAMS.items()]) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
