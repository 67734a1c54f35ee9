#!/usr/bin/python3
"""Makes DIR/report.html from DIR/error.json, as `slabcast error --out DIR` wrote it.

usage: perf/pages/error_report.py DIR
"""

import sys

from error_data import load
from page_main import main

if __name__ == "__main__":
    sys.exit(main(__doc__, sys.argv[1:], load, "error_page"))
