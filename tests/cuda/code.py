#!/usr/bin/env python3
"""Reads the device code that nvcc makes of generated kernels: is the arithmetic what was analysed?

    code.py --nvcc NVCC --runtime FOLDER --output FOLDER [--architectures 75,90] [--fma] [--weaken] [--flags ..]
            [--must-find TEXT] [--folder FOLDER] [--without PREFIX] [FILE.cu ..]

All files (of FOLDER, but those whose names start with PREFIX) are compiled together, to PTX for the first architecture
and from that to machine code for the last one; with `all`, to both for every architecture from 75 on that nvcc knows.
In PTX every instruction on numbers must be on the list below: no fused multiply-add (with --fma: there must be some),
no product that could still be fused, nothing approximate, nothing that flushes subnormal numbers. In machine code there
must be none either, but in kernels that divide or take roots, where it is how that is done.

--weaken   writes products as a plain `*`, which nvcc may fuse
--must-find TEXT   turns the verdict around: one of the findings must hold this text
"""
import argparse
import collections
import pathlib
import re
import struct
import subprocess
import sys

from weaken import weaken

# Adding, dividing and so on without a rounding rounds to nearest; a product without one may be fused.
ALLOWED = re.compile(r"(?:(?:add|sub)(?:\.rn)?|(?:mul|div|rcp|sqrt)\.rn|neg|abs|setp\.\w+(?:\.\w+)?|selp|mov(?:\.b\d+)?|"
                     r"(?:ld|st)(?:\.\w+)+|testp\.\w+)\.f(?:32|64)")
# Passes over a NaN, so only where one of the two is a number for sure.
WITH_CONSTANT = re.compile(r"(?:min|max)\.f(?:32|64)\s.*\b0[df][0-9A-F]{8,16};")
FUSED = re.compile(r"fma\.rn\.f(?:32|64)")
SASS_FUSED = {0x23: "FFMA", 0x2B: "DFMA"}  # bits 0 .. 8 of an instruction of 16 bytes, sm_70 and later
SASS_PRODUCTS = {0x20: "FMUL", 0x28: "DMUL"}

Kernel = collections.namedtuple("Kernel", "name instructions")


def kernels_of(ptx):
    """Entries (and functions, if something was not inlined) with their instructions."""
    for match in re.finditer(r"^\.?(?:visible |weak )*\.(?:entry|func)[^{;]*?(\w+)\([^{;]*\{(.*?)^\}", ptx, re.M | re.S):
        lines = (re.sub(r"^@!?%p\d+\s+", "", line.strip()) for line in match.group(2).splitlines())
        yield Kernel(match.group(1), [line for line in lines if re.match(r"[a-zA-Z_]\S*\s*[^:]*;", line)])


def findings_in_ptx(kernel, fma):
    for line in kernel.instructions:
        operation = line.split()[0].rstrip(";")
        if line.startswith("Tightrope_"):
            yield f"{kernel.name}: {line}"
        if not re.search(r"\.f(?:16|32|64)\b", operation):
            continue
        allowed = ALLOWED.fullmatch(operation) or WITH_CONSTANT.fullmatch(line) or fma and FUSED.fullmatch(operation)
        if not allowed:
            yield f"{kernel.name}: {line}"


def machine_code(cubin):
    """The kernels of an ELF file: name and instructions as numbers."""
    data = cubin.read_bytes()
    offset, = struct.unpack_from("<Q", data, 0x28)
    size, count, names = struct.unpack_from("<HHH", data, 0x3A)
    sections = [struct.unpack_from("<IIQQQQIIQQ", data, offset + i * size) for i in range(count)]
    for section in sections:
        start = sections[names][4] + section[0]
        name = data[start:data.index(b"\0", start)].decode()
        if name.startswith(".text."):
            places = range(section[4], section[4] + section[5], 16)
            yield name.removeprefix(".text."), [struct.unpack_from("<Q", data, place)[0] & 0x1FF for place in places]


