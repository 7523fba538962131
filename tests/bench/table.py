#!/usr/bin/env python3
"""Makes one table in Markdown of what batch_bench and its neighbours measured.

    table.py [--operations REPORT.json..] [--others BENCH.json..] -- [BATCH_BENCH.json]

REPORT.json: `tightrope report --format json` of the predicates that first stages are made of (FIRST_STAGES); without
them the arithmetic is not counted and the limit of a query is that of its memory. BENCH.json: what other programs
wrote, told as they are. All figures are medians of the repetitions; ratios are of this one run. Exit status: 0 done, 1 a
benchmark failed, 2 something that cannot be read.
"""
import argparse
import json
import re
import statistics
import sys

# The generated code of each method's first stage, which nearly all queries of a cloth end at: predicates for
# vertex-face and edge-edge, bound, stage.
COPLANARITY = {"vertex-face": "vertex_face", "edge-edge": "edge_edge"}
PLANE = {"vertex-face": "plane_of_face", "edge-edge": "plane_of_edges"}
FIRST_STAGES = {
    "bsc-float": (COPLANARITY, "float", "coplanarity"),
    "bsc-safe": (COPLANARITY, "safe", "coplanarity"),
    "tight": (COPLANARITY, "safe", "coplanarity"),
    "bsc-exact": (COPLANARITY, "safe", "coplanarity"),
    "safe": (COPLANARITY, "safe", "coplanarity"),
    "safe-tight": (COPLANARITY, "safe", "coplanarity"),
    "tightrope": (PLANE, "safe", "evaluate"),
}
# Nanoseconds a query of the published scalar code, on a cloth-like set and this kind of machine: not of this run.
PUBLISHED = {"TightCCD": 140, "SafeCCD": 165}
NANOSECONDS = {"ns": 1, "us": 1e3, "ms": 1e6, "s": 1e9}
DASH = "-"


class Malformed(Exception):
    """Input that is not what it should be; the text says which and why."""


class Failed(Exception):
    """A benchmark that reported an error of its own."""


def load(path):
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except OSError as error:
        raise Malformed(f"{path}: {error.strerror}") from error
    except ValueError as error:  # JSON's errors and those of UTF-8
        raise Malformed(f"{path}: not JSON: {error}") from error


def member(path, table, key, kind, where):
    """table[key], which must be of this kind (a type or several)."""
    if not isinstance(table, dict) or key not in table:
        raise Malformed(f"{path}: {where} has no \"{key}\"")
    value = table[key]
    if not isinstance(value, kind) or isinstance(value, bool):
        raise Malformed(f"{path}: {where}: \"{key}\" is {json.dumps(value)}")
    return value


class Measurement:
    """All repetitions of one benchmark."""

    def __init__(self):
        self.times, self.cpu_times, self.counters, self.place = [], [], {}, (0, 0)

    @staticmethod
    def is_single_threaded(name):
        return not name.endswith("/real_time")

    def nanoseconds(self, name):
        """A call: processor time of what runs on one thread, else time on the clock."""
        return statistics.median(self.cpu_times if self.is_single_threaded(name) else self.times)


def read_benchmarks(path):
    """The context and, by name, the measurements of one file of Google Benchmark's."""
    report = load(path)
    context = member(path, report, "context", dict, "the file")
    measured = {}
    for run in member(path, report, "benchmarks", list, "the file"):
        if not isinstance(run, dict):
            raise Malformed(f"{path}: {json.dumps(run)} is no benchmark")
        name = member(path, run, "run_name" if "run_name" in run else "name", str, "a benchmark")
        if run.get("error_occurred"):
            raise Failed(f"{name}: {run.get('error_message', 'failed')}")
        # Either the repetitions or, without them, the median that Google Benchmark took.
        if run.get("run_type") == "aggregate" and run.get("aggregate_name") != "median":
            continue
        unit = NANOSECONDS.get(member(path, run, "time_unit", str, name))
        if unit is None:
            raise Malformed(f"{path}: {name}: unknown unit of time")
        measurement = measured.setdefault(name, Measurement())
        if run.get("run_type") == "aggregate" and measurement.times:
            continue
        for key, times in (("real_time", measurement.times), ("cpu_time", measurement.cpu_times)):
            time = member(path, run, key, (int, float), name) * unit
            if not 0 < time < float("inf"):
                raise Malformed(f"{path}: {name}: \"{key}\" is {time}")
            times.append(time)
        for key, value in run.items():
            if isinstance(value, (int, float)):
                measurement.counters.setdefault(key, []).append(value)
        measurement.place = tuple(member(path, {key: 0, **run}, key, int, name)
                                  for key in ("family_index", "per_family_instance_index"))
    # As they were registered: random interleaving shuffles them.
    return context, dict(sorted(measured.items(), key=lambda item: item[1].place))


