#!/usr/bin/python3
"""Makes DIR/report.html from DIR/sweep.json, as `slabcast sweep --out DIR` wrote it.

usage: perf/pages/report.py DIR
"""

import sys

from page_main import main
from report_data import load

if __name__ == "__main__":
    sys.exit(main(__doc__, sys.argv[1:], load, "report_page"))
