#!/usr/bin/env python3
"""Holds the arrows between folders: which may include which. usage: arrows_test.py"""

import re
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BELOW_PLAN = ("core/base", "core/volume", "core/transfer", "core/view", "core/skip")
BELOW_SCENE = (*BELOW_PLAN, "core/gl", "core/plan", "core/skip/gpu")

# Room: what it may include beside its own. A folder inside a room belongs to it unless it has a line of its own.
ROOMS = {
    "core/base": (),
    "core/gl": ("core/base",),
    "core/volume": ("core/base",),
    "core/transfer": ("core/base", "core/volume"),
    "core/view": ("core/base", "core/volume", "core/transfer"),
    "core/skip": ("core/base", "core/volume", "core/transfer"),
    "core/skip/gpu": ("core/base", "core/volume", "core/transfer", "core/skip", "core/gl"),
    # What a device can, and the texts of shaders: neither names GL.
    "core/plan": (*BELOW_PLAN, "core/gl/caps.h", "core/gl/shader_text.h"),
    "core/scene": BELOW_SCENE,
    "core/draw": (*BELOW_SCENE, "core/scene"),
    "core/reference": ("core/base", "core/volume", "core/transfer", "core/view"),
    "core": (*BELOW_SCENE, "core/scene", "core/draw"),  # slabcast.h, the way in
    "perf": ("core",),
    "platform": ("core", "perf"),
    "examples": ("core/slabcast.h", "platform"),
}

# Libraries by the beginning of an include; the standard library comes beside them. Each source that parsed nlohmann-json
# took 8 s to compile where others take 2: of perf one does.
CORE_LIBRARIES = ("GLES2/", "GLES3/", "glm/", "tl/")
LIBRARIES = {"core": CORE_LIBRARIES, "perf/json.cpp": (*CORE_LIBRARIES, "nlohmann/"), "perf": CORE_LIBRARIES}
# Neither prints nor touches files: whoever calls them does.
NOT_IN_LIBRARIES = ("iostream", "fstream", "filesystem", "print")
INCLUDE = re.compile(r'\s*#\s*include\s*(["<])([^">]+)[">]')


def within(path, folder):
    return path == folder or path.startswith(folder + "/")


def room_of(path):
    """The line of ROOMS that a file belongs to; None for a file of no room, of tests for example."""
    return max((room for room in ROOMS if within(path, room)), key=len, default=None)


def folder_of(path):
    """What takes part in cycles: core's rooms and the folders of everything else; at a top, a file for itself."""
    if within(path, "core"):
        return room_of(path)
    parent = Path(path).parent
    return str(parent if "/" in str(parent) else Path(path).with_suffix(""))


def may_include(room, path):
    if room_of(path) == room:
        return True
    for allowed in ROOMS[room]:
        # "core" and "platform" stand for all their rooms, another room for itself.
        whole = allowed in ("core", "perf", "platform") or allowed.endswith(".h")
        if within(path, allowed) if whole else room_of(path) == allowed:
            return True
    return False


def wrong_include(path, kind, included):
    """Why this include must not be, or None."""
    room = room_of(path)
    if kind == '"' or room_of(included):
        if room_of(included) is None:
            return f"{included} is in no room"
        return None if may_include(room, included) else f"{room} must not see {room_of(included)}"
    for top, libraries in LIBRARIES.items():
        if within(path, top):
            standard = "/" not in included and "." not in included and included not in NOT_IN_LIBRARIES
            return None if standard or included.startswith(libraries) else f"{top} must not see <{included}>"
    return None


def includes_of(root):
    """Of every include line: file, number of the line, kind of quote, what is included."""
    for top in ("core", "perf", "platform", "examples"):
        for file in sorted((root / top).rglob("*")):
            if file.suffix in (".h", ".cpp") and file.is_file():
                for number, line in enumerate(file.read_text().splitlines(), 1):
                    if match := INCLUDE.match(line):
                        # An example's own header lies beside it.
                        beside = top == "examples" and (file.parent / match[2]).exists()
                        included = f"{top}/{match[2]}" if beside else match[2]
                        yield file.relative_to(root).as_posix(), number, match[1], included


def cycles(arrows):
    """Folders that see each other, over others or at once: one line for every folder on a cycle."""
    def reached(start):
        seen, todo = set(), [start]
        while todo:
            for following in arrows.get(todo.pop(), ()):
                if following not in seen:
                    seen.add(following)
                    todo.append(following)
        return seen
    return [f"{folder}: on a cycle of folders" for folder in sorted(arrows) if folder in reached(folder)]


def violations(root):
    found, arrows = [], {}
    for path, number, kind, included in includes_of(root):
        if why := wrong_include(path, kind, included):
            found.append(f"{path}:{number}: {why}")
        if room_of(included) and folder_of(path) != folder_of(included):
            arrows.setdefault(folder_of(path), set()).add(folder_of(included))
    return found + cycles(arrows)


