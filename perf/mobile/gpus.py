"""The GPUs whose compilers run here, and how a program is run under each."""

import os
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

MESAS = {"22": "Mesa 22.3.6 (Debian 12)", "25": "Mesa 25.0.7 (Debian 13)"}
COMPILERS = Path(__file__).resolve().parent / "compilers.sh"


@dataclass(frozen=True)
class Gpu:
    name: str
    title: str
    family: str  # bifrost, valhall or adreno: which figures its compiler gives
    mesa: str  # which of compilers.sh
    chip: str  # as the shim is told
    # Of instructions, bytes: what Mesa's driver preloads at most (freedreno_devices.py, instr_cache_size, units of 128).
    # Arm publishes none.
    cache_bytes: int | None = None


GPUS = {gpu.name: gpu for gpu in (
    Gpu("g71", "Mali-G71", "bifrost", "22", "6000"),
    Gpu("g52", "Mali-G52", "bifrost", "22", "7212"),
    Gpu("g57", "Mali-G57", "valhall", "22", "9093"),
    Gpu("adreno630", "Adreno 630", "adreno", "22", "630", 64 * 128),
    Gpu("g610", "Mali-G610", "valhall", "25", "a867"),
    # The shims know no 650; told of one, they gave the same code for it as for the 660.
    Gpu("adreno660", "Adreno 650/660", "adreno", "22", "660", 127 * 128),
    Gpu("adreno740", "Adreno 740", "adreno", "25", "740", 127 * 128),
)}


class NoCompilers(Exception):
    """One line: why they cannot be had here."""


def build_folder(mesa):
    """Where a Mesa was built; made where it is missing, which takes about ten minutes. Raises NoCompilers."""
    made = subprocess.run([COMPILERS, mesa], stdout=subprocess.PIPE, text=True)
    if made.returncode != 0:
        raise NoCompilers(f"Mesa {mesa} cannot be made here (exit {made.returncode}); "
                          f"`{COMPILERS.name} {mesa}` says why")
    return Path(made.stdout.strip().splitlines()[-1])


def cache():
    """Where compilers.sh keeps what it made."""
    return Path(os.environ.get("SLABCAST_COMPILERS", Path.home() / ".cache" / "slabcast-compilers"))


def present(mesa):
    """Whether it was made before."""
    return (cache() / f"{mesa}.done").exists()


def _environment(gpu, build):
    """Beside the caller's own: the compiler's libraries, its shim and what it shall tell."""
    libraries = ("src/egl", "src/mapi/es2api", "src/mapi/shared-glapi", "src/gbm", "src/gallium/targets/dri")
    common = {"LIBGL_DRIVERS_PATH": f"{build}/src/gallium/targets/dri",
              "LD_LIBRARY_PATH": ":".join(f"{build}/{folder}" for folder in libraries),
              "MESA_SHADER_CACHE_DISABLE": "1", "EGL_LOG_LEVEL": "fatal", "MESA_GLES_VERSION_OVERRIDE": "3.2"}
    if gpu.family == "adreno":
        return {**common, "FD_GPU_ID": gpu.chip, "FD_MESA_DEBUG": "shaderdb",
                "MESA_LOADER_DRIVER_OVERRIDE": "msm",
                "LD_PRELOAD": f"{build}/src/freedreno/drm-shim/libfreedreno_noop_drm_shim.so"}
    return {**common, "PAN_GPU_ID": gpu.chip, "PAN_MESA_DEBUG": "deqp", "BIFROST_MESA_DEBUG": "shaderdb",
            "MESA_LOADER_DRIVER_OVERRIDE": "panfrost",
            "LD_PRELOAD": f"{build}/src/panfrost/drm-shim/libpanfrost_noop_drm_shim.so"}


def command(gpu, program, arguments):
    """(words, environment) that run a program under a GPU's compiler. That of another system's root is run there: it
    takes nothing but the C and C++ libraries. Raises NoCompilers."""
    build = build_folder(gpu.mesa)
    if gpu.mesa == "22":
        return [str(program), *arguments], {**os.environ, **_environment(gpu, build)}
    root = build.parents[1]
    inside = root / "root" / f"{Path(program).name}-{gpu.name}"
    shutil.copy2(program, inside)
    settings = [f"{name}={value}" for name, value in _environment(gpu, f"/{build.relative_to(root)}").items()]
    return ["chroot", str(root), "env", *settings, f"/root/{inside.name}", *arguments], dict(os.environ)
