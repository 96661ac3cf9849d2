"""Checks that the README's C++ program is samples/hello/hello.cpp (which the build compiles and a test runs), line by line.

usage: readme_program.py PROJECT_ROOT
"""
import pathlib
import re
import sys


def main(root):
    root = pathlib.Path(root)
    shown = re.search(r"```cpp\n(.*?)```", (root / "README.md").read_text(), re.DOTALL)
    if not shown:
        print("README.md shows no C++ program")
        return 1
    program = (root / "samples/hello/hello.cpp").read_text()
    program = program[program.index("#include"):]
    if shown.group(1).strip() != program.strip():
        print("README.md shows another program than samples/hello/hello.cpp: copy it there")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
