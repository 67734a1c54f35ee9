"""What the tests of the reports' pages share."""

import json
import re
import sys
import subprocess
import tempfile
import unittest
from importlib import import_module
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent / "perf" / "pages"))


def words_of(folder, data_module, page_module):
    """A page without its figures, each `<svg/>`, in this process: drawing them is what takes time."""
    plots = import_module(page_module).plots
    drawn, plots.svg = plots.svg, lambda figure, name, key=(): _drawn(figure, name, key)
    try:
        return import_module(page_module).page(import_module(data_module).load(folder))
    finally:
        plots.svg = drawn


def _drawn(figure, name, key):
    svg = import_module("page_svg")
    svg.plt.close(figure)
    drawn = svg.Drawn("<svg/>" + "".join(f"<text>{entry[0]}</text>" for entry in key))
    drawn.name = name
    return drawn


def check_figures(test, folder, text):
    """Every figure of a page lies beside it as SVG and PDF, a narrow one as SVG: text as text, and no other files."""
    names = re.findall(r"<code>figures/([\w-]+)\.svg</code>", text)
    test.assertEqual(len(names), 2 * len(re.findall(r"<figure><div class=.wide.>", text)))
    test.assertEqual({path.name for path in (folder / "figures").iterdir()},
                     {f"{name}.svg" for name in names} | {f"{name}.pdf" for name in names if not name.endswith("-n")})
    for name in names:
        svg = (folder / "figures" / f"{name}.svg").read_text(encoding="utf-8")
        test.assertRegex(svg, r"\A<\?xml [^\n]*\n<svg ", name)
        test.assertIn("<text ", svg, name)
        test.assertNotRegex(svg, r'<path id="[^"]*(DejaVu|Sans)', name)  # glyphs as outlines
        shown = re.sub(r' width="[\d.]+pt"| height="[\d.]+pt"', "", svg.partition("\n")[2], count=2)
        test.assertIn(shown, text, name)
        if name.endswith("-n"):
            continue
        pdf = (folder / "figures" / f"{name}.pdf").read_bytes()
        test.assertTrue(pdf.startswith(b"%PDF-") and pdf.rstrip().endswith(b"%%EOF"), name)
        test.assertIn(b"/CIDFontType2", pdf, name)  # TrueType, as a type 42 font is embedded
        test.assertNotIn(b"/Type3", pdf, name)


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
