#!/usr/bin/python3
"""Makes DIR/report.html from DIR/edit.json, as `slabcast edit --out DIR` wrote it.

usage: perf/pages/edit_report.py DIR
"""

import sys

from edit_data import load
from page_main import main

if __name__ == "__main__":
    sys.exit(main(__doc__, sys.argv[1:], load, "edit_page"))
