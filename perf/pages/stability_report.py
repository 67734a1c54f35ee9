#!/usr/bin/python3
"""Makes DIR/report.html from DIR/stability.json, as `slabcast stability --out DIR` wrote it.

usage: perf/pages/stability_report.py DIR
"""

import sys

from stability_data import load
from page_main import main

if __name__ == "__main__":
    sys.exit(main(__doc__, sys.argv[1:], load, "stability_page"))
