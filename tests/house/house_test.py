#!/usr/bin/env python3
"""house.py finds what it is there to find: one planted violation a test, and none in a clean house."""
import pathlib
import tempfile
import unittest

import house

CLEAN = {
    "runtime/tightrope/sign.h": "#include <limits>\n#include <tightrope/arithmetic.h>\n",
    "runtime/tightrope/arithmetic.h": "",
    "dsl/graph.h": "#include <vector>\n",
    "dsl/graph.cpp": '#include "dsl/graph.h"\n#include <fmt/format.h>\n',
    "codegen/bounds.cpp": '#include "dsl/graph.h"\n#include <tightrope/sign.h>\n',
    "ccd/tightrope/ccd.h": "#include <Eigen/Core>\n",
    "ccd/tables.h": "#include <tightrope/sign.h>\n",
    "ccd/methods.cpp": '#include "tightrope/ccd.h"\n#include "tables.h"\n#include "vertex_face.tight.double.h"\n',
    "ccd/oracle/oracle.h": '#include "tightrope/ccd.h"\n',
    "ccd/oracle/oracle.cpp": '#include <gmpxx.h>\n#include "oracle/oracle.h"\n#include "tightrope/ccd.h"\n',
    "ccd/oracle/CMakeLists.txt": "target_link_libraries(tightrope_oracle PRIVATE gmpxx gmp)\n",
    "examples/a/main.cpp": "#include <Eigen/Core>\n",
}


class House(unittest.TestCase):
    def violations(self, changes):
        """Violations in the clean house after `changes` (file -> text)."""
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in {**CLEAN, **changes}.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text)
            return [f"{path}:{number}" for path, number, _ in house.violations(root)]

    def test_clean_house_has_no_violations(self):
        self.assertEqual(self.violations({}), [])

    def test_every_planted_include_is_found(self):
        planted = {
            "runtime includes Eigen": ("runtime/tightrope/bad.h", "#include <Eigen/Core>"),
            "runtime includes a system header": ("runtime/tightrope/bad.h", "#include <unistd.h>"),
            "runtime includes a header that is not in runtime": ("runtime/tightrope/bad.h", "#include <tightrope/ccd.h>"),
            "runtime includes the language": ("runtime/tightrope/bad.h", '#include "dsl/graph.h"'),
            "dsl includes codegen": ("dsl/bad.cpp", '#include "codegen/bounds.h"'),
            "dsl includes ccd": ("dsl/bad.cpp", '#  include "ccd/tables.h"'),
            "dsl includes Eigen": ("dsl/bad.h", "#include <Eigen/Core>"),
            "codegen includes ccd": ("codegen/bad.cpp", '#include "ccd/tables.h"'),
            "codegen includes ccd by its public name": ("codegen/bad.cpp", "#include <tightrope/ccd.h>"),
            "codegen includes Eigen": ("codegen/bad.cpp", "#include <Eigen/Core>"),
            "ccd includes dsl": ("ccd/bad.cpp", '#include "dsl/graph.h"'),
            "ccd includes LLVM": ("ccd/bad.cpp", "#include <llvm/ADT/StringRef.h>"),
            "a method includes the oracle": ("ccd/bad.cpp", '#include "ccd/oracle/oracle.h"'),
            "oracle includes generated code": ("ccd/oracle/bad.cpp", '#include "vertex_face.tight.double.h"'),
            "oracle includes the methods": ("ccd/oracle/bad.cpp", '#include "ccd/tables.h"'),
            "oracle includes the methods by a relative path": ("ccd/oracle/bad.cpp", '#include "../tables.h"'),
            "oracle includes the methods below the include root": ("ccd/oracle/bad.cpp", '#include "tables.h"'),
            "oracle includes the runtime": ("ccd/oracle/bad.cpp", "#include <tightrope/sign.h>"),
        }
        for name, (path, line) in planted.items():
            with self.subTest(name):
                self.assertEqual(self.violations({path: f"#include <vector>\n{line}\n"}), [f"{path}:2"])

    def test_oracle_that_links_the_methods_is_found(self):
        path = "ccd/oracle/CMakeLists.txt"
        self.assertEqual(self.violations({path: "target_link_libraries(tightrope_oracle tightrope::ccd)\n"}), [f"{path}:1"])

    def test_ccd_that_links_llvm_is_found(self):
        path = "ccd/CMakeLists.txt"
        self.assertEqual(self.violations({path: "find_package(LLVM REQUIRED)\n"}), [f"{path}:1"])

    def test_paths_of_one_machine_are_found(self):
        for folder in ("home", "tmp", "work", "root"):
            with self.subTest(folder):
                self.assertEqual(self.violations({"docs/a.md": f"see /{folder}/x/y\n"}), ["docs/a.md:1"])
        self.assertEqual(self.violations({"docs/a.md": "./work/x, $HOME/tmp/, build/tmp/x, a/root/b\n"}), [])

    def test_notes_of_unfinished_work_are_found(self):
        self.assertEqual(self.violations({"dsl/a.cpp": "// TO" "DO: later\n"}), ["dsl/a.cpp:1"])


if __name__ == "__main__":
    unittest.main()
