"""The shared library, as sinew.h declares it."""
import os
import pathlib
import re
import subprocess

import cffi

from sinew.refused import Refused


def _asked(*arguments):
    try:
        return subprocess.run(["pkg-config", *arguments, "sinew"], capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return ""


def _include():
    folder = pathlib.Path(os.environ.get("SINEW_INCLUDE") or _asked("--variable=includedir") or "/usr/include")
    if not (folder / "sinew" / "sinew.h").exists():
        raise ImportError(f"sinew: no sinew/sinew.h in {folder}; install Sinew, or set SINEW_INCLUDE to the folder that has it")
    return folder


def _library():
    libdir = _asked("--variable=libdir")
    path = os.environ.get("SINEW_LIBRARY") or (f"{libdir}/libsinew.so" if libdir else "libsinew.so")
    try:
        return ffi.dlopen(path)
    except OSError as error:
        raise ImportError(f"sinew: cannot load {path} ({error}); install Sinew with its shared library, or set SINEW_LIBRARY") from None


def _declarations(folder):
    """sinew.h as cffi can read it, and SINEW_LAYOUT's formula."""
    text = (folder / "sinew" / "sinew.h").read_text() + (folder / "sinew" / "version.h").read_text()
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL).replace("\\\n", " ")
    numbers = dict(re.findall(r"#define (SINEW_VERSION_\w+) (\d+)", text))
    layout = re.search(r"#define SINEW_LAYOUT\s+(.*)", text).group(1)
    text = re.sub(r"^\s*#.*$", "", text, flags=re.MULTILINE).replace("SINEW_API ", "")
    return re.sub(r'extern "C" \{|^\}$', "", text, flags=re.MULTILINE), numbers, layout


def _layout(numbers, formula):
    """SINEW_LAYOUT, of the sizes that structs have here."""
    version = int(numbers["SINEW_VERSION_MAJOR"]) * 10000 + int(numbers["SINEW_VERSION_MINOR"]) * 100 + int(numbers["SINEW_VERSION_PATCH"])
    terms = re.findall(r"(\d+)u \* sizeof\((\w+)\)", formula)
    return (version + sum(int(factor) * ffi.sizeof(struct) for factor, struct in terms)) & 0xFFFFFFFF


ffi = cffi.FFI()
_text, _numbers, _formula = _declarations(_include())
ffi.cdef(_text)
lib = _library()
LAYOUT = _layout(_numbers, _formula)


def check(status):
    if status != lib.SINEW_OK:
        raise Refused(status, ffi.string(lib.sinew_message()).decode())
