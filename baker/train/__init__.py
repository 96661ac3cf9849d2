"""Trains the tissue networks: data sets by the ground truth, training, judging, export. See README.md."""
from . import blas

blas.choose()
