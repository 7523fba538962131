#!/usr/bin/env python3
"""tightrope-ccd under an MPI launcher: the same results as a single process, one message for an error."""

import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

MPIEXEC, COMMAND = sys.argv[1:3]
TIMES = ("ns_per_query", "time_ratio_to_tight")


def run(arguments, processes=None):
    launcher = [MPIEXEC, "-n", str(processes)] if processes else []
    return subprocess.run(launcher + [COMMAND] + arguments, capture_output=True, text=True, stdin=subprocess.DEVNULL)


def counts(outcome):
    """The rows without times, which differ from run to run."""
    return [{key: value for key, value in row.items() if key not in TIMES} for row in json.loads(outcome.stdout)]


class Mpi(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = Path(cls.folder.name)
        # More than a block of 65,536 queries, and CSV files, which are not divided.
        run(["generate", "random", "--queries", "70000", "--kind", "edge-edge", "-o", str(cls.root / "a.h5")])
        run(["generate", "degenerate", "--queries", "300", "-o", str(cls.root / "b")])
        run(["generate", "lattice", "--queries", "300", "-o", str(cls.root / "c.h5")])

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_results_are_those_of_one_process(self):
        arguments = ["evaluate", "--method", "tight", "--format", "json", str(self.root)]
        alone = run(arguments)
        self.assertEqual(alone.returncode, 0, alone.stderr)
        self.assertEqual(counts(alone)[1]["queries"], 70600)
        for processes in (2, 3):
            shared = run(arguments, processes)
            self.assertEqual(shared.returncode, 0, shared.stderr)
            self.assertEqual(shared.stderr, "")
            self.assertEqual(counts(shared), counts(alone))
            for row in json.loads(shared.stdout):
                self.assertGreater(row["ns_per_query"], 0)

    def test_the_first_error_is_told_once_with_status_2(self):
        with tempfile.TemporaryDirectory(dir=self.root) as name:
            folder = Path(name) / "vertex-face"
            folder.mkdir()
            good = ",".join(["0"] * 24) + "\n"
            for number, text in enumerate([good, good, good * 500 + "bad\n", "worse\n", good]):
                (folder / f"{number}.csv").write_text(text)
            (folder / "z.h5").write_text("no HDF5")
            for files in (str(folder), str(folder / "z.h5"), str(folder / "none")):
                alone = run(["evaluate", files])
                self.assertEqual(alone.returncode, 2)
                shared = run(["evaluate", files], 2)
                self.assertEqual(shared.returncode, 2)
                self.assertEqual(shared.stdout, "")
                told = [line for line in shared.stderr.splitlines() if line.startswith("tightrope-ccd: ")]
                self.assertEqual(told, alone.stderr.splitlines())

    def test_warnings_and_charts_come_once(self):
        rows = "\n".join(["1,3,1,1,0,1,0"] * 8) + "\n"  # 1/3 is no double
        with tempfile.TemporaryDirectory() as name:
            file = Path(name) / "vertex-face.csv"
            file.write_text(rows)
            chart = Path(name) / "chart.html"
            shared = run(["evaluate", "--chart", str(chart), str(file)], 2)
            self.assertEqual(shared.returncode, 0, shared.stderr)
            self.assertEqual(shared.stderr, "tightrope-ccd: warning: 8 rational coordinates are no doubles and were "
                                            "rounded to nearest\n")
            self.assertGreater(chart.stat().st_size, 1000)

    def test_other_commands_are_for_one_process(self):
        out = self.root / "refused.h5"
        shared = run(["generate", "random", "-o", str(out)], 2)
        self.assertEqual(shared.returncode, 2)
        told = [line for line in shared.stderr.splitlines() if line.startswith("tightrope-ccd: ")]
        self.assertEqual(told, ["tightrope-ccd: error: generate is for one process; several can share only evaluate"])
        self.assertFalse(out.exists())
        answers = run(["classify", "--method", "tight", str(self.root / "c.h5")], 1)
        self.assertEqual(answers.returncode, 0, answers.stderr)
        self.assertEqual(len(answers.stdout), 2 * 600)

    def test_help_and_usage_errors_come_once(self):
        self.assertEqual(run(["--help"], 2).stdout, run(["--help"]).stdout)
        shared = run(["evaluate", "--method", "none", "x"], 2)
        self.assertEqual(shared.returncode, 2)
        self.assertEqual(shared.stderr.count("unknown method"), 1)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