def counter(path, name, measurement, key):
    value = statistics.median(member(path, measurement.counters, key, list, name))
    if not 0 < value < float("inf"):
        raise Malformed(f"{path}: {name}: \"{key}\" is {value}")
    return value


def read_operations(paths):
    """Operations of every stage, those for the values and for the bounds: {(predicate, bound, real, stage): number}."""
    operations = {}
    for path in paths:
        predicates = load(path)
        if not isinstance(predicates, list):
            raise Malformed(f"{path}: no list of predicates")
        for predicate in predicates:
            name, bound, real = (member(path, predicate, key, str, "a predicate") for key in ("predicate", "bound", "real"))
            for stage in member(path, predicate, "stages", list, name):
                counts = [member(path, member(path, stage, f"{part}_operations", dict, name), "total", int, name)
                          for part in ("value", "bound")]
                operations[name, bound, real, member(path, stage, "name", str, name)] = sum(counts)
    return operations


def caches(context):
    """Level and bytes of each cache that holds data."""
    listed = context.get("caches")
    return [(cache["level"], cache["size"]) for cache in (listed if isinstance(listed, list) else [])
            if isinstance(cache, dict) and cache.get("type") in ("Data", "Unified")
            and isinstance(cache.get("level"), int) and isinstance(cache.get("size"), int)]


class Limits:
    """What the machine can do at most, measured in the same run."""

    def __init__(self, path, context, measured):
        self.bytes, self.operations, self.fused = {}, {}, {}  # a nanosecond
        self.largest_cache = max((size for _, size in caches(context)), default=0)
        rates = {"arithmetic": self.operations, "fused": self.fused}
        for name, measurement in measured.items():
            if match := re.match(r"limit/read/(\w+)/threads:(\d+)", name):
                work = counter(path, name, measurement, "bytes")
                self.bytes[match[1], int(match[2])] = work / measurement.nanoseconds(name)
            elif match := re.match(r"limit/(arithmetic|fused)/(\w+)/(\w+)/threads:(\d+)", name):
                work = counter(path, name, measurement, "operations")
                rates[match[1]][match[2], match[3], int(match[4])] = work / measurement.nanoseconds(name)

    def nearer(self, batch, operations):
        """The least nanoseconds that one query can take, and why; none where nothing was measured."""
        times = []
        # Whatever reads fastest: memory does not know who asks.
        memory = max((rate for (_, threads), rate in self.bytes.items() if threads == batch.threads), default=None)
        if memory and batch.queries * batch.bytes_per_query > self.largest_cache:
            times.append((batch.bytes_per_query / memory, "memory"))
        rates = self.fused if batch.is_fused() else self.operations
        rate = rates.get((batch.real, batch.instructions, batch.threads))
        predicates, bound, stage = FIRST_STAGES.get(batch.method, ({}, "", ""))
        count = operations.get((predicates.get(batch.kind), bound, batch.real, stage))
        if rate and count:
            times.append((count / rate, "arithmetic"))
        return max(times, default=(None, None))


