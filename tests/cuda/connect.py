#!/usr/bin/env python3
"""Writes C++ that connects generated batches to a test's arrays.

    connect.py FOLDER OUTPUT     every *.cuda.h of FOLDER but those of mode `float`; OUTPUT is a header

It includes them, under nvcc the .cu files. For every tightrope::Batch there is a function `connect(batch, arrays)` that
calls arrays.input(member, numbers) for all inputs and arrays.output(member, numbers) for all results, in order, and at
the end `for_every_batch(f)`, which calls f.operator()<Batch>(name) for each.
"""
import pathlib
import re
import sys

BATCH = re.compile(r"^struct Batch<(generated::(\w+)<bound::(\w+), (\w+)>)> \{$")
INPUT = re.compile(r"^    (?:Bounded)?ArgumentArray<\w+> (\w+); +// (\d+) numbers?$")
STAGE = re.compile(r"^    \} (\w+);$")
OUTPUT = re.compile(r"^      OutputArray<\w+> (\w+); +// (\d+) numbers?$")


def batches(text):
    """Every batch of a header as (type, name, [(input, numbers)], [(output, numbers)])."""
    found = []
    outputs = []
    for line in text.splitlines():
        if match := BATCH.match(line):
            kind, predicate, bound, real = match.groups()
            found.append((kind, f"{predicate}.{bound}.{real}", [], []))
        elif match := INPUT.match(line):
            found[-1][2].append(match.groups())
        elif match := OUTPUT.match(line):
            outputs.append(match.groups())
        elif match := STAGE.match(line):
            found[-1][3].extend((f"{match.group(1)}.{name}", numbers) for name, numbers in outputs)
            outputs = []
    return found


def main(folder, output):
    headers = sorted(path for path in pathlib.Path(folder).glob("*.cuda.h") if path.name.split(".")[1] != "float")
    lines = ["#pragma once", "#if defined(__CUDACC__)"]
    lines += [f'#include "{header.name.removesuffix("da.h")}"' for header in headers]  # x.cuda.h, x.cu
    lines += ["#else"] + [f'#include "{header.name}"' for header in headers] + ["#endif"]
    found = [batch for header in headers for batch in batches(header.read_text())]
    lines += ["", "namespace tightrope_test {", "using namespace tightrope;"]
    for kind, name, inputs, outputs in found:
        lines += ["", "template <class Arrays>", f"void connect(Batch<{kind}>& batch, Arrays& arrays) {{"]
        lines += [f"  arrays.input(batch.inputs.{member}, {numbers});" for member, numbers in inputs]
        lines += [f"  arrays.output(batch.result.{member}, {numbers});" for member, numbers in outputs]
        lines += ["}"]
    lines += ["", "template <class Function>", "void for_every_batch(Function f) {"]
    lines += [f'  f.template operator()<Batch<{kind}>>("{name}");' for kind, name, _, _ in found]
    pathlib.Path(output).write_text("\n".join(lines + ["}", "}  // namespace tightrope_test", ""]))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
