#!/usr/bin/env python3
"""table.py on a recorded run: the table as it was checked by hand (24 GB/s, 48 Gop/s and other round figures), and a
clear refusal of everything that is no such run. `table_test.py --update` renews the table.
"""
import copy
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
RECORDED = HERE / "recorded"
RUN = json.loads((RECORDED / "batch_bench.json").read_text())
OPERATIONS = json.loads((RECORDED / "operations.json").read_text())


def make_table(run=None, operations=None, text=None):
    """The finished process, of the recorded run but for what is given."""
    with tempfile.TemporaryDirectory() as folder:
        files = {"batch_bench.json": json.dumps(run or RUN) if text is None else text,
                 "operations.json": json.dumps(OPERATIONS if operations is None else operations)}
        for name, content in files.items():
            (pathlib.Path(folder) / name).write_text(content)
        command = [sys.executable, HERE / "table.py", "--operations", f"{folder}/operations.json",
                   "--others", RECORDED / "query_bench.json", "--", f"{folder}/batch_bench.json"]
        return subprocess.run(command, capture_output=True, text=True, check=False)


def changed(change):
    """The recorded run after change(run)."""
    run = copy.deepcopy(RUN)
    change(run)
    return run


class TableTest(unittest.TestCase):
    def test_recorded_run_gives_the_recorded_table(self):
        result = make_table()
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertEqual(result.stdout, (RECORDED / "table.md").read_text())

    def test_order_of_the_repetitions_makes_no_difference(self):
        self.assertEqual(make_table(changed(lambda run: run["benchmarks"].reverse())).stdout, make_table().stdout)

    def test_written_medians_count_as_the_repetitions_do(self):
        def to_medians(run):
            lines = {}
            for line in run["benchmarks"]:
                lines.setdefault(line["run_name"], []).append(line)
            run["benchmarks"] = []
            for name, repetitions in lines.items():
                for aggregate, place in (("mean", 0), ("median", len(repetitions) // 2), ("stddev", 0)):
                    line = dict(sorted(repetitions, key=lambda x: x["cpu_time"])[place])
                    line.update(name=f"{name}_{aggregate}", run_type="aggregate", aggregate_name=aggregate)
                    run["benchmarks"].append(line)
        self.assertEqual(make_table(changed(to_medians)).stdout, make_table().stdout)

    def test_limits_are_those_of_the_run(self):
        def halve_the_memory(run):
            for line in run["benchmarks"]:
                if line["run_name"] in ("limit/read/scalar/threads:1", "limit/read/avx2/threads:1"):
                    line["bytes"] /= 2
        self.assertIn("| tightrope | vertex-face | double | avx2 | 10.0 | 100 | 16.0 memory | 1.60 |",
                      make_table(changed(halve_the_memory)).stdout)

    def test_what_reads_fastest_is_the_limit_of_all(self):
        def hasten_one_by_one(run):
            for line in run["benchmarks"]:
                if line["run_name"] == "limit/read/scalar/threads:1":
                    line["bytes"] *= 2
        self.assertIn("| tightrope | vertex-face | double | avx2 | 10.0 | 100 | 4.00 memory | 0.40 |",
                      make_table(changed(hasten_one_by_one)).stdout)

    def test_fused_operations_have_a_limit_of_their_own(self):
        def drop_reads(run):
            run["benchmarks"] = [line for line in run["benchmarks"] if not line["name"].startswith("limit/read/")]
        text = make_table(changed(drop_reads)).stdout
        self.assertIn("| tightrope | edge-edge | double | avx2 | 10.0 | 100 | 2.50 arithmetic |", text)
        self.assertIn("| tightrope | edge-edge | double | avx2 fused | 9.00 | 111 | 2.00 arithmetic |", text)

    def test_operations_are_those_of_the_compiler(self):
        operations = copy.deepcopy(OPERATIONS)
        for predicate in operations:
            if predicate["predicate"] == "plane_of_face":
                predicate["stages"][0]["bound_operations"]["total"] *= 10
        self.assertIn("| tightrope | vertex-face | double | avx2 | 10.0 | 100 | 11.0 arithmetic | 1.10 |",
                      make_table(operations=operations).stdout)

    def test_without_limits_there_are_no_fractions(self):
        def drop_limits(run):
            run["benchmarks"] = [line for line in run["benchmarks"] if not line["name"].startswith("limit/")]
        result = make_table(changed(drop_limits))
        self.assertEqual(result.returncode, 0)
        self.assertIn("| tightrope | vertex-face | double | avx2 | 10.0 | 100 | - | - | 4.00 |", result.stdout)

    def test_a_failed_benchmark_is_told(self):
        def fail(run):
            run["benchmarks"][0].update(error_occurred=True, error_message="not the answers of the queries one by one")
        result = make_table(changed(fail))
        self.assertEqual((result.returncode, result.stdout), (1, ""))
        self.assertIn(f"{RUN['benchmarks'][0]['name']}: not the answers of the queries one by one", result.stderr)

    def test_what_is_no_run_is_refused(self):
        def broken(**changes):
            return changed(lambda run: run["benchmarks"][0].update(changes))

        texts = {"": "not JSON", "{\"context\": {}": "not JSON", "[]": "has no \"context\"", "{\"context\": {}}": "has no \"benchmarks\"",
                 "{\"context\": {}, \"benchmarks\": [3]}": "3 is no benchmark",
                 "{\"context\": {}, \"benchmarks\": [{}]}": "has no \"name\""}
        for text, message in texts.items():
            self.refused(make_table(text=text), message)
        for run, message in ((broken(time_unit="h"), "unknown unit"), (broken(cpu_time="fast"), "\"cpu_time\" is \"fast\""),
                             (broken(real_time=0), "\"real_time\" is 0"), (broken(cpu_time=float("nan")), "\"cpu_time\" is nan"),
                             (broken(run_name="batch/cloth-fold"), "not a batch's name"),
                             (changed(lambda run: [line.pop("queries", None) for line in run["benchmarks"]]),
                              "has no \"queries\"")):
            self.refused(make_table(run), message)
        self.refused(make_table(operations={}), "no list of predicates")
        self.refused(make_table(operations=[{"predicate": "x"}]), "has no \"bound\"")

    def refused(self, result, message):
        self.assertEqual((result.returncode, result.stdout), (2, ""), result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.assertIn(message, result.stderr)

    def test_a_missing_file_is_refused(self):
        result = subprocess.run([sys.executable, HERE / "table.py", "no such file"], capture_output=True, text=True, check=False)
        self.refused(result, "no such file: No such file or directory")


if __name__ == "__main__":
    if sys.argv[1:] == ["--update"]:
        (RECORDED / "table.md").write_text(make_table().stdout)
    else:
        unittest.main()
