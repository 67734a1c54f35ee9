#!/usr/bin/python3
"""Makes DIR/report.html from DIR/mobile.json, as `perf/mobile/table.py --out DIR` wrote it.

usage: perf/pages/mobile_report.py DIR
"""

import sys

from mobile_data import load
from page_main import main

if __name__ == "__main__":
    sys.exit(main(__doc__, sys.argv[1:], load, "mobile_page"))
