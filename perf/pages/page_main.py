"""From a folder of measurements to its page: what all page makers do alike."""

import os
import signal
import sys
import tempfile
from importlib import import_module
from pathlib import Path

from page_input import BadInput


def write_whole(path, content):
    """All of the file or nothing of it: a reader never meets half a page. `content`: text or bytes."""
    handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content.encode() if isinstance(content, str) else content)
        os.chmod(temporary, 0o644)
        os.replace(temporary, path)
    except BaseException:
        os.unlink(temporary)
        raise


def main(usage, arguments, load, page_module):
    """Writes DIR/report.html with `page(load(DIR))` of the module, and its figures as files in DIR/figures before;
    prints the page's path. The exit status."""
    if len(arguments) != 1 or arguments[0].startswith("-"):
        print(usage.strip(), file=sys.stderr)
        return 2
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # as a failure: nothing half-written stays
    folder = Path(arguments[0])
    program = Path(sys.argv[0]).stem
    try:
        measured = load(folder)
        # matplotlib loads slowly: not before the input is known to be good
        text = import_module(page_module).page(measured)
        (folder / "figures").mkdir(exist_ok=True)
        for name, content in import_module("page_svg").FILES.items():
            write_whole(folder / "figures" / name, content)
        write_whole(folder / "report.html", text)
    except BadInput as error:
        print(f"{program}: {error}", file=sys.stderr)
        return 1
    except ImportError as error:
        print(f"{program}: {error}; install python3-matplotlib and run with /usr/bin/python3", file=sys.stderr)
        return 1
    except OSError as error:
        print(f"{program}: {error.filename or folder}: {error.strerror}; check the folder", file=sys.stderr)
        return 1
    print(folder / "report.html")
    return 0
