"""Chooses the linear algebra kernels. Has to run before numpy or torch is imported: the package does it
first of all."""
import os

_AVX512 = {"avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"}


def processor_flags(path="/proc/cpuinfo"):
    """The instruction sets the kernel reports, empty where it reports none."""
    try:
        with open(path) as file:
            return next((set(line.split(":")[1].split()) for line in file if line.startswith("flags")), set())
    except OSError:
        return set()


def choose(environment=os.environ, flags=None):
    """OpenBLAS falls back to its oldest kernels on a processor it does not know; its SkylakeX kernels run
    wherever AVX-512 does.

    One thread unless the caller says otherwise: two processes on two cores beat one process on both."""
    if _AVX512 <= (processor_flags() if flags is None else flags):
        environment.setdefault("OPENBLAS_CORETYPE", "SkylakeX")
    environment.setdefault("OPENBLAS_NUM_THREADS", "1")
    environment.setdefault("OMP_NUM_THREADS", environment["OPENBLAS_NUM_THREADS"])
