#!/usr/bin/env python3
"""The diagnostics, each shown by a program that earns it.

A case is NAME.pred with NAME.expected, the exact standard error of `tightrope check NAME.pred` run in this folder; the
exit status must be 1 and standard output empty. Files that cases import lie in imported/.

    run.py cases --tightrope COMMAND [--update] [NAME...]   runs the cases; --update renews the expected texts (read them!)
    run.py coverage --sources FOLDER                        every message in the sources' string literals has a case
    run.py self-test                                        shows that the two above can fail
"""

import argparse
import difflib
import pathlib
import re
import subprocess
import sys
import tempfile

FOLDER = pathlib.Path(__file__).resolve().parent
EXEMPT = FOLDER / "no_case.txt"
SECONDS_PER_CASE = 60


def run_case(tightrope, pred, update):
    """A text that says what is wrong, or None."""
    expected_path = pred.with_suffix(".expected")
    done = subprocess.run([tightrope, "check", pred.name], cwd=pred.parent, capture_output=True,
                          timeout=SECONDS_PER_CASE, check=False)
    actual = done.stderr.decode("utf-8", errors="replace")
    if done.returncode != 1:
        return f"exit status {done.returncode}, not 1\n{actual}"
    if done.stdout:
        return f"standard output is not empty: {done.stdout!r}"
    if update:
        expected_path.write_text(actual, encoding="utf-8", newline="")
        return None
    if not expected_path.exists():
        return f"{expected_path.name} is missing; make it with --update and read it"
    expected = expected_path.read_bytes().decode("utf-8")
    if actual == expected:
        return None
    return "".join(difflib.unified_diff(expected.splitlines(True), actual.splitlines(True), "expected", "actual"))


def run_cases(folder, tightrope, names, update):
    preds = sorted(folder.glob("*.pred"))
    failures = 0
    for orphan in sorted(folder.glob("*.expected")):
        if not orphan.with_suffix(".pred").exists():
            print(f"FAILED {orphan.name}: there is no {orphan.stem}.pred")
            failures += 1
    if names:
        preds = [pred for pred in preds if pred.stem in names]
    if not preds:
        print("FAILED: there are no cases")
        failures += 1
    for pred in preds:
        problem = run_case(tightrope, pred, update)
        if problem is not None:
            print(f"FAILED {pred.stem}\n{problem}")
            failures += 1
    print(f"{len(preds)} cases, {failures} failed")
    return failures == 0


TOKEN = re.compile(r'//[^\n]*|/\*.*?\*/|^[ \t]*#[^\n]*|\bassert\(.*?\);|\'(?:\\.|[^\'\\\n])+\''
                   r'|"(?:\\.|[^"\\\n])*"(?:\s*"(?:\\.|[^"\\\n])*")*', re.DOTALL | re.MULTILINE)
ESCAPES = {"\\n": "\n", "\\t": "\t", '\\"': '"', "\\\\": "\\"}


def literals(text):
    """(line, value) of every string literal, neighbours joined; comments, directives and assertions left out."""
    for match in TOKEN.finditer(text):
        if not match.group().startswith('"'):
            continue
        pieces = re.findall(r'"((?:\\.|[^"\\\n])*)"', match.group())
        value = re.sub(r'\\[nt"\\]', lambda escape: ESCAPES[escape.group()], "".join(pieces))
        yield text.count("\n", 0, match.start()) + 1, value


def is_message(value):
    """Two words of a sentence, wherever they stand: what a user may get to read."""
    prose = re.sub(r"\{[^}]*\}", " ", value)
    return re.search(r"[A-Za-z]{2,}[`',;:]* +[`(]*[A-Za-z]+|^ ?[a-z]+ | [a-z]+ ?$", prose) is not None


def pattern_of(value):
    """Matches the message with anything in its {} places."""
    value = value.replace("{{", "\0").replace("}}", "\1")
    fragments = re.split(r"\{[^}]*\}", value)
    return re.compile(".*".join(re.escape(f.replace("\0", "{").replace("\1", "}")) for f in fragments))


def exempt_literals(path):
    """Lines `literal # why`; lines that begin with `#` are comments."""
    exempt = {}
    for line in path.read_text(encoding="utf-8").splitlines():
        if not line.strip() or line.startswith("#"):
            continue
        literal, separator, why = line.rpartition(" # ")
        if not separator or not why.strip():
            raise SystemExit(f"{path.name}: no reason given: {line}")
        exempt[literal] = why
    return exempt


