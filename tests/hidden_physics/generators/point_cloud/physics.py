"""The palpation law of Zoller2020 with its equilibrium made precise, and the places at which an effect may act.

E. I. Zoller et al., Int. J. CARS 15, 1797-1805 (2020). Frames: V the volume's (LPS), H the handle's.
"""
from types import SimpleNamespace

import numpy as np

from point_cloud.bone import MM


def rig_of(probe, hidden):
    """Places, shape and stiffness of the shank (Zoller2020, eq. (4)), changed by the hidden effects on the shank."""
    rig = SimpleNamespace(z=probe.length_m - probe.point_spacing_m * np.arange(probe.points), length=probe.length_m,
                          factor=probe.force_factor_Nm, rest=np.zeros((probe.points, 2)), ball=None, sharp=0.0,
                          elastic=[(effect.law, q) for effect, q in hidden if effect.kind == "elastic"])
    rig.phi, rig.k = bending(rig, probe, probe.radius_m, probe.radius_m)
    for effect, q in hidden:
        if effect.kind == "rig":
            effect.law(rig, probe, q)
    return rig


def bending(rig, probe, handle_radius_m, tip_radius_m):
    """Shape at the points and stiffness at the tip, from E I(z) v'' = F (L - z) integrated by the midpoint rule."""
    n = 4000
    z = (np.arange(n) + 0.5) * rig.length / n
    radius = handle_radius_m + (tip_radius_m - handle_radius_m) * z / rig.length
    curvature = (rig.length - z) / (probe.youngs_modulus_Pa * np.pi / 4 * radius ** 4)
    step = rig.length / n
    slope = np.concatenate([[0], np.cumsum(curvature)]) * step
    way = np.concatenate([[0], np.cumsum((slope[1:] + slope[:-1]) / 2)]) * step
    at = np.interp(rig.z, np.linspace(0, rig.length, n + 1), way)
    return at / way[-1], 1 / way[-1]


def contact(rig, field, o, r, delta):
    """Points (N, n, 3) in V, their forces c_f g (Zoller2020, eq. (2)), dF/dp and the blurred opacity there.
    Hidden effects on the elastic force are added, their slope by differences along the three axes."""
    place = np.concatenate([rig.rest + rig.phi[:, None] * delta[:, None], np.broadcast_to(
        rig.z[:, None], (len(o), len(rig.z), 1))], -1)
    p = o[:, None] + place @ np.swapaxes(r, -1, -2)
    if rig.ball is None:
        g, j, opacity = field.sample(p)
    else:  # the tip is felt over the nodes of its ball; without sharpness their weighted mean
        nodes, weights = rig.ball
        g, j, opacity = field.sample(np.concatenate([p[:, 1:], p[:, :1] + nodes], 1))
        n, m = len(rig.z) - 1, len(nodes)
        w = weights * np.exp(rig.sharp * (opacity[:, n:] - opacity[:, n:].max(1, keepdims=True)))
        w /= w.sum(1, keepdims=True)
        g, j, opacity = (np.concatenate([(w.reshape(w.shape + (1,) * (a.ndim - 2)) * a[:, n:]).sum(1)[:, None],
                                         a[:, :n]], 1) for a in (g, j, opacity))
    force, slope = rig.factor * g, rig.factor * j
    given, given_slope, h = force, slope, 1e-8
    for law, q in rig.elastic:
        added = law(p, given, q)
        ahead = [law(p + h * axis, given + h * given_slope[..., k], q) for k, axis in enumerate(np.eye(3))]
        force, slope = force + added, slope + np.stack([(a - added) / h for a in ahead], -1)
    return p, force, slope, opacity


