#!/usr/bin/env python3
"""Do two programs that print `NAME FAMILY: ANSWERS` give the same answers?

    compare.py [--must-differ] [--least N] A -- B [ARGUMENT..]

Compared is what both have; it must be at least N lines. Exit status 77 if B says so (there is no GPU).
"""
import argparse
import subprocess
import sys


def answers(command):
    made = subprocess.run(command, capture_output=True, text=True)
    if made.returncode == 77:
        print(made.stdout)
        sys.exit(77)
    if made.returncode:
        sys.exit(f"{' '.join(command)}: exit status {made.returncode}\n{made.stderr}")
    return dict(line.split(": ", 1) for line in made.stdout.splitlines())


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--must-differ", action="store_true")
    parser.add_argument("--least", type=int, default=1)
    parser.add_argument("a")
    parser.add_argument("b", nargs="+")
    options = parser.parse_args()
    b = answers(options.b)
    a = answers([options.a])
    both = [key for key in a if key in b]
    different = [key for key in both if a[key] != b[key]]
    for key in different[:20]:
        print(f"{key}: {a[key]}\n{' ' * len(key)}  {b[key]}")
    print(f"{len(both)} compared, {len(different)} different")
    if len(both) < options.least:
        sys.exit(f"expected at least {options.least}")
    return int(bool(different) != options.must_differ)


if __name__ == "__main__":
    sys.exit(main())
