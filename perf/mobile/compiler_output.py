"""What mobile compilers say of a fragment shader, as figures by name."""

import re

# Bifrost: arith, texture, vary, ldst. Valhall: fma, cvt, sfu, v, t, ls.
UNITS = {"arith": "arithmetic", "texture": "texture", "vary": "varying", "ldst": "load_store",
         "fma": "fma", "cvt": "cvt", "sfu": "sfu", "v": "varying", "t": "texture", "ls": "load_store"}
COUNTS = {"inst": "instructions", "quadwords": "quadwords", "threads": "threads", "loops": "loops"}
ADRENO = {"inst": "instructions", "nops": "nops", "cat5": "fetches", "(sy)": "sy", "(ss)": "ss", "half": "half_registers",
          "full": "full_registers", "waves": "waves", "loops": "loops", "stp": "spills", "ldp": "fills"}
DWORD = 4


def _numbers(text):
    """{"inst": 12.0, ...} of "12 inst, 3.5 arith, ..."."""
    return {name: float(value) for value, name in re.findall(r"(-?[\d.]+) ([A-Za-z()\d]+)", text)}


def _whole(value):
    return int(value) if value == int(value) else value


def of_mali(text):
    """From "12 inst, ..., 1.5 cycles, 1.5 arith, ..., 0:0 spills:fills". Its units run side by side: the busiest is
    the cost."""
    said = _numbers(text)
    units = {UNITS[name]: said[name] for name in UNITS if name in said}
    unit = max(units, key=units.get)
    figures = {"cost": units[unit], "unit": unit, **units}
    if "fma" in units:
        figures["arithmetic"] = max(units[name] for name in ("fma", "cvt", "sfu"))
    figures.update({ours: _whole(said[name]) for name, ours in COUNTS.items() if name in said})
    spilled = re.search(r"(\d+):(\d+) spills:fills", text)
    figures["spills"], figures["fills"] = map(int, spilled.groups())
    return {name: round(value, 4) if isinstance(value, float) else value for name, value in figures.items()}


def of_adreno(text):
    """From "12 inst, 3 nops, ...". What it costs is its instructions, of which a nop is one that waits."""
    said = _numbers(text)
    figures = {ours: int(said[name]) for name, ours in ADRENO.items() if name in said}
    return {"cost": figures["instructions"], "unit": "instructions", **figures, "code_bytes": int(said["dwords"]) * DWORD}


def fragment_figures(line, driver_says):
    """Figures of a line on stderr, or of what the driver said; None where it is of something else."""
    mali = re.search(r"MESA_SHADER_FRAGMENT shader: (.* cycles.*)", driver_says or line)
    if mali:
        return of_mali(mali[1])
    adreno = re.search(r"FRAG shader: (\d+ inst, .*)", driver_says or "", re.DOTALL)
    return of_adreno(adreno[1]) if adreno else None
