#!/usr/bin/env python3
"""No product of the vector stages is fused with a sum, but in the first look that is made for it.

    contraction.py OBJDUMP LIBRARY

Reads the machine code of the library. Exit status 1 if a function outside of `fused_first_look` has a fused multiply-add,
or if none has one there: then this test could not fail.
"""
import re
import subprocess
import sys

FUSED = re.compile(r"\t(?:vfn?m(?:add|sub)\w*|fn?m(?:add|sub)|fml[as])\s")
FUNCTION = re.compile(r"^[0-9a-f]+ <(.*)>:$")


def fused_by_function(objdump, library):
    """How many fused multiply-adds each function has; only those that have any."""
    code = subprocess.run([objdump, "-dC", "--no-show-raw-insn", library], capture_output=True, text=True, check=True)
    counts = {}
    function = ""
    for line in code.stdout.splitlines():
        if match := FUNCTION.match(line):
            function = match.group(1)
        elif FUSED.search(line):
            counts[function] = counts.get(function, 0) + 1
    return counts


def main():
    counts = fused_by_function(*sys.argv[1:3])
    stray = {name: count for name, count in counts.items() if "fused_first_look" not in name}
    for name, count in stray.items():
        print(f"{count} fused multiply-adds in {name}")
    if not counts:
        print("no fused multiply-add anywhere, not even in fused_first_look")
    return 1 if stray or not counts else 0


if __name__ == "__main__":
    sys.exit(main())