class ArrowsTest(unittest.TestCase):
    def planted(self, *files):
        """What is found in a tree of just these (path, include) files."""
        with tempfile.TemporaryDirectory() as folder:
            for path, include in files:
                file = Path(folder, path)
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(f"// {path}\n#include {include}\n")
            return violations(Path(folder))

    def test_every_include_follows_an_arrow(self):
        self.assertGreater(sum(1 for _ in includes_of(ROOT)), 500)
        found = violations(ROOT)
        self.assertFalse(found, "\n" + "\n".join(found))

    def test_every_room_is_there_and_sees_only_rooms_before_it(self):
        order = [room for room in ROOMS if room.startswith("core/")]
        for at, room in enumerate(order):
            self.assertTrue(any((ROOT / room).glob("*.h")), room)
            for seen in ROOMS[room]:
                self.assertIn(room_of(seen), order[:at], room)

    def test_planted_violations_are_found(self):
        for path, include, why in (
                ("core/base/a.h", '"core/volume/volume.h"', "core/base must not see core/volume"),
                ("core/transfer/a.cpp", '"core/view/view.h"', "core/transfer must not see core/view"),
                ("core/skip/a.cpp", '"core/gl/objects.h"', "core/skip must not see core/gl"),
                ("core/skip/a.cpp", '"core/skip/gpu/a.h"', "core/skip must not see core/skip/gpu"),
                ("core/view/a.h", '"core/skip/blocks.h"', "core/view must not see core/skip"),
                ("core/plan/a.cpp", '"core/gl/objects.h"', "core/plan must not see core/gl"),
                ("core/plan/a.cpp", '"core/skip/gpu/a.h"', "core/plan must not see core/skip/gpu"),
                ("core/scene/a.cpp", '"core/draw/renderer.h"', "core/scene must not see core/draw"),
                ("core/draw/a.cpp", '"core/slabcast.h"', "core/draw must not see core"),
                ("core/reference/a.h", '"core/plan/frame_plan.h"', "core/reference must not see core/plan"),
                ("core/draw/a.cpp", '"platform/egl/egl_context.h"', "core/draw must not see platform"),
                ("core/draw/a.cpp", "<platform/egl/egl_context.h>", "core/draw must not see platform"),
                ("core/slabcast.h", '"perf/error/error_table.h"', "core must not see perf"),
                ("core/gl/deep/a.cpp", '"core/draw/renderer.h"', "core/gl must not see core/draw"),
                ("core/draw/a.cpp", '"tests/support/a.h"', "tests/support/a.h is in no room"),
                ("core/gl/a.h", "<EGL/egl.h>", "core must not see <EGL/egl.h>"),
                ("core/gl/a.h", "<nlohmann/json.hpp>", "core must not see <nlohmann/json.hpp>"),
                ("core/base/a.h", "<unistd.h>", "core must not see <unistd.h>"),
                ("core/base/a.h", "<iostream>", "core must not see <iostream>"),
                ("perf/sweep/a.cpp", '"platform/io/a.h"', "perf must not see platform"),
                ("perf/sweep/a.cpp", "<fmt/format.h>", "perf must not see <fmt/format.h>"),
                ("perf/json.h", "<nlohmann/json.hpp>", "perf must not see <nlohmann/json.hpp>"),
                ("perf/json.cpp", "<fmt/format.h>", "perf/json.cpp must not see <fmt/format.h>"),
                ("perf/sweep/a.cpp", "  <CLI/CLI.hpp> // why", "perf must not see <CLI/CLI.hpp>"),
                ("perf/sweep/a.cpp", "<fstream>", "perf must not see <fstream>"),
                ("examples/a.cpp", '"core/draw/renderer.h"', "examples must not see core/draw")):
            with self.subTest(path=path, include=include):
                self.assertEqual(self.planted((path, include)), [f"{path}:2: {why}"])

    def test_what_is_allowed_is_not_found(self):
        self.assertEqual(self.planted(
            ("core/plan/a.cpp", '"core/gl/caps.h"'), ("core/draw/a.cpp", '"core/skip/gpu/a.h"'),
            ("core/slabcast.h", '"core/draw/renderer.h"'), ("core/gl/deep/a.h", '"core/gl/caps.h"'),
            ("core/base/a.h", "<algorithm>"), ("core/gl/a.h", "<GLES3/gl32.h>"),
            ("perf/json.cpp", "<nlohmann/json.hpp>"), ("platform/cli/a.cpp", '"perf/a.h"'),
            ("platform/cli/b.cpp", "<fmt/format.h>"), ("examples/a.cpp", '"core/slabcast.h"'),
            ("examples/b.h", "<slabcast/slabcast.h>"), ("examples/c.cpp", '"b.h"')), [])

    def test_planted_cycles_are_found(self):
        self.assertEqual(
            self.planted(("perf/a/a.h", '"perf/b/b.h"'), ("perf/b/b.h", '"perf/c/c.h"'),
                         ("perf/c/c.h", '"perf/a/other.h"'), ("perf/d/d.h", '"perf/a/a.h"')),
            [f"perf/{folder}: on a cycle of folders" for folder in "abc"])


if __name__ == "__main__":
    unittest.main()
