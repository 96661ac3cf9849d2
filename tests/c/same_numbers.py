"""Checks that two programs print the same numbers, float by float.

usage: same_numbers.py REFERENCE -- CALLER...
"""
import subprocess
import sys

SKIPPED = 77  # what a caller ends with that lacks what it needs


def numbers(command):
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode == SKIPPED:
        print(done.stderr)
        sys.exit(SKIPPED)
    if done.returncode != 0:
        sys.exit(f"{command} ended with {done.returncode} (a line of its source):\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return [float(line) for line in done.stdout.split()]


def main(arguments):
    split = arguments.index("--")
    reference, caller = numbers(arguments[:split]), numbers(arguments[split + 1:])
    # Nine digits tell every float from its neighbours; how a language prints them does not matter.
    differing = sum(f"{a:.9g}" != f"{b:.9g}" for a, b in zip(reference, caller))
    print(f"{len(caller)} numbers, {differing} differ")
    return 0 if len(reference) == len(caller) > 0 and differing == 0 else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
