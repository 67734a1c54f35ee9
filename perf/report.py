#!/usr/bin/python3
"""Makes DIR/report.html from DIR/sweep.json, as `slabcast sweep --out DIR` wrote it.

usage: perf/report.py DIR
"""

import os
import sys
import tempfile
from pathlib import Path

from report_data import BadInput, load


def write_whole(path, text):
    """All of the file or nothing of it: a reader never meets half a page."""
    handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            file.write(text)
        os.chmod(temporary, 0o644)
        os.replace(temporary, path)
    except BaseException:
        os.unlink(temporary)
        raise


def main(arguments):
    if len(arguments) != 1 or arguments[0].startswith("-"):
        print(__doc__.strip(), file=sys.stderr)
        return 2
    folder = Path(arguments[0])
    try:
        sweep = load(folder)
        from report_page import page  # matplotlib loads slowly: not before the input is known to be good

        write_whole(folder / "report.html", page(sweep))
    except BadInput as error:
        print(f"report: {error}", file=sys.stderr)
        return 1
    except ImportError as error:
        print(f"report: {error}; install python3-matplotlib and run with /usr/bin/python3", file=sys.stderr)
        return 1
    except OSError as error:
        print(f"report: {error.filename or folder}: {error.strerror}; check the folder", file=sys.stderr)
        return 1
    print(folder / "report.html")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
