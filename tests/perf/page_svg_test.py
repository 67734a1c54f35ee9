#!/usr/bin/python3
"""perf/pages/page_svg.py: legends lie inside their figures, beside nothing, and figures keep their size."""

import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent / "perf" / "pages"))
import page_svg  # noqa: E402
from page_svg import NARROW, WIDE, plt  # noqa: E402

ENTRIES = [(text, "#123456", marker, hollow, dashes) for text, marker, hollow, dashes in (
    ("no skipping, full polygons", "o", False, ""), ("skipping (bitfield-octree), tight polygons", "s", True, "4 2"),
    ("a <name> with $signs$ and a very long story of where it is from and what it was told to be called", None,
     False, ""), ("front: nothing is both cheaper and more accurate", "D", False, None))]


class LegendTest(unittest.TestCase):
    def drawn(self, width, entries):
        """The figure with its legend; and the height of its axes with and without one, in inches."""
        heights = []
        for key in ([], entries):
            figure, axes = plt.subplots(figsize=(width, 3.0))
            self.addCleanup(plt.close, figure)
            axes.set_xlabel("planes")
            if key:
                page_svg._add_legend(figure, key)
            figure.canvas.draw()
            heights.append(axes.get_window_extent().height / figure.dpi)
        return figure, axes, heights

    def test_it_lies_within_the_figure_and_above_the_axes(self):
        for width in (WIDE, NARROW):
            figure, axes, _ = self.drawn(width, ENTRIES)
            (legend,) = figure.legends
            box, frame = legend.get_window_extent(), figure.bbox
            self.assertGreaterEqual(box.x0, frame.x0)
            self.assertLessEqual(box.x1, frame.x1)
            self.assertLessEqual(box.y1, frame.y1)
            self.assertGreater(box.y0, axes.get_tightbbox().y1 - 1)
            for text in legend.get_texts():
                extent = text.get_window_extent()
                self.assertTrue(frame.x0 <= extent.x0 and extent.x1 <= frame.x1, text.get_text())

    def test_the_plot_keeps_its_size(self):
        for width in (WIDE, NARROW):
            without, with_legend = self.drawn(width, ENTRIES)[2]
            self.assertAlmostEqual(with_legend, without, delta=0.05)

    def test_texts_are_the_entries(self):
        figure, _, _ = self.drawn(WIDE, ENTRIES)
        texts = [text.get_text().replace("\n", " ") for text in figure.legends[0].get_texts()]
        self.assertEqual(texts[1], ENTRIES[1][0])
        self.assertIn("a <name> with", texts[2])

    def test_the_file_holds_it_as_text(self):
        figure, axes = plt.subplots()
        axes.set_xscale("log")
        axes.plot([1, 1000], [1, 2])
        page_svg.svg(figure, "one", ENTRIES)
        text = page_svg.FILES["one.svg"].decode()
        self.assertIn(">no skipping, full polygons</text>", text)
        self.assertIn("with $signs$ and", text.replace("\n", " "))
        self.assertNotIn("DejaVuSans-", text)  # glyphs would be paths of such names
        self.assertIn("Verdana, sans-serif", text)


if __name__ == "__main__":
    unittest.main()
