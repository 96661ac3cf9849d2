"""What is in a data set, in figures."""
import os

import numpy as np

from .dataset import SPLITS
from .trajectory import read_trajectory

BANDS_HZ = (0, 1, 2, 4, 8, 16, 30)
SEGMENT_S = 4.0  # of the spectrum (Welch 1967)


def _spectrum(displacement, rate_hz):
    """Power of (T, N, 3) in each band, summed over nodes and axes."""
    length = min(len(displacement), int(SEGMENT_S * rate_hz))
    hz = np.fft.rfftfreq(length, 1 / rate_hz)
    power = np.zeros(len(hz))
    for start in range(0, len(displacement) - length + 1, length):
        segment = displacement[start : start + length] * np.hanning(length)[:, None, None]
        power += (np.abs(np.fft.rfft(segment, axis=0)) ** 2).sum((1, 2))
    edges = np.searchsorted(hz, BANDS_HZ)
    edges[-1] = len(hz)
    return np.array([power[a:b].sum() for a, b in zip(edges[:-1], edges[1:])])


def _figures(sizes):
    """Mean, 95th percentile and largest, to four digits."""
    rounded = lambda v: float(f"{float(v):.4g}")
    return {
        "mean": rounded(sizes.mean(dtype=np.float64)),
        "p95": rounded(np.percentile(sizes, 95)),
        "max": rounded(sizes.max()),
    }


def split_figures(trajectories):
    """Displacement is the error of skinning alone; felt acceleration is the first part of the drive."""
    lengths = lambda a: np.linalg.norm(a, axis=-1).ravel()
    bands = sum(_spectrum(t.displacement, t.rate_hz) for t in trajectories)
    return {
        "sequences": len(trajectories),
        "seconds": round(sum((len(t.displacement) - 1) / t.rate_hz for t in trajectories), 2),
        "displacement_mm": _figures(np.concatenate([lengths(t.displacement) for t in trajectories]) * 1000),
        "felt_acceleration_m_s2": _figures(np.concatenate([lengths(t.drive[..., :3]) for t in trajectories])),
        "power_share": {
            f"{low}-{high} Hz": round(float(p / bands.sum()), 4)
            for low, high, p in zip(BANDS_HZ, BANDS_HZ[1:], bands)
        },
    }


def body_figures(trajectory):
    """Of the body that a trajectory belongs to: nodes and first mode of each region, where the file tells."""
    regions = {}
    for r, name in enumerate(trajectory.body.region_names):
        modes = trajectory.tensors.get(f"modes.{r}.rad_per_s")
        regions[name] = {
            "nodes": int((trajectory.body.region == r).sum()),
            "radius_m": round(float(trajectory.body.radius_m[r]), 4),
            "first_mode_hz": None if modes is None else round(float(modes.min() / (2 * np.pi)), 2),
        }
    return {"regions": regions}


def statistics(folder, jobs):
    """body -> its regions and the figures of each of its splits. Throws BadData naming an unusable file."""
    figures = {}
    for body in dict.fromkeys(j.body for j in jobs):
        for split in SPLITS:
            files = [j.file for j in jobs if (j.body, j.split) == (body, split)]
            trajectories = [read_trajectory(os.path.join(folder, f)) for f in files]
            if trajectories:
                entry = figures.setdefault(body, body_figures(trajectories[0]))
                entry[split] = split_figures(trajectories)
    return figures
