#!/usr/bin/env python3
"""What the core paper's shaders cost a Mali-G71, block by block, by its open compiler: the figures in paper_model.cpp.

usage: perf/model/paper_costs.py
The shaders are written as sections 2.1 to 2.3 of the paper describe them: the position in the volume comes from the
polygon's vertices, the ray from the eye through it; a fragment whose layers all lie outside the volume is discarded, by
its own position, unless it has them all; then layers are sampled where they lie inside, one after another, and
composited. With skipping, a texel without opacity holds the distance to the closest with some, and so many layers are
left out, one by one. The paper prints no code: what of this it does not say is said here.
A line is a block of the scheduled shader: its tuples, and what it does.
"""

import ctypes
import re
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "mobile"))

VERTEX = """#version 310 es
out highp vec3 place;
void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0;
    place = vec3(corner, 0.5);
    gl_Position = vec4(corner, 0.0, 1.0);
}
"""
HEAD = """#version 310 es
precision highp float; precision highp int; precision highp sampler3D;
uniform sampler3D volume;
layout(std140, binding = 0) uniform Frame { vec4 eye; vec4 spacing; };
in vec3 place;
out vec4 colour;
void main() {
"""
INSIDE = "all(greaterThanEqual(p, vec3(0.0))) && all(lessThanEqual(p, vec3(1.0)))"
OVER = "sum.rgb += (1.0 - sum.a) * c.a * c.rgb; sum.a += (1.0 - sum.a) * c.a;"
PLAIN = f"if ({INSIDE}) {{ vec4 c = texture(volume, p); {OVER} }}"
SKIPPING = (f"if (left > 0) left--; else if ({INSIDE}) {{ vec4 c = texture(volume, p); "
            f"if (c.a == 0.0) left = int(c.r * 255.0); else {{ {OVER} }} }}")


def fragment(layers, skips, loops):
    """The text of a segment; of one layer slicing."""
    if layers == 1:
        return (HEAD + "vec3 p = place;\nif (any(lessThan(p, vec3(0.0))) || any(greaterThan(p, vec3(1.0)))) discard;\n"
                "colour = texture(volume, p);\n}\n")
    text = HEAD if loops else HEAD + "if (any(greaterThan(abs(place - 0.5), vec3(spacing.z)))) discard;\n"
    text += "vec3 along = normalize(place - eye.xyz) * spacing.x;\n"
    text += f"vec3 p = place - along * {0.5 * (layers - 1)};\nvec4 sum = vec4(0.0);\nint left = 0;\n"
    layer = f"{SKIPPING if skips else PLAIN}\np += along;\n"
    text += f"for (int i = 0; i < int(spacing.y); ++i) {{ {layer} }}\n" if loops else layer * layers
    return text + "colour = sum;\n}\n"


def link(vertex, text):
    """Links and draws a triangle with what EGL gives: the driver compiles, and says so on stderr."""
    egl, gl = ctypes.CDLL("libEGL.so.1"), ctypes.CDLL("libGLESv2.so.2")
    egl.eglGetPlatformDisplay.restype = egl.eglCreateContext.restype = ctypes.c_void_p
    display = ctypes.c_void_p(egl.eglGetPlatformDisplay(0x31DD, None, None))  # surfaceless
    if not egl.eglInitialize(display, None, None):
        sys.exit("paper_costs: EGL cannot be initialised")
    config, count = ctypes.c_void_p(), ctypes.c_int()
    egl.eglChooseConfig(display, (ctypes.c_int * 3)(0x3040, 0x40, 0x3038), ctypes.byref(config), 1, ctypes.byref(count))
    egl.eglBindAPI(0x30A0)
    version = (ctypes.c_int * 5)(0x3098, 3, 0x30FB, 1, 0x3038)
    context = ctypes.c_void_p(egl.eglCreateContext(display, config, None, version))
    egl.eglMakeCurrent(display, None, None, context)
    program = gl.glCreateProgram()
    for kind, source in ((0x8B31, vertex), (0x8B30, text)):
        shader = gl.glCreateShader(kind)
        lines = ctypes.c_char_p(source.encode())
        gl.glShaderSource(shader, 1, ctypes.byref(lines), None)
        gl.glCompileShader(shader)
        gl.glAttachShader(program, shader)
    gl.glLinkProgram(program)
    linked = ctypes.c_int()
    gl.glGetProgramiv(program, 0x8B82, ctypes.byref(linked))
    if not linked.value:
        sys.exit("paper_costs: the shader does not link")
    texture, buffer = ctypes.c_uint(), ctypes.c_uint()
    gl.glGenTextures(1, ctypes.byref(texture))
    gl.glBindTexture(0x0DE1, texture)
    gl.glTexStorage2D(0x0DE1, 1, 0x8058, 16, 16)
    gl.glGenFramebuffers(1, ctypes.byref(buffer))
    gl.glBindFramebuffer(0x8D40, buffer)
    gl.glFramebufferTexture2D(0x8D40, 0x8CE0, 0x0DE1, texture, 0)
    gl.glViewport(0, 0, 16, 16)
    gl.glUseProgram(program)
    gl.glDrawArrays(4, 0, 3)
    gl.glFinish()


def blocks(gpus, text):
    """[(tuples, instructions of note)] of the fragment shader's blocks as they are scheduled; code bytes."""
    with tempfile.NamedTemporaryFile("w", suffix=".frag") as file:
        file.write(text)
        file.flush()
        words, environment = gpus.command(gpus.GPUS["g71"], "/usr/bin/python3", [__file__, "--link", file.name])
        environment["BIFROST_MESA_DEBUG"] = "shaderdb,shaders"
        said = subprocess.run(words, env=environment, capture_output=True, text=True, errors="replace")
    output = said.stdout + said.stderr
    if "MESA_SHADER_FRAGMENT" not in output:  # drawing may fail, where no GPU is: then all is compiled
        sys.exit(f"paper_costs: the compiler gave no figures: {said.stderr.strip().splitlines()[-1:]}")
    scheduled = output.split("\nblock0 {")[-1]
    found = []
    for line in ("block0 {" + scheduled).splitlines():
        if re.match(r"block\d+ \{", line):
            found.append([0, []])
        elif line.startswith(("clause_", "SHADER-DB")):
            break
        elif found:
            found[-1][0] += line.startswith("\t*")
            found[-1][1] += re.findall(r"\b(TEXC|TEXS_2D|BRANCHZ|JUMP|ATEST|BLEND|ICMP|FRSQ|FMIN|FMAX|DISCARD)\b", line)
    size = re.findall(r"(\d+) quadwords", output)
    return found, 16 * int(size[-1])


def main():
    if len(sys.argv) == 3 and sys.argv[1] == "--link":
        link(VERTEX, Path(sys.argv[2]).read_text(encoding="utf-8"))
        return
    if len(sys.argv) > 1:
        sys.exit(__doc__.split("\n\n")[1])
    import gpus
    for title, shape in (("slicing", (1, False, False)), ("4 layers", (4, False, False)),
                         ("4 layers, skipping", (4, True, False)), ("a loop", (444, False, True)),
                         ("a loop, skipping", (444, True, True))):
        found, size = blocks(gpus, fragment(*shape))
        print(f"{title}: {size} bytes")
        for tuples, notes in found:
            if tuples:
                print(f"  {tuples:3} {' '.join(notes)}")
    for layers in (8, 16, 32):
        print(f"{layers} layers, skipping: {blocks(gpus, fragment(layers, True, False))[1]} bytes")


if __name__ == "__main__":
    main()