def check_coverage(cases, sources, exempt):
    shown = "\n".join(path.read_bytes().decode("utf-8") for path in sorted(cases.glob("*.expected")))
    missing, used, count = [], set(), 0
    for source in sorted(sources.glob("*.cpp")) + sorted(sources.glob("*.h")):
        for line, value in literals(source.read_text(encoding="utf-8")):
            if not is_message(value):
                continue
            count += 1
            if value in exempt:
                used.add(value)
            elif not pattern_of(value).search(shown):
                missing.append(f'{source.name}:{line}: no case shows "{value}"')
    missing += [f"{EXEMPT.name}: no such message any more: {literal}" for literal in exempt if literal not in used]
    for problem in missing:
        print(f"FAILED {problem}")
    print(f"{count} messages, {len(missing)} failed")
    return count > 0 and not missing


def self_test():
    """Planted faults: each of them must make a check fail, and without them all must pass."""
    faults = []

    def expect(outcome, wanted, what):
        if outcome != wanted:
            faults.append(what)

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        command = folder / "tightrope"
        command.write_text('#!/bin/sh\ncat "$2" >&2\nexit 1\n', encoding="utf-8")
        command.chmod(0o755)
        (folder / "a.pred").write_text("cannot add a vector and a scalar\n", encoding="utf-8")
        (folder / "a.expected").write_text("cannot add a vector and a scalar\n", encoding="utf-8")
        expect(run_cases(folder, command, [], False), True, "a right case passes")
        (folder / "b.pred").write_text("b\n", encoding="utf-8")
        expect(run_cases(folder, command, [], False), False, "a case without expected text fails")
        (folder / "b.expected").write_text("B\n", encoding="utf-8")
        expect(run_cases(folder, command, [], False), False, "a case with other text fails")
        expect(run_cases(folder, command, ["b"], True), True, "--update takes the text")
        expect((folder / "b.expected").read_text(encoding="utf-8"), "b\n", "--update writes the text")
        (folder / "c.expected").write_text("c\n", encoding="utf-8")
        expect(run_cases(folder, command, [], False), False, "expected text without a program fails")
        (folder / "c.expected").unlink()
        command.write_text('#!/bin/sh\ncat "$2" >&2\nexit 0\n', encoding="utf-8")
        expect(run_cases(folder, command, [], False), False, "another exit status fails")
        command.write_text('#!/bin/sh\necho x; cat "$2" >&2\nexit 1\n', encoding="utf-8")
        expect(run_cases(folder, command, [], False), False, "text on standard output fails")

        source = folder / "x.cpp"
        source.write_text('// "no message here"\nerror(f("cannot add a {} "\n  "and a {}", k));', encoding="utf-8")
        expect(check_coverage(folder, folder, {}), True, "a message with a case passes")
        expect(check_coverage(folder, folder, {"gone for ever": "why"}), False, "an exemption of nothing fails")
        source.write_text('error("cannot multiply a vector");', encoding="utf-8")
        expect(check_coverage(folder, folder, {}), False, "a message without a case fails")
        expect(check_coverage(folder, folder, {"cannot multiply a vector": "why"}), True, "an exempt message passes")
        source.write_text('error("cannot subtract " + kind);', encoding="utf-8")
        expect(check_coverage(folder, folder, {}), False, "a piece of a message without a case fails")
    for fault in faults:
        print(f"FAILED self-test: {fault}")
    print(f"self-test: {len(faults)} failed")
    return not faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    cases = commands.add_parser("cases")
    cases.add_argument("--tightrope", type=pathlib.Path, required=True)
    cases.add_argument("--update", action="store_true")
    cases.add_argument("names", nargs="*")
    coverage = commands.add_parser("coverage")
    coverage.add_argument("--sources", type=pathlib.Path, required=True)
    commands.add_parser("self-test")
    arguments = parser.parse_args()
    if arguments.command == "cases":
        good = run_cases(FOLDER, arguments.tightrope.resolve(), arguments.names, arguments.update)
    elif arguments.command == "coverage":
        good = check_coverage(FOLDER, arguments.sources, exempt_literals(EXEMPT))
    else:
        good = self_test()
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
