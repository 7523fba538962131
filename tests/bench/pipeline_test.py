#!/usr/bin/env python3
"""From the programs to the table, on few queries: what batch_bench writes is what table.py reads, every method's first
stage is one that the compiler reports, and every batch has the answers of its queries one by one.

    pipeline_test.py --batch-bench PROGRAM --tightrope PROGRAM --predicates FOLDER
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import table


def run(*command, **options):
    return subprocess.run([str(word) for word in command], check=True, **options)


def report(options, folder):
    """The compiler's counts of the predicates of the first stages, as ./bench asks for them."""
    paths = []
    for predicate in ("vertex_face", "edge_edge", "separating_plane"):
        path = folder / f"{predicate}.json"
        with open(path, "w", encoding="utf-8") as file:
            run(options.tightrope, "report", options.predicates / f"{predicate}.pred", "--bound", "float,safe", "--real",
                "double,float", "--format", "json", stdout=file)
        paths.append(path)
    return paths


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--batch-bench", required=True)
    parser.add_argument("--tightrope", required=True)
    parser.add_argument("--predicates", required=True, type=pathlib.Path)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        written = folder / "batch_bench.json"
        run(options.batch_bench, "--queries=2000", "--benchmark_filter=limit/(arithmetic|fused)|batch/(cloth-fold|grazing)",
            "--benchmark_min_time=0.001", f"--benchmark_out={written}", "--benchmark_out_format=json",
            stdout=subprocess.DEVNULL)
        reports = report(options, folder)
        operations = table.read_operations(reports)
        context, measured = table.read_benchmarks(written)
        limits = table.Limits(written, context, measured)
        batches = [table.Batch(written, what, m) for what, m in measured.items() if what.startswith("batch/")]
        assert {batch.method for batch in batches} == set(table.FIRST_STAGES), "methods that batches have"
        assert {batch.results for batch in batches} == {"bytes", "bits", "times"}
        assert {batch.layout for batch in batches} == {"by-query", "by-coordinate", "mesh"}
        assert any(batch.each == 10 for batch in batches) and any(batch.real == "float" for batch in batches)
        assert {batch.method for batch in batches if batch.is_fused()} <= {"tightrope"}
        for batch in batches:
            limit, why = limits.nearer(batch, operations)
            assert why == "arithmetic" and limit > 0, f"no limit of {vars(batch)}"
        text = run(sys.executable, pathlib.Path(table.__file__), "--operations", *reports, "--", written,
                   stdout=subprocess.PIPE, text=True).stdout
        assert text.count("\n| ") > len(batches), text
        # A batch that is told to have failed fails the table.
        failed = json.loads(written.read_text())
        failed["benchmarks"][-1].update(error_occurred=True, error_message="planted")
        written.write_text(json.dumps(failed))
        result = subprocess.run([sys.executable, table.__file__, written], capture_output=True, text=True, check=False)
        assert result.returncode == 1 and "planted" in result.stderr, result.stderr
    print(f"{len(batches)} batches")


if __name__ == "__main__":
    main()
