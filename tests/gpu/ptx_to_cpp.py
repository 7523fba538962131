#!/usr/bin/env python3
"""Turns PTX into C++ that does the same on a processor, a thread a fiber (ptx_machine.h), so that what nvcc makes of the
kernels can be run where there is no GPU.

    ptx_to_cpp.py IN.ptx .. -o OUT.cpp

Knows the instructions that occur in these kernels; any other ends the program with a message. Each instruction becomes
one statement. Fused multiply-adds, approximations and flushing of subnormal numbers are refused: the kernels must have
none.
"""
import re
import sys

CPP = {"f64": "double", "f32": "float", "b8": "std::uint8_t", "pred": "bool"}
for width in (8, 16, 32, 64):
    CPP[f"u{width}"] = CPP[f"b{width}"] = f"std::uint{width}_t"
    CPP[f"s{width}"] = f"std::int{width}_t"
COMPARE = {"eq": "==", "ne": "!=", "lt": "<", "le": "<=", "gt": ">", "ge": ">="}
BINARY = {"add": "+", "sub": "-", "mul": "*", "and": "&", "or": "|", "xor": "^", "div": "/"}
SPECIAL = {"%tid.x": "thread.tid", "%ntid.x": "thread.ntid", "%ctaid.x": "thread.ctaid", "%nctaid.x": "thread.nctaid"}


