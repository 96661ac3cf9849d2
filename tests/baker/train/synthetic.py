"""Trajectories of a made-up body, in the format of `sinew-bake truth`: modes in node frames, written out in
double precision tick by tick as the equations stand, with a spring on top that hardens. Quick, and enough
like flesh to tell whether training works."""
import numpy as np

from train.model.modal_base import LARGEST_TURN

H = 1 / 60
SIZES = (10, 6)  # nodes of each region
MODES = 8
RADIUS_M = 0.1
HARDENING = 3e5  # 1/(m^2 s^2): at 2 cm the spring is half again as stiff
GRAVITY = np.array([0, -9.80665, 0])


def skew(v):
    """(..., 3) -> (..., 3, 3)"""
    x, y, z = np.moveaxis(v, -1, 0)
    zero = np.zeros_like(x)
    return np.stack([zero, -z, y, z, zero, -x, -y, x, zero], -1).reshape(*x.shape, 3, 3)


def turn_and_mean(theta):
    """exp([theta]x) and the mean of exp(s [theta]x) over s in 0..1, by Rodrigues' formula; (..., 3, 3)."""
    a = np.maximum(np.linalg.norm(theta, axis=-1), 1e-9)[..., None, None]
    k = skew(theta) / a
    turn = np.eye(3) + np.sin(a) * k + (1 - np.cos(a)) * k @ k
    return turn, np.eye(3) + (1 - np.cos(a)) / a * k + (1 - np.sin(a) / a) * k @ k


def recurrence(w, zeta):
    """a1, a2, gain of each mode, from the two roots of s^2 + 2 zeta w s + w^2."""
    root = w * np.sqrt(np.asarray(zeta**2 - 1, complex))
    first, second = (np.exp(H * (sign * root - zeta * w)) for sign in (1, -1))
    remembers = np.abs(root.imag) * H < np.pi
    a1, a2 = remembers * (first + second).real, remembers * -(first * second).real
    return a1, a2, (1 - a1 - a2) / (w * w)


def _edges(rest, first):
    near = np.linalg.norm(rest[:, None] - rest[None], axis=-1).argsort(1)[:, 1:4]
    pairs = [(a, b) for a in range(len(rest)) for b in near[a]]
    return first + np.unique(np.sort(np.array(pairs), 1), axis=0)


def _basis(rng, rest, edges):
    """Modes of nodes on springs, to the ground and to each other along the edges."""
    n = len(rest)
    laplacian = np.zeros((n, n))
    for i, j in edges:
        laplacian[[i, j, i, j], [i, j, j, i]] += [1, 1, -1, -1]
    uneven = rng.normal(size=(3 * n, 3 * n)) / n
    stiffness = np.kron(0.6 * np.eye(n) + 0.3 * laplacian, np.eye(3)) + 0.2 * uneven @ uneven.T
    squared, phi = np.linalg.eigh((2 * np.pi * 4) ** 2 * stiffness)
    compliance = (phi / squared) @ phi.T
    next_w, w, phi = np.sqrt(squared[MODES]), np.sqrt(squared[:MODES]), phi[:, :MODES]
    arm = rest * RADIUS_M
    turning = np.zeros((3 * n, 3 * n))
    for i, m in enumerate(skew(0.5 * arm / (arm * arm).sum(-1, keepdims=True))):
        turning[3 * i : 3 * i + 3, 3 * i : 3 * i + 3] = m
    shape, damping = phi * np.sqrt(n), lambda v: 0.05 * (w[0] / v + v / w[0])
    return dict(
        rad_per_s=w,
        damping_ratio=damping(w),
        shape=shape,
        turn=0.75 * turning @ shape,
        force=phi.T / np.sqrt(n),
        rest=compliance - (phi / w**2) @ phi.T,
        rest_oscillator=np.array([next_w, damping(next_w)]),
        first=np.array([w[0], damping(w[0])]),
    )


def _body(rng):
    """rest, normal (N, 3), edges, region (N,), a basis a region."""
    rest, edges, bases = [], [], []
    for first, n in zip(np.cumsum((0,) + SIZES), SIZES):
        r = rng.normal(size=(n, 3))
        rest.append(r / np.linalg.norm(r, axis=-1, keepdims=True) * rng.uniform(0.6, 1, (n, 1)))
        edges.append(_edges(rest[-1], first))
        bases.append(_basis(rng, rest[-1], edges[-1] - first))
    rest = np.concatenate(rest)
    normal = rest / np.linalg.norm(rest, axis=-1, keepdims=True)
    return rest, normal, np.concatenate(edges), np.repeat(np.arange(len(SIZES)), SIZES), bases


def _motion(rng, rest, ticks, strength, bend_share):
    """Place (T+1, N, 3), frame (T+1, N, 3, 3) and bend (T+1, N, 3) of every node: ten still ticks, then a root that sways and
    turns and a joint that bends, of which each node has its own share."""
    t = np.arange(ticks + 1) * H
    ramp = np.clip((t - 10 * H) / 0.4, 0, 1)
    ramp = (ramp**3 * (10 - 15 * ramp + 6 * ramp * ramp))[:, None]

    def wave(acceleration):
        sum = 0
        for _ in range(3):
            w = 2 * np.pi * rng.uniform(0.4, 2.5)
            size = rng.normal(size=3) * acceleration / (w * w)
            sum = sum + np.sin(w * t + rng.uniform(0, 6.28))[:, None] * size
        return strength * ramp * sum

    root, bend = turn_and_mean(wave(6))[0][:, None], wave(6)
    share = 0.5 + 0.5 * rest[:, 0]
    bent = turn_and_mean(share[:, None] * bend[:, None])[0]
    place = (root @ bent @ (rest * RADIUS_M)[..., None])[..., 0] + wave(2)[:, None]
    return place, root @ bent, bend_share * share[:, None] * bend[:, None]