class Batch:
    """One benchmark of a batch: what its name tells, and nanoseconds a query."""

    NAME = re.compile(r"batch/(?P<source>[\w-]+)/(?P<kind>[\w-]+)/(?P<real>\w+)/(?P<layout>[\w-]+)/(?P<results>\w+)"
                      r"/(?P<method>[\w-]+)/(?P<instructions>\w+)(?P<fused>/fused)?/threads:(?P<threads>\d+)(?:/each:(?P<each>\d+))?")

    def __init__(self, path, name, measurement):
        match = self.NAME.match(name)
        if match is None:
            raise Malformed(f"{path}: {name}: not a batch's name")
        for key, value in match.groupdict().items():
            setattr(self, key, value)
        self.queries = counter(path, name, measurement, "queries")
        self.threads, self.each = int(self.threads), int(self.each or self.queries)
        self.bytes_per_query = counter(path, name, measurement, "bytes_per_query")
        self.ns = measurement.nanoseconds(name) / self.queries

    def is_fused(self):
        return bool(self.fused)

    def code(self):
        """Instruction set, and whether products and sums are fused."""
        return f"{self.instructions} fused" if self.is_fused() else self.instructions

    def is_plain(self):
        """The whole set in one call, by query, bytes wanted, one thread."""
        return self.layout == "by-query" and self.results == "bytes" and self.threads == 1 and self.each == self.queries


def number(x):
    """Three digits."""
    if x is None:
        return DASH
    if x >= 1000:
        return f"{x:,.0f}"
    return f"{x:.3g}" if x >= 100 else f"{x:.1f}" if x >= 10 else f"{x:.2f}"


def ratio(x, y):
    """Two digits after the point; below a tenth, two that count."""
    if x is None or y is None:
        return DASH
    return f"{x / y:.2f}" if x / y >= 0.1 else f"{x / y:.2g}"


def markdown(headings, rows):
    lines = [headings, ["---"] * len(headings), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines) + "\n"


def limits_table(limits):
    rows = []
    for set_, threads in dict.fromkeys([*limits.bytes, *(key[1:] for key in limits.operations)]):
        memory = limits.bytes.get((set_, threads))
        row = [set_, threads, number(memory)]
        row += [number(size / memory if memory else None) for size in (192, 96)]
        row += [number(rates.get((real, set_, threads)))
                for rates in (limits.operations, limits.fused) for real in ("double", "float")]
        rows.append(row)
    return markdown(["instructions", "threads", "memory, GB/s", "192 bytes, ns", "96 bytes, ns", "double, Gop/s",
                     "float, Gop/s", "fused double, Gop/s", "fused float, Gop/s"], rows)


class Table:
    """Sections of the batches of one run."""

    def __init__(self, batches, limits, operations):
        self.batches, self.limits, self.operations = batches, limits, operations

    def limit_cells(self, batch):
        limit, why = self.limits.nearer(batch, self.operations)
        return [f"{number(limit)} {why}" if limit else DASH, ratio(limit, batch.ns)]

    def scalar(self, batch, method):
        """The same queries decided one after another by `method`, in this run."""
        for other in self.batches:
            if (other.is_plain() and other.instructions == "scalar" and other.method == method
                    and (other.source, other.kind, other.real) == (batch.source, batch.kind, batch.real)):
                return other.ns
        return None

    def plain(self, batch):
        """The same method and instructions on the same queries in one call, by query, bytes wanted, one thread."""
        for other in self.batches:
            if other.is_plain() and all(getattr(other, key) == getattr(batch, key)
                                        for key in ("source", "kind", "real", "method", "instructions", "fused")):
                return other.ns
        return None

    def methods(self):
        rows = []
        for batch in self.batches:
            if batch.source != "cloth-fold" or not batch.is_plain():
                continue
            rows.append([batch.method, batch.kind, batch.real, batch.code(), number(batch.ns),
                         number(1e3 / batch.ns), *self.limit_cells(batch), ratio(self.scalar(batch, "tight"), batch.ns),
                         *(ratio(ns, batch.ns) for ns in PUBLISHED.values())])
        return markdown(["method", "kind", "precision", "instructions", "ns a query", "million queries/s",
                         "limit, ns", "of the limit", "times `tight` scalar",
                         *(f"times {name} ({ns} ns)" for name, ns in PUBLISHED.items())], rows) if rows else ""

    def shapes(self):
        rows = []
        for batch in self.batches:
            if batch.source != "cloth-fold" or batch.is_plain():
                continue
            rows.append([batch.method, batch.kind, batch.code(), batch.layout, batch.results,
                         f"{batch.each:,}", batch.threads, number(batch.ns), *self.limit_cells(batch),
                         ratio(self.plain(batch), batch.ns)])
        return markdown(["method", "kind", "instructions", "layout", "results", "queries a call", "threads", "ns a query",
                         "limit, ns", "of the limit", "times the table above"], rows) if rows else ""

    def others(self):
        rows = []
        for batch in self.batches:
            if batch.source == "cloth-fold":
                continue
            rows.append([batch.source, batch.method, batch.kind, batch.code(), f"{batch.queries:,.0f}",
                         number(batch.ns), *self.limit_cells(batch), ratio(self.scalar(batch, batch.method), batch.ns)])
        return markdown(["queries", "method", "kind", "instructions", "number", "ns a query", "limit, ns", "of the limit",
                         "times scalar"], rows) if rows else ""