class Function:
    def __init__(self, name, is_kernel, parameters, body):
        self.name, self.is_kernel, self.parameters, self.body = name, is_kernel, parameters, body
        self.shared = {}

    def operand(self, text):
        """An r-value."""
        text = text.strip()
        if text in SPECIAL:
            return SPECIAL[text]
        if text in ("%SP", "%SPL"):
            return text[1:]
        if text.startswith("%"):
            return self.register(text)
        if re.fullmatch(r"0d[0-9A-Fa-f]{16}", text):
            return f"from_bits<double>(0x{text[2:]}ULL)"
        if re.fullmatch(r"0f[0-9A-Fa-f]{8}", text):
            return f"from_bits<float>(0x{text[2:]}U)"
        if re.fullmatch(r"-?\d+", text):
            return f"static_cast<std::int64_t>({text}LL)" if text != "-9223372036854775808" else "INT64_MIN"
        if text in self.shared:
            return f"std::uint32_t({self.shared[text]})"
        if re.fullmatch(r"[\w$]+", text):
            return f"reinterpret_cast<std::uint64_t>(&{text}[0])"
        raise SystemExit(f"ptx_to_cpp: operand {text}")

    @staticmethod
    def register(text):
        if text in ("%SP", "%SPL"):
            return text[1:]
        found = re.fullmatch(r"%([a-z]+)(\d+)", text.strip())
        if not found:
            raise SystemExit(f"ptx_to_cpp: register {text}")
        return f"{found[1]}[{found[2]}]"

    def address(self, space, text):
        base, _, offset = text.strip("[] ").partition("+")
        offset = int(offset or 0)
        if space == "param":
            return f"&{base}[{offset}]"
        pointer = self.operand(base)
        if space == "shared":
            return f"&thread.shared[{pointer} + {offset}]"
        return f"reinterpret_cast<unsigned char*>({pointer} + {offset})"

    def statement(self, op, arguments):
        parts = op.split(".")
        name, kind = parts[0], parts[-1]
        if name in ("fma", "rcp", "ex2", "lg2", "sin", "cos", "rsqrt", "tanh") or "ftz" in parts or "approx" in parts:
            raise SystemExit(f"ptx_to_cpp: {op} is not to be there")
        if {"hi", "sat", "NaN", "rmi", "rpi", "rni"} & set(parts):
            raise SystemExit(f"ptx_to_cpp: {op}")
        if name in ("ld", "st"):
            return self.memory(name, parts, arguments)
        if name in ("bra", "ret"):
            return f"goto {arguments[0][1:]};" if name == "bra" else "return;"
        if name == "bar" and parts[1:] == ["warp", "sync"]:
            return "thread.wait();"
        if name == "vote":
            return f"{self.register(arguments[0])} = thread.ballot({self.operand(arguments[1])});"
        if name == "shfl" and parts[2] == "idx":
            to, _, found = arguments[0].partition("|")
            return (f"{self.register(to)} = thread.shuffle({self.operand(arguments[1])}, {self.operand(arguments[2])}); "
                    f"{self.register(found)} = true;")
        if name == "atom" and parts[2:] == ["add", "u32"]:
            return (f"{self.register(arguments[0])} = add_to<std::uint32_t>({self.address('global', arguments[1])}, "
                    f"{self.operand(arguments[2])});")
        if name == "mov" and "{" in "".join(arguments):
            return self.packing(arguments)
        to = self.register(arguments[0])
        from_ = [self.operand(x) for x in arguments[1:]]
        if name == "setp":
            return self.comparison(to, parts, from_)
        type_ = CPP.get(kind)
        typed = [f"as<{type_}>({x})" for x in from_]
        if name == "mov" or name == "cvta":
            return f"set({to}, {from_[0]});"
        if name == "cvt":
            return f"set({to}, as<{CPP[parts[-2]]}>(as<{type_}>({from_[0]})));"
        if name == "selp":
            return f"set({to}, {from_[2]} ? {typed[0]} : {typed[1]});"
        if name in ("add", "sub", "mul", "div") and kind in ("f32", "f64"):
            if name in ("mul", "div") and parts[1] != "rn" or len(parts) == 3 and parts[1] != "rn":
                raise SystemExit(f"ptx_to_cpp: the rounding of {op}")
            return f"{to} = {typed[0]} {BINARY[name]} {typed[1]};"
        if name in ("mul", "mad") and parts[1] == "wide":
            wide = CPP[kind[0] + str(2 * int(kind[1:]))]
            return f"set({to}, as<{wide}>({typed[0]}) * as<{wide}>({typed[1]}){' + ' + from_[2] if name == 'mad' else ''});"
        if name == "mad":
            return f"set({to}, as<{type_}>({typed[0]} * {typed[1]} + {typed[2]}));"
        if name in BINARY:
            return f"set({to}, as<{type_}>({typed[0]} {BINARY[name]} {typed[1]}));"
        if name in ("shl", "shr"):
            return f"set({to}, as<{type_}>(shift_{'left' if name == 'shl' else 'right'}({typed[0]}, as<std::uint32_t>({from_[1]}))));"
        if name in ("min", "max"):
            return f"set({to}, {name}imum_of({typed[0]}, {typed[1]}));"
        if name == "not":
            return f"set({to}, as<{type_}>({'!' if kind == 'pred' else '~'}{typed[0]}));"
        if name in ("abs", "neg"):
            return f"set({to}, as<{type_}>({'-' if name == 'neg' else 'absolute'}({typed[0]})));"
        if name == "sqrt" and parts[1] == "rn":
            return f"{to} = std::sqrt({typed[0]});"
        if name in ("popc", "brev", "bfind"):
            return f"{to} = {'_'.join(parts[:-1])}({typed[0]});"
        if name == "prmt" and len(parts) == 2:
            return f"{to} = prmt({', '.join(typed)});"
        raise SystemExit(f"ptx_to_cpp: {op} {', '.join(arguments)}")

    def packing(self, arguments):
        """mov of a register to or from the parts of a vector."""
        to, from_ = arguments
        if from_.startswith("{"):
            parts = [self.operand(x) for x in from_.strip("{} ").split(",")]
            return f"pack({self.register(to)}, {', '.join(parts)});"
        parts = [self.register(x) for x in to.strip("{} ").split(",")]
        return f"unpack({self.operand(from_)}, {', '.join(parts)});"

    @staticmethod
    def comparison(to, parts, from_):
        type_ = CPP[parts[-1]]
        a, b = (f"as<{type_}>({x})" for x in from_)
        relation = parts[1]
        if relation in ("num", "nan"):
            return f"{to} = {'!' if relation == 'num' else ''}is_unordered({a}, {b});"
        unordered = parts[-1] in ("f32", "f64") and len(relation) == 3 and relation.endswith("u")
        if unordered:
            relation = relation[:-1]
        test = f"{a} {COMPARE[relation]} {b}"
        if not unordered and relation == "ne" and parts[-1] in ("f32", "f64"):
            test = f"({test}) && !is_unordered({a}, {b})"
        return f"{to} = {test};" if not unordered else f"{to} = is_unordered({a}, {b}) || {test};"

    def memory(self, name, parts, arguments):
        space = parts[1] if parts[1] in ("local", "global", "shared", "param") else "generic"
        type_ = CPP[parts[-1]]
        place = arguments[0] if name == "st" else arguments[-1]
        registers = ",".join(arguments[1:] if name == "st" else arguments[:-1]).strip("{} ").split(",")
        size = 8 if "double" in type_ else 4 if "float" in type_ else int(re.search(r"\d+", type_)[0]) // 8
        text = []
        for i, register in enumerate(registers):
            at = f"{self.address(space, place)} + {i * size}"
            if name == "ld":
                text.append(f"set({self.register(register.strip())}, load<{type_}>({at}));")
            else:
                text.append(f"store<{type_}>({at}, {self.operand(register)});")
        return " ".join(text)

    def to_cpp(self):
        declarations, code, names = [], [], {}
        body = re.sub(r"//[^\n]*", "", self.body)
        body = re.sub(r"\.pragma[^;]*;", "", body)
        for piece in re.split(r";|(?<=:)\s*\n|(?<=[{}])\s*(?=\n)", body):
            piece = re.sub(r"\b(?:param|retval)\d+\b(?=[+\]),\s]|$)", lambda m: names.get(m[0], m[0]), " ".join(piece.split()))
            label = re.fullmatch(r"\$(L\w+):", piece)
            if not piece or piece in "{}" or piece == ".reg .b32 temp_param_reg":
                continue
            if label:
                code.append(f"{label[1]}:;")
            elif found := re.fullmatch(r"\{? ?\.reg \.(\w+) %(\w+?)<(\d+)>", piece):
                declarations.append(f"  {CPP[found[1]]} {found[2]}[{found[3]}]; scramble({found[2]});")
            elif found := re.fullmatch(r"\.reg \.b64 %(SPL?)", piece):
                declarations.append(f"  std::uint64_t {found[1]} = 0;")
            elif found := re.fullmatch(r"\.local \.align \d+ \.b8 (\w+)\[(\d+)\]", piece):
                declarations.append(f"  alignas(16) unsigned char {found[1]}[{found[2]}]; scramble({found[1]});")
            elif found := re.fullmatch(r"\.shared \.align \d+ \.b8 (\w+)\[(\d+)\]", piece):
                if self.shared:
                    raise SystemExit(f"ptx_to_cpp: a second array in shared memory: {piece}")
                self.shared[found[1]] = 0
                declarations.append(f"  static_assert({found[2]} <= most_shared);")
            elif found := re.fullmatch(r"\{? ?\.param \.[bu]\d+ (\w+)", piece):  # of a call; each call has its own
                names[found[1]] = f"{found[1]}_{len(code)}"
                declarations.append(f"  unsigned char {names[found[1]]}[8];")
            elif found := re.fullmatch(r"call\.uni (?:\((\w+)\), )?(\w+), \( ?([\w, ]*)\)", piece):
                arguments = [a for a in [found[1], *found[3].replace(" ", "").split(",")] if a]
                code.append(f"  {found[2]}(thread, {', '.join(arguments)});")
            else:
                found = re.fullmatch(r"\{? ?(?:@(!?)(%p\d+) )?([\w.]+)(?: (.*))?", piece)
                if not found:
                    raise SystemExit(f"ptx_to_cpp: {piece}")
                arguments = split_arguments(found[4] or "")
                text = self.statement(found[3], arguments)
                if found[2]:
                    text = f"if ({'!' if found[1] else ''}{self.register(found[2])}) {{ {text} }}"
                code.append("  " + text)
        return "\n".join([self.head() + " {", *declarations, *code, "}"])

    def head(self):
        parameters = "".join(f", unsigned char* {p}" for p in self.parameters)
        return f"static void {self.name}([[maybe_unused]] Thread& thread{parameters})"


