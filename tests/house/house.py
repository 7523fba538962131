#!/usr/bin/env python3
"""The house rules that a compiler does not check: who may include whom, and nothing of one machine in the files.

    house.py ROOT     prints every violation as FILE:LINE: message; exit status 1 if there is one

Includes go one way: runtime <- generated code <- ccd; dsl -> codegen -> text. The runtime needs the standard library
alone, the exact oracle shares no code with the methods that it judges.
"""
import pathlib
import re
import subprocess
import sys

STANDARD = set("""algorithm any array atomic barrier bit bitset charconv chrono codecvt compare complex concepts
condition_variable coroutine deque exception execution filesystem format forward_list fstream functional future
initializer_list iomanip ios iosfwd iostream istream iterator latch limits list locale map memory memory_resource mutex
new numbers numeric optional ostream queue random ranges ratio regex scoped_allocator semaphore set shared_mutex
source_location span sstream stack stdexcept stop_token streambuf string string_view strstream syncstream
system_error thread tuple type_traits typeindex typeinfo unordered_map unordered_set utility valarray variant vector
version cassert cctype cerrno cfenv cfloat cinttypes climits clocale cmath csetjmp csignal cstdarg cstddef cstdint
cstdio cstdlib cstring ctime cuchar cwchar cwctype""".split())
POSIX = r"unistd\.h|sched\.h|signal\.h|spawn\.h|fcntl\.h|sys/\w+\.h"
GENERATED = r"(?:fused/)?[\w-]+\.(?:float|safe|tight|exact)\.(?:double|float)(?:\.simd)?\.h"

# Folder (the longest prefix wins): what its files may include besides the standard library, as patterns of the path in
# the repository or, if the repository has no such file, of the name as it is written.
RUNTIME = r"runtime/tightrope/[\w/-]+\.h"
API = r"ccd/tightrope/\w+\.h"
RULES = {
    "runtime/": [RUNTIME, r"cuda_runtime_api\.h"],
    "dsl/": [r"dsl/.*", r"fmt/.*"],
    "codegen/": [r"codegen/.*", r"dsl/.*", r"fmt/.*", r"CLI/.*", r"nlohmann/.*", r"(?:clang|llvm)/.*", RUNTIME, POSIX],
    "codegen/charts/": [r"codegen/charts/.*", r"fmt/.*", POSIX],
    "ccd/": [r"ccd/(?:methods/|impact/)?[\w.]+", API, r"Eigen/.*", RUNTIME, GENERATED],
    "ccd/batch/": [r"ccd/batch/.*", r"ccd/(?:impact/|methods/)?\w+\.h", API, RUNTIME, GENERATED, r"oneapi/tbb/\w+\.h", r"hwy/\w+\.h"],
    "ccd/gpu/": [r"ccd/gpu/.*", r"ccd/batch/source\.h", r"ccd/(?:impact/|methods/)?\w+\.h", API, RUNTIME, GENERATED,
                 r"cuda_runtime\.h"],
    "ccd/oracle/": [r"ccd/oracle/.*", r"ccd/tightrope/ccd\.h", r"gmp(?:xx)?\.h"],
    "ccd/query_io/": [r"ccd/query_io/.*", API, r"gmp(?:xx)?\.h", r"fmt/.*", r"hdf5\.h", POSIX],
    "ccd/scenes/": [r"ccd/(?:scenes|oracle|query_io)/.*", API, r"gmp(?:xx)?\.h", r"fmt/.*", r"Eigen/.*"],
    "ccd/stability/": [r"ccd/(?:stability|scenes|oracle|impact)/.*", API, r"ccd/query\.h", r"ccd/methods/bsc_exact\.h",
                       r"codegen/charts/.*", r"fmt/.*", r"nlohmann/.*"],
    "ccd/fit/": [r"ccd/fit/.*", API, r"fmt/.*", RUNTIME, r"(?:unit_)?look\.(?:safe|static)\.(?:double|float)\.h"],
    "ccd/command/": [r"ccd/(?:command|scenes|oracle|query_io|stability|fit)/.*", API, r"ccd/query\.h",
                     r"ccd/impact/(?:query|stage)\.h", r"codegen/charts/.*", r"fmt/.*", r"CLI/.*", r"nlohmann/.*", POSIX],
    "ccd/command/mpi.cpp": [r"ccd/command/.*", r"mpi\.h"],
}
INCLUDE_ROOTS = ["", "ccd", "runtime"]
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
MACHINE_PATH = re.compile(r"(?<![\w.}$)~*-])/(?:work|tmp|home|root|Users|mnt|scratch)/")
UNFINISHED = re.compile(r"\b(?:TO" r"DO|FIX" r"ME|XX" r"X)\b")
LLVM = re.compile(r"\bLLVM|\bClang\b|libclang|\bclang-cpp\b|clangTooling")
BINARY = {".png", ".h5", ".hdf5", ".gz"}