def findings_in_machine_code(cubin, with_divisions, fma):
    products = fused = 0
    for name, operations in machine_code(cubin):
        products += sum(operation in SASS_PRODUCTS for operation in operations)
        found = [SASS_FUSED[operation] for operation in operations if operation in SASS_FUSED]
        fused += len(found)
        if found and not fma and name not in with_divisions:
            yield f"{cubin.name}: {name}: {len(found)} {found[0]}"
    print(f"{cubin.name}: {products} products, {fused} fused multiply-adds (those of divisions and roots included)")
    if not products or fma and not fused:  # then this is not how to read it
        yield f"{cubin.name}: no products, or nothing fused where it should be"


def missing_in_ptx(ptx, kernels, fma):
    """What must be there, if this is the way to read it."""
    text = " ".join(line.split()[0] for kernel in kernels for line in kernel.instructions)
    counts = {name: len(re.findall(name + r"\S*\.f(?:32|64)\b", text)) for name in ("add", "sub", "mul", "div", "fma")}
    print(f"{ptx.name}: {len(kernels)} kernels,", ", ".join(f"{count} {name}" for name, count in counts.items()))
    entries = ptx.read_text().count(".entry")
    if not entries or len(kernels) < entries or not counts["mul"] or fma and not counts["fma"]:
        yield f"{ptx.name}: {entries} entries, {len(kernels)} read; products or fused operations are missing"


def run(*command):
    made = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if made.returncode:
        sys.exit(f"{' '.join(map(str, command))}\n{made.stdout}{made.stderr}")
    return made.stdout


def findings(options):
    output = pathlib.Path(options.output)
    output.mkdir(parents=True, exist_ok=True)
    runtime = pathlib.Path(options.runtime)
    if options.weaken:
        weaken(runtime, output / "weakened")
        runtime = output / "weakened"
    everything = output / "kernels.cu"
    everything.write_text("".join(f'#include "{pathlib.Path(file).resolve()}"\n' for file in options.files))
    known = [number for number in re.findall(r"compute_(\d+)", run(options.nvcc, "--list-gpu-arch")) if int(number) >= 75]
    wanted = known if options.architectures == "all" else options.architectures.split(",")
    nvcc = [options.nvcc, "-std=c++17", f"-I{runtime}", "-Werror=all-warnings", *options.flags.split(), everything]

    for architecture in wanted if options.architectures == "all" else wanted[:1]:
        ptx = output / f"kernels.{architecture}.ptx"
        run(*nvcc, "-ptx", f"-arch=compute_{architecture}", "-o", ptx)
        kernels = list(kernels_of(ptx.read_text()))
        for kernel in kernels:
            yield from findings_in_ptx(kernel, options.fma)
        yield from missing_in_ptx(ptx, kernels, options.fma)
        if options.ptx_only:
            continue
        cubin = output / f"kernels.{architecture}.cubin"
        machine = architecture if options.architectures == "all" else wanted[-1]
        run(options.nvcc, "-cubin", f"-arch=sm_{machine}", ptx, "-o", cubin)
        divide = {kernel.name for kernel in kernels if re.search(r"\b(?:div|sqrt|rcp)\.rn", " ".join(kernel.instructions))}
        yield from findings_in_machine_code(cubin, divide, options.fma)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("nvcc", "runtime", "output"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("--architectures", default="75")
    parser.add_argument("--flags", default="")
    parser.add_argument("--must-find")
    parser.add_argument("--folder")
    parser.add_argument("--without")
    for name in ("fma", "weaken", "ptx-only"):
        parser.add_argument(f"--{name}", action="store_true")
    parser.add_argument("files", nargs="*")
    options = parser.parse_args()
    if options.folder:
        files = sorted(pathlib.Path(options.folder).glob("*.cu"))
        options.files += [file for file in files if not (options.without and file.name.startswith(options.without))]
    found = list(findings(options))
    for finding in found[:5]:
        print(finding)
    print(f"{len(found)} findings")
    if options.must_find:
        return 0 if any(options.must_find in finding for finding in found) else 1
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