def split_arguments(text):
    """By commas outside of braces and brackets."""
    return [x.strip() for x in re.findall(r"(?:\{[^}]*\}|\[[^\]]*\]|[^,])+", text)]


def functions_of(text):
    pattern = re.compile(r"^(?:\.visible |\.weak )?\.(entry|func)(?:\s*\(\.param \.\w+ (\w+)\))?\s+(\w+)\(\n?(.*?)\)(.*?)^\{\n(.*?)^\}",
                         re.S | re.M)
    for found in pattern.finditer(text):
        parameters = re.findall(r"\.param (?:\.align \d+ )?\.\w+ (\w+)", found[4])
        yield Function(found[3], found[1] == "entry", ([found[2]] if found[2] else []) + parameters, found[6])


def translation(paths):
    """The text of the C++ file."""
    heads, kernels, bodies, seen = [], [], [], set()
    for path in paths:
        with open(path, encoding="ascii") as file:
            text = file.read()
        if not re.search(r"^\.version", text, re.M):
            raise SystemExit(f"ptx_to_cpp: {path} is no PTX")
        for name, size, values in re.findall(
                r"^\.(?:visible |weak )?(?:global|const) \.align \d+ \.b8 (\w+)\[(\d+)\](?: = \{([^}]*)\})?", text, re.M):
            bodies.append(f"#ifndef HAVE_{name}\n#define HAVE_{name}\n"
                          f"alignas(16) unsigned char {name}[{size}] = {{{values}}};\n#endif")
        for function in functions_of(text):
            if function.name in seen:  # a template that several files instantiate
                continue
            seen.add(function.name)
            heads.append(function.head() + ";")
            bodies.append(function.to_cpp())
            if function.is_kernel:
                kernels.append(f'      {{"{function.name}", {function.name}}},')
    return "\n".join(['// Made by ptx_to_cpp.py.\n#include "tests/gpu/ptx_machine.h"\n\nnamespace tightrope::ptx {\nnamespace {',
                      *heads, *bodies,
                      "}  // namespace\n\nconst std::vector<Kernel>& kernels() {\n  static const std::vector<Kernel> all{",
                      *kernels, "  };\n  return all;\n}\n}  // namespace tightrope::ptx\n"])


def main():
    if len(sys.argv) < 4 or sys.argv[-2] != "-o":
        raise SystemExit("usage: ptx_to_cpp.py IN.ptx .. -o OUT.cpp")
    text = translation(sys.argv[1:-2])
    with open(sys.argv[-1], "w", encoding="ascii") as file:
        file.write(text)


if __name__ == "__main__":
    main()