def tracked_files(root):
    """Files of the repository, relative to root; without git (a released archive), all that are no build output."""
    try:
        listed = subprocess.run(["git", "-C", root, "ls-files", "-z"], capture_output=True, check=True).stdout
        names = [name for name in listed.decode().split("\0") if name]
        if names:
            return [name for name in names if (root / name).is_file()]
    except (OSError, subprocess.CalledProcessError):
        pass
    skipped = re.compile(r"(?:build[^/]*|demo-output|\.git|\.cache)/")
    paths = (path.relative_to(root).as_posix() for path in root.rglob("*") if path.is_file())
    return sorted(path for path in paths if not skipped.match(path))


def resolved(root, path, quote, name):
    """The included file's path in the repository, or the name as written if the repository has no such file."""
    folders = [root / folder for folder in INCLUDE_ROOTS]
    if quote == '"':
        folders.insert(0, (root / path).parent)
    for folder in folders:
        if (folder / name).is_file():
            return (folder / name).resolve().relative_to(root.resolve()).as_posix()
    return name


def include_violations(root, path, lines):
    folders = [folder for folder in RULES if path.startswith(folder)]
    if not folders:
        return
    folder = max(folders, key=len)
    for number, line in enumerate(lines, 1):
        match = INCLUDE.match(line)
        if not match or match.group(2) in STANDARD:
            continue
        included = resolved(root, path, *match.groups())
        if not any(re.fullmatch(rule, included) for rule in RULES[folder]):
            yield number, f"{folder} may not include {match.group(2)}"


def violations(root):
    """All violations as (file, line, message)."""
    for path in tracked_files(root):
        if pathlib.PurePath(path).suffix in BINARY or path.startswith("tests/data/"):
            continue
        lines = (root / path).read_text(encoding="utf-8", errors="replace").splitlines()
        if re.search(r"\.(?:h|cpp|cu)(?:\.in)?$", path):
            for number, message in include_violations(root, path, lines):
                yield path, number, message
        cmake = path.endswith(("CMakeLists.txt", ".cmake")) and not path.startswith("codegen/")
        for number, line in enumerate(lines, 1):
            if MACHINE_PATH.search(line):
                yield path, number, "a path of one machine"
            if UNFINISHED.search(line):
                yield path, number, "a note of unfinished work"
            if cmake and not line.lstrip().startswith("#") and LLVM.search(line):
                yield path, number, "only codegen/ may use LLVM"
            if path == "ccd/oracle/CMakeLists.txt" and re.search(r"tightrope_ccd\b|tightrope::ccd\b", line):
                yield path, number, "the oracle may not link the methods that it judges"


def main(arguments):
    if len(arguments) != 1:
        print(__doc__, file=sys.stderr)
        return 2
    found = list(violations(pathlib.Path(arguments[0])))
    for path, number, message in found:
        print(f"{path}:{number}: {message}")
    print(f"{len(found)} violations")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
