"""Trajectories of a made-up body, in the format of `sinew-bake truth`: masses on springs in a moving frame.
Quick, and enough like flesh to tell whether training works."""
import numpy as np

H = 1 / 60


def _body(rng, regions=2, nodes=12):
    rest = rng.normal(size=(regions, nodes, 3))
    rest /= np.linalg.norm(rest, axis=-1, keepdims=True)
    normal = rest.copy()
    rest = rest * rng.uniform(0.6, 1, (regions, nodes, 1))
    edges = []
    for r in range(regions):
        near = np.linalg.norm(rest[r][:, None] - rest[r][None], axis=-1).argsort(1)[:, 1:5]
        edges += [(r * nodes + a, r * nodes + b) for a in range(nodes) for b in near[a]]
    edges = np.unique(np.sort(np.array(edges), 1), axis=0)
    return rest.reshape(-1, 3), normal.reshape(-1, 3), edges, np.repeat(np.arange(regions), nodes)


def _motion(rng, ticks, strength):
    """Frame acceleration, alpha, omega (T+1, 3): sums of sines after ten still ticks."""
    t = np.arange(ticks + 1) * H
    ramp = np.clip((t - 10 * H) / 0.3, 0, 1)[:, None]
    wave = (
        lambda size: sum(
            np.sin(2 * np.pi * rng.uniform(0.4, 3) * t + rng.uniform(0, 6.28))[:, None]
            * rng.normal(size=3)
            * size
            for _ in range(3)
        )
        * ramp
        * strength
    )
    omega = wave(0.5)
    alpha = np.vstack([np.zeros(3), np.diff(omega, axis=0)]) / H
    return wave(1.5), alpha, omega


def _drive(a, alpha, omega, r, gravity):
    """(T+1, N, 21); r (N, 3) metres; articulation is nil."""
    wide = lambda v: np.broadcast_to(v[:, None], (len(v), len(r), 3))
    ra = np.broadcast_to(r, (len(a), len(r), 3))
    euler = -np.cross(wide(alpha), ra)
    centrifugal = -np.cross(wide(omega), np.cross(wide(omega), ra))
    return np.concatenate(
        [wide(-a), euler, centrifugal, np.zeros_like(ra), wide(alpha), wide(omega), wide(gravity)], -1
    )


def trajectory(seed, ticks=120, strength=1.0, body_seed=0):
    """(tensors, metadata) as a trajectory file holds them."""
    rest, normal, edges, region = _body(np.random.default_rng(body_seed))
    rng = np.random.default_rng(1000 + seed)
    n, radius = len(rest), 0.1
    a, alpha, omega = _motion(rng, ticks, strength)
    gravity = 2 * np.sin(np.arange(ticks + 1) * H * 3)[:, None] * rng.normal(size=3) * strength
    gravity[:10] = 0
    drive = _drive(a, alpha, omega, rest * radius, gravity)
    force = drive[..., :12].reshape(ticks + 1, n, 4, 3).sum(2) + gravity[:, None]
    laplacian = np.zeros((n, n))
    for i, j in edges:
        laplacian[[i, j, i, j], [i, j, j, i]] += [1, 1, -1, -1]
    w2 = (2 * np.pi * 4) ** 2
    k = w2 * (0.6 * np.eye(n) + 0.3 * laplacian)
    u, v, out = np.zeros((n, 3)), np.zeros((n, 3)), np.zeros((ticks + 1, n, 3))
    for t in range(1, ticks + 1):
        for _ in range(4):
            v += H / 4 * (force[t] - k @ u - 5 * v)
            u += H / 4 * v
        out[t] = u
    tensors = {
        "drive": drive.astype(np.float32),
        "displacement": out.astype(np.float32),
        "node.rest_position": rest.astype(np.float32),
        "node.rest_normal": normal.astype(np.float32),
        "node.stiffness": np.full((n, 1), 0.2, np.float32),
        "node.region": region.astype(np.int32),
        "edges": edges.astype(np.int32),
        "region.radius_m": np.full(2, radius, np.float32),
    }
    metadata = {
        "sinew.trajectory": 1,
        "character": "synthetic",
        "motion": "random",
        "seed": seed,
        "rate_hz": 60,
        "substeps": 4,
        "seconds": ticks / 60,
        "height_m": 1,
        "strength": strength,
        "regions": "left,right",
    }
    return tensors, metadata
