#!/usr/bin/env python3
"""Each public header names its test, and each test that a header names is there. usage: headers_test.py"""

import re
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
NAMED = re.compile(r"[Tt]ested by:?((?:[\s/,]|and|\w+_test\.(?:cpp|py|sh))+)")


def public_headers(root):
    """What an application gets by including core/slabcast.h."""
    found, todo = [], ["core/slabcast.h"]
    while todo:
        path = todo.pop()
        if path not in found:
            found.append(path)
            todo += re.findall(r'#include "(core/[^"]+)"', (root / path).read_text())
    return sorted(found)


def tests_of(header):
    return [name for listed in NAMED.findall(header.read_text()) for name in re.findall(r"\w+_test\.\w+", listed)]


def without_test(root):
    """Public headers that declare something and name no test."""
    return [path for path in public_headers(root)
            if not tests_of(root / path) and re.search(r"^[^/#\s]", (root / path).read_text(), re.MULTILINE)]


def missing_tests(root):
    there = {path.name for path in (root / "tests").rglob("*_test.*")}
    return [f"{path.relative_to(root)}: {name}" for top in ("core", "perf", "platform")
            for path in sorted((root / top).rglob("*.h")) for name in tests_of(path) if name not in there]


class HeadersTest(unittest.TestCase):
    def test_each_public_header_names_its_test(self):
        self.assertGreater(len(public_headers(ROOT)), 10)
        self.assertEqual(without_test(ROOT), [])

    def test_each_test_that_is_named_is_there(self):
        self.assertEqual(missing_tests(ROOT), [])

    def test_what_is_missing_is_found(self):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            for path, text in (("core/slabcast.h", '#pragma once\n\n// The way in.\n#include "core/a.h"\n'),
                               ("core/a.h", '#include "core/b.h"\n/// Tested by: a_test.cpp, and\n/// c_test.py\nint a();\n'),
                               ("core/b.h", "#pragma once\nint b();\n"), ("core/hidden.h", "int h();\n"),
                               ("tests/a_test.cpp", "")):
                (root / path).parent.mkdir(exist_ok=True)
                (root / path).write_text(text)
            self.assertEqual(without_test(root), ["core/b.h"])
            self.assertEqual(missing_tests(root), ["core/a.h: c_test.py"])


if __name__ == "__main__":
    unittest.main()