def drive_of(place, frame, bend):
    """(T+1, N, 15) as runtime/tissue/frames/node_drive.hpp: what lies before the start is the start."""
    before = lambda a: np.concatenate([a[:1], a[:-1]])
    back = np.swapaxes(frame, -1, -2)
    apply = lambda m, v: (m @ v[..., None])[..., 0]
    acceleration = (place - 2 * before(place) + before(before(place))) / H**2
    a_tick = before(back) @ frame
    odd = [a_tick[..., i, j] - a_tick[..., j, i] for i, j in ((2, 1), (0, 2), (1, 0))]
    omega = np.stack(odd, -1) / (2 * H)
    gravity = np.broadcast_to(GRAVITY, place.shape)
    alpha = (omega - before(omega)) / H
    bound = apply(turn_and_mean(bend)[0], gravity)
    return np.concatenate(
        [apply(back, gravity - acceleration) - bound, apply(back, gravity) - bound, omega, alpha, bend], -1
    )


def simulate(basis, felt, frame, hardening=HARDENING, linear=False):
    """(T+1, n, 3) of one region from rest, along the nodes' frames. linear: neither warped nor aware of how
    the frames turn."""
    n, (a1, a2, gain) = felt.shape[1], recurrence(basis["rad_per_s"], basis["damping_ratio"])
    rest_a1, rest_a2, _ = recurrence(*basis["rest_oscillator"])
    apply = lambda m, v: (m @ v[..., None])[..., 0]
    q = q_before = np.zeros(len(a1))
    u = u_before = l = theta = rest = rest_before = np.zeros((n, 3))
    out = [u]
    for t in range(1, len(felt)):
        force = felt[t]
        if not linear:
            now = np.swapaxes(frame[t], -1, -2)
            carried = apply(now @ frame[t - 1], 2 * u) - apply(now @ frame[max(t - 2, 0)], u_before)
            force = force + (carried - (2 * u - u_before)) / H**2
            force = apply(np.swapaxes(turn_and_mean(theta)[0], -1, -2), force)
        force = force - hardening * (l * l).sum(-1, keepdims=True) * l
        q, q_before = a1 * q + a2 * q_before + gain * (basis["force"] @ force.ravel()), q
        goal = (1 - rest_a1 - rest_a2) * (basis["rest"] @ force.ravel()).reshape(n, 3)
        rest, rest_before = rest_a1 * rest + rest_a2 * rest_before + goal, rest
        l = (basis["shape"] @ q).reshape(n, 3) + rest
        theta = (basis["turn"] @ q).reshape(n, 3)
        theta = theta / np.maximum(1, np.linalg.norm(theta, axis=-1, keepdims=True) / LARGEST_TURN)
        u, u_before = (l if linear else apply(turn_and_mean(theta)[1], l)), u
        out.append(u)
    return np.stack(out)


def _written(basis):
    """As a file holds it: float, frequencies and damping as one row."""
    row = lambda v: np.atleast_2d(v).astype(np.float32)
    return {k: row(v) for k, v in basis.items()}


def trajectory(seed, ticks=120, strength=1.0, body_seed=0, hardening=HARDENING, linear=False, bend_share=0.25):
    """(tensors, metadata) as a trajectory file holds them. bend_share: of the bend, told to the network; it has no
    part in how this body moves."""
    rest, normal, edges, region, bases = _body(np.random.default_rng(body_seed))
    place, frame, bend = _motion(np.random.default_rng(1000 + seed), rest, ticks, strength, bend_share)
    drive = drive_of(place, frame, bend)
    u = [
        simulate(b, drive[:, region == r, :3], frame[:, region == r], hardening, linear)
        for r, b in enumerate(bases)
    ]
    tensors = {
        "drive": drive.astype(np.float32),
        "rotation": frame.reshape(ticks + 1, len(rest), 9).astype(np.float32),
        "displacement": np.concatenate(u, 1).astype(np.float32),
        "node.rest_position": rest.astype(np.float32),
        "node.rest_normal": normal.astype(np.float32),
        "node.stiffness": np.linspace(0, 0.4, len(rest))[:, None].astype(np.float32),
        "node.region": region.astype(np.int32),
        "edges": edges.astype(np.int32),
        "region.radius_m": np.full(len(SIZES), RADIUS_M, np.float32),
    }
    for r, b in enumerate(bases):
        tensors.update({f"modes.{r}.{k}": v for k, v in _written(b).items()})
    metadata = {
        "sinew.trajectory": 5,
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


def mirrored(tensors):
    """The same trajectory seen in a mirror: left is right."""
    polar, axial = np.array([-1, 1, 1], np.float32), np.array([1, -1, -1], np.float32)
    out = dict(tensors)
    for name in ("node.rest_position", "node.rest_normal", "displacement"):
        out[name] = tensors[name] * polar
    out["drive"] = tensors["drive"] * np.concatenate([polar, polar, axial, axial, axial])
    out["rotation"] = tensors["rotation"] * np.outer(polar, polar).ravel()
    for name, a in tensors.items():
        if name.endswith(".shape") or name.endswith(".turn"):
            flip = polar if name.endswith(".shape") else axial
            out[name] = a * np.tile(flip, len(a) // 3)[:, None]
        elif name.endswith(".force"):
            out[name] = a * np.tile(polar, a.shape[1] // 3)
        elif name.endswith(".rest"):
            out[name] = a * np.tile(polar, len(a) // 3) * np.tile(polar, len(a) // 3)[:, None]
    return out