def machine(context, repetitions):
    date = str(context.get("date", "unknown"))[:10]
    facts = [f"{context.get('processor', 'unknown processor')}, {context.get('num_cpus', '?')} processors"]
    sizes = [f"L{level} {size // 1024:,} KiB" for level, size in caches(context)]
    if sizes:
        facts.append("caches " + ", ".join(sizes))
    facts.append(str(context.get("compiler", "unknown compiler")))
    load = context.get("load_avg")
    if isinstance(load, list) and load and isinstance(load[0], (int, float)):
        facts.append(f"load average {load[0]:.2f} at the start")
    runs = f"Medians of {repetitions}" if repetitions > 1 else "One repetition"
    return f"{date}. {'; '.join(facts)}. {runs}.\n"


def batch_sections(path, operations):
    context, measured = read_benchmarks(path)
    limits = Limits(path, context, measured)
    batches = [Batch(path, name, m) for name, m in measured.items() if name.startswith("batch/")]
    repetitions = max((len(m.times) for m in measured.values()), default=0)
    if repetitions == 1:  # or it is the median that was written
        repetitions = max((int(m.counters.get("repetitions", [1])[0]) for m in measured.values()), default=1)
    table = Table(batches, limits, operations)
    sections = [("Limits", limits_table(limits) if limits.bytes or limits.operations else ""),
                ("Methods: cloth-fold, by query, one thread", table.methods()),
                ("Layouts, results, queries a call, threads: cloth-fold, double precision", table.shapes()),
                ("Other queries, double precision, one thread", table.others())]
    text = "# Benchmarks\n\n" + machine(context, repetitions)
    return text + "".join(f"\n## {title}\n\n{body}" for title, body in sections if body)


def other_section(path):
    _, measured = read_benchmarks(path)
    rows = []
    for name, measurement in measured.items():
        if "per_query" in measurement.counters:
            ns = 1e9 * counter(path, name, measurement, "per_query")
        elif "ns_per_call" in measurement.counters:
            ns = counter(path, name, measurement, "ns_per_call")
        else:
            ns = measurement.nanoseconds(name)
        rows.append([name, number(ns)])
    title = re.sub(r".*/|\.json$", "", path)
    return f"\n## {title}\n\n" + markdown(["what", "ns each"], rows) if rows else ""


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--operations", nargs="*", default=[], metavar="REPORT.json")
    parser.add_argument("--others", nargs="*", default=[], metavar="BENCH.json")
    parser.add_argument("batch", nargs="?", metavar="BATCH_BENCH.json")
    options = parser.parse_args(arguments)
    try:
        text = batch_sections(options.batch, read_operations(options.operations)) if options.batch else ""
        text += "".join(other_section(path) for path in options.others)
    except Malformed as error:
        print(f"table.py: {error}", file=sys.stderr)
        return 2
    except Failed as error:
        print(f"table.py: a benchmark failed: {error}", file=sys.stderr)
        return 1
    print(text, end="")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
