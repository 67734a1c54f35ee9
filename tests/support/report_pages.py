"""What the tests of the reports' pages share."""

import json
import subprocess
import tempfile
import unittest
from pathlib import Path


class ReportTest(unittest.TestCase):
    """A script that makes a page from one file of a folder: `report` of `data`."""

    report = None
    data = None

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def refusal(self, expected, data=None):
        """One line that holds `expected`, exit 1, and no page."""
        if data is not None:
            (self.folder / self.data).write_text(data if isinstance(data, str) else json.dumps(data))
        result = subprocess.run([self.report, self.folder], capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 1)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertIn(expected, result.stderr)
        self.assertEqual([p.name for p in self.folder.glob("*.html")], [])
