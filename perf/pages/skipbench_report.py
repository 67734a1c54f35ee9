#!/usr/bin/python3
"""Makes DIR/report.html from DIR/skipbench.json, as `slabcast skipbench --out DIR` wrote it.

usage: perf/pages/skipbench_report.py DIR
"""

import sys

from page_main import main
from skipbench_data import load

if __name__ == "__main__":
    sys.exit(main(__doc__, sys.argv[1:], load, "skipbench_page"))