def equilibrium(rig, field, o, r, delta, extra, tolerance_N=1e-7, rounds=80):
    """Tip deflection with k delta = sum of phi_i F_i across the shank, `extra` forces at the points included.
    Newton with a floor under the stiffness, so that each step goes downhill, and steps that shrink when they turn."""
    delta, cap, last, todo = delta.copy(), np.full(len(o), 0.6 * MM), np.zeros((len(o), 2)), np.arange(len(o))
    extra = np.broadcast_to(extra, (len(o), len(rig.z), 3))
    for _ in range(rounds):
        _, force, slope, _ = contact(rig, field, o[todo], r[todo], delta[todo])
        cross = r[todo][..., :2]
        residual = rig.k * delta[todo] - np.einsum("i,nia,nak->nk", rig.phi, force + extra[todo], cross)
        stiff = rig.k * np.eye(2) - np.einsum("nak,nab,nbl->nkl", cross, np.einsum(
            "i,niab->nab", rig.phi ** 2, slope), cross)
        mean, half = (stiff[:, 0, 0] + stiff[:, 1, 1]) / 2, (stiff[:, 0, 0] - stiff[:, 1, 1]) / 2
        least = mean - np.hypot(half, (stiff[:, 0, 1] + stiff[:, 1, 0]) / 2)
        stiff += np.maximum(0, rig.k / 2 - least)[:, None, None] * np.eye(2)
        step = -np.linalg.solve(stiff, residual[..., None])[..., 0]
        cap[todo] *= np.where((step * last[todo]).sum(-1) < 0, 0.5, 1.3)
        step *= np.minimum(1, cap[todo] / np.maximum(np.linalg.norm(step, axis=-1), 1e-15))[:, None]
        delta[todo] += step
        last[todo] = step
        todo = todo[np.linalg.norm(residual, axis=-1) > tolerance_N]
        if not len(todo):
            break
    return delta


def predict(bone, probe, motion, t_s, hidden=(), start=None):
    """Wrench (trials, times, 6) on the probe at the origin of H, in H (Zoller2020, eq. (3)), and the deflection.

    `hidden` holds (effect, its numbers). Effects of kind "elastic" add to the force law of a point, "points" add
    forces that depend on velocity or memory, "shift" moves the probe against the bone, "rig" changes the shank or its
    tip, "time" shows the force late, "sensor" adds to the wrench. Added forces and equilibrium are found in turns,
    relaxed at each sample by Aitken's rule. The last value returned is the rms of the last change, in N."""
    rig = rig_of(probe, hidden)
    t_s = t_s - sum(q["delay_s"] for effect, q in hidden if effect.kind == "time")
    o, r = motion.pose(t_s)
    h = 5e-4
    ahead, behind = motion.pose(t_s + h), motion.pose(t_s - h)
    tail = (slice(None), slice(None), None)
    v = [x[0][tail] + rig.z[:, None] * x[1][..., 2][tail] for x in (ahead, behind)]
    c = SimpleNamespace(bone=bone, probe=probe, motion=motion, t=t_s, o=o, r=r, v=(v[0] - v[1]) / (2 * h),
                        dt=float(np.diff(t_s[0]).mean()), factor=rig.factor)
    shape = o.shape[:2]
    flat = [x.reshape((-1,) + x.shape[2:]) for x in (o, r, motion.bending(t_s) if start is None else start)]
    extra, shift = np.zeros(c.v.shape), np.zeros(o.shape)
    change, relax = np.zeros(c.v.shape), np.ones(o.shape[:2] + (1, 1))
    laws = {kind: [(effect.law, q) for effect, q in hidden if effect.kind == kind]
            for kind in ("points", "shift", "sensor")}
    for turn in range(30 if laws["points"] or laws["shift"] else 1):
        o_now = flat[0] + shift.reshape(-1, 3)
        flat[2] = equilibrium(rig, bone.field, o_now, flat[1], flat[2], extra.reshape(-1, probe.points, 3))
        p, force, _, opacity = contact(rig, bone.field, o_now, flat[1], flat[2])
        c.p, c.force, c.opacity = (x.reshape(shape + x.shape[1:]) for x in (p, force, opacity))
        c.total = c.force + extra
        before, change = change, sum((law(c, q) for law, q in laws["points"]), np.zeros(c.v.shape)) - extra
        moved = sum((law(c, q) for law, q in laws["shift"]), np.zeros(o.shape)) - shift
        if np.abs(change).max() < 1e-4 and np.abs(moved).max() < 1e-8:
            break
        turned = change - before
        aitken = -relax * (before * turned).sum((2, 3), keepdims=True)
        aitken = aitken / np.maximum((turned ** 2).sum((2, 3), keepdims=True), 1e-18)
        relax = np.clip(aitken, 0.05, 1.0) if turn else relax
        extra, shift = extra + relax * change, shift + moved
    total = c.total + change
    lever = c.p - (o + shift)[:, :, None]
    f = probe.force_scale * total.sum(2)
    torque = probe.torque_scale * np.cross(lever, total).sum(2)
    c.wrench = np.concatenate([(x[..., None, :] @ r)[..., 0, :] for x in (f, torque)], -1)
    for law, q in laws["sensor"]:
        c.wrench = c.wrench + law(c, q)
    return c.wrench, flat[2].reshape(shape + (2,)), float(np.sqrt((change ** 2).sum((2, 3)).mean()))
