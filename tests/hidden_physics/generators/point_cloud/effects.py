"""The effects that a set may hide, each with its law, its numbers and how they follow from one size.

A law of kind "points" gets the state c of `physics.predict` and returns forces (trials, times, points, 3) in V that
are added to the elastic ones; one of kind "elastic" gets places and elastic forces of points and returns what it adds
to these. Laws without a source are our own, as are all smoothing widths.
"""
from types import SimpleNamespace

import numpy as np

from point_cloud.bone import MM, unit
from point_cloud.physics import bending

GRAVITY_M_S2 = 9.80665
DOWN_V = np.array([0.0, -1.0, 0.0])  # the patient lies prone: down is anterior
EFFECTS = {}


def effect(kind, start, limit, formula, numbers, draw=lambda rng, bone, probe: {}):
    """Enters a law under its function's name. `numbers(x, drawn)` gives its parameters at size x, which a search
    scales from `start`, at most up to `limit`. Names that begin with _ stay out of the truth."""
    def enter(law):
        EFFECTS[law.__name__] = SimpleNamespace(id=law.__name__, kind=kind, start=start, limit=limit, formula=formula,
                                                numbers=numbers, draw=draw, law=law)
        return law
    return enter


def between(rng, low, high):
    """Log-uniform draw."""
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def size(vector):
    return np.linalg.norm(vector, axis=-1, keepdims=True)


def across(c):
    """Velocity of each point across the bone's push."""
    normal = c.force / np.maximum(size(c.force), 1e-9)
    return c.v - (c.v * normal).sum(-1, keepdims=True) * normal


def remember(step, state, *series):
    """States after each time of a step(state, values at the time)."""
    states = []
    for j in range(series[0].shape[1]):
        state = step(state, *(x[:, j] for x in series))
        states.append(state)
    return np.stack(states, 1)


def low_pass(x, dt, tau_s):
    return remember(lambda y, now: y + (1 - np.exp(-dt / tau_s)) * (now - y), np.zeros_like(x[:, 0]), x)


def in_tract(bone, p):
    """Coordinates along the tract's frame and distance past the lumen's side (negative inside it)."""
    q, radii = (p - bone.entry_m) @ bone.frame, bone.radii_m
    return q, (np.hypot(q[..., 0] / radii[0], q[..., 1] / radii[1]) - 1) * np.sqrt(radii.prod())


def at_tip(c, force):
    return np.concatenate([force[:, :, None], np.zeros(force.shape[:2] + (c.force.shape[2] - 1, 3))], 2)


def along_shank(place_m, f):
    """Wrench in H of a force (in H) that acts at a place on the handle's axis."""
    return np.concatenate([f, np.cross([0, 0, place_m], f)], -1)


def direction(rng, n=3):
    return unit(rng.standard_normal(n))


# ---- in the catalogue -------------------------------------------------------------------------------------------

@effect("points", 0.1, 1.5, "-mu |F_n| v_t/|v_t| at each point, in the shank's equilibrium (Coulomb)",
        lambda x, d: {"coefficient": x, "bends_shank": 1.0})
def contact_friction(c, q):
    v = across(c)
    return -q["coefficient"] * size(c.force) * v / np.sqrt(size(v) ** 2 + (0.2 * MM) ** 2)


@effect("points", 5.0, 500, "-c (blurred opacity) v at each point, in the shank's equilibrium",
        lambda x, d: {"damping_Ns_per_m": x, "bends_shank": 1.0})
def contact_damping(c, q):
    return -q["damping_Ns_per_m"] * c.opacity[..., None] * c.v


@effect("elastic", 0.1, 0.7, "c_f g (|g|/g0)^(p-1)",
        lambda x, d: {"exponent": 1 + d["sign"] * x, "reference_gradient_per_m": d["reference"],
                      "_factor": d["factor"]},
        lambda rng, bone, probe: {"sign": rng.choice([-1, 1]),
                                  "reference": rng.uniform(0.15, 0.6) * bone.end_push_per_m.max(),
                                  "factor": probe.force_factor_Nm})
def contact_nonlinearity(p, force, q):
    relative = np.maximum(size(force) / q["_factor"] / q["reference_gradient_per_m"], 1e-6)
    return force * (relative ** (q["exponent"] - 1) - 1)


@effect("points", 0.1, 0.95, "F (1 - h) while v . F > 0 (leaving), else F", lambda x, d: {"loss": x})
def contact_hysteresis(c, q):
    leaving = (c.v * c.force).sum(-1, keepdims=True) / np.maximum(size(c.force), 1e-9)
    return -q["loss"] * (0.5 + 0.5 * np.tanh(leaving / (0.2 * MM))) * c.force


@effect("shift", 0.1 * MM, 5 * MM, "true position = recorded position + offset",
        lambda x, d: {"offset_m": list(x * d["to"])}, lambda rng, bone, probe: {"to": direction(rng)})
def pose_offset(c, q):
    return np.broadcast_to(q["offset_m"], c.o.shape)


def mass_and_centre(x, d):
    return {"mass_kg": x, "centre_m": d["centre"]}


def draw_centre(rng, bone, probe):
    return {"centre": rng.uniform(0.2, 0.6) * probe.length_m}


@effect("sensor", 0.01, 1.0, "-m a of a mass at centre_m on the handle's axis (Newton)", mass_and_centre, draw_centre)
def probe_inertia(c, q):
    h, place = 4e-3, []
    for t in (c.t - h, c.t, c.t + h):
        o, r = c.motion.pose(t)
        place.append(o + q["centre_m"] * r[..., 2])
    a = (place[0] - 2 * place[1] + place[2]) / h ** 2
    return along_shank(q["centre_m"], -q["mass_kg"] * (a[..., None, :] @ c.r)[..., 0, :])


@effect("sensor", 0.01, 1.0, "m g down, at centre_m on the handle's axis", mass_and_centre, draw_centre)
def probe_weight(c, q):
    return along_shank(q["centre_m"], q["mass_kg"] * GRAVITY_M_S2 * (DOWN_V @ c.r))


@effect("sensor", 0.05, 20.0, "recorded = true + (force, torque), in H",
        lambda x, d: {"force_N": list(x * d["to"]), "torque_Nm": list(x * d["turn"])},
        lambda rng, bone, probe: {"to": direction(rng), "turn": 0.03 * direction(rng)})
def sensor_bias(c, q):
    return np.broadcast_to(np.concatenate([q["force_N"], q["torque_Nm"]]), c.wrench.shape)


@effect("sensor", 0.2, 20.0, "recorded = true + smooth trend of this range in each trial and axis, 0 at the start",
        lambda x, d: {"range_N": x, "_course": d["course"]},
        lambda rng, bone, probe: {"course": rng.standard_normal((64, 6, 3)) / [1, 2, 4]})
def sensor_drift(c, q):
    share = (c.t - c.t[:, :1]) / (c.t[:, -1:] - c.t[:, :1])
    waves = np.cos(np.pi * share[..., None] * [1, 2, 3])
    trend = np.einsum("jmk,jak->jma", waves, q["_course"][:len(waves)])
    trend = (trend - trend[:, :1]) / np.ptp(trend, axis=1)[:, None]
    return q["range_N"] * trend * [1, 1, 1, 0.03, 0.03, 0.03]


@effect("rig", 0.5 * MM, 20 * MM, "unloaded shank at b (z/L)^2 (cos beta, sin beta) in H",
        lambda x, d: {"bow_m": x, "direction_rad": d["beta"]},
        lambda rng, bone, probe: {"beta": rng.uniform(-np.pi, np.pi)})
def shank_curvature(rig, probe, q):
    to = np.array([np.cos(q["direction_rad"]), np.sin(q["direction_rad"])])
    rig.rest = rig.rest + q["bow_m"] * (rig.z[:, None] / rig.length) ** 2 * to


@effect("rig", 0.1, 0.75, "r(z) linear; k and phi from E I(z) v'' = F (L - z)",
        lambda x, d: {"handle_radius_m": d["mean"] * (1 + x), "tip_radius_m": d["mean"] * (1 - x)},
        lambda rng, bone, probe: {"mean": probe.radius_m})
def shank_taper(rig, probe, q):
    rig.phi, rig.k = bending(rig, probe, q["handle_radius_m"], q["tip_radius_m"])


@effect("time", 0.01, 0.2, "recorded F(t) = F of the motion at t - delay", lambda x, d: {"delay_s": x})
def time_delay(c, q):
    raise NotImplementedError("physics.predict shifts the motion")


@effect("rig", 0.6 * MM, 4 * MM, "tip force = mean of c_f g over a ball", lambda x, d: {"radius_m": x})
def tip_ball(rig, probe, q):
    # own: 2 radii (Gauss for r^2 dr) times 14 directions, exact to degree 5
    signs = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T / np.sqrt(3)
    on_sphere = np.concatenate([np.eye(3), -np.eye(3), signs])
    weights = np.concatenate([np.full(6, 1 / 15), np.full(8, 3 / 40)])
    far, near = 5 / 9 + np.sqrt(25 / 81 - 5 / 21), 5 / 9 - np.sqrt(25 / 81 - 5 / 21)
    outer = (0.6 - near) / (far - near)
    nodes = np.concatenate([np.sqrt(far) * on_sphere, np.sqrt(near) * on_sphere])
    rig.ball = q["radius_m"] * nodes, np.concatenate([outer * weights, (1 - outer) * weights])


# ---- outside the catalogue --------------------------------------------------------------------------------------

@effect("elastic", 0.02, 5.0, "a (exp(b d) - 1) towards the axis, d the depth in a soft layer on part of the side wall",
        lambda x, d: {"force_N": x, "angle_rad": d["angle"], "half_angle_rad": d["half"],
                      "thickness_m": d["thick"], "steepness_per_m": d["steep"] / d["thick"],
                      "depth_m": d["depth"], "half_length_m": d["long"], "_bone": d["bone"]},
        lambda rng, bone, probe: {"angle": rng.uniform(-np.pi, np.pi), "half": rng.uniform(0.7, 1.4),
                                  "thick": rng.uniform(1.5, 2.5) * MM, "steep": rng.uniform(1.5, 3.0),
                                  "depth": rng.uniform(0.45, 0.85) * bone.length_m, "long": rng.uniform(6, 10) * MM,
                                  "bone": bone})
def tissue_flap(p, force, q):
    x, past = in_tract(q["_bone"], p)
    turn = np.angle(np.exp(1j * (np.arctan2(x[..., 1], x[..., 0]) - q["angle_rad"])))
    share = np.exp(-(turn / q["half_angle_rad"]) ** 4 - ((x[..., 2] - q["depth_m"]) / q["half_length_m"]) ** 4)
    depth = np.clip(past + q["thickness_m"], 0, 1.4 * q["thickness_m"])
    inward = -np.stack([x[..., 0], x[..., 1], 0 * past], -1) / np.append(q["_bone"].radii_m, 1) ** 2
    push = q["force_N"] * share * np.expm1(q["steepness_per_m"] * depth)
    return push[..., None] * inward / np.maximum(size(inward), 1e-3) @ q["_bone"].frame.T


@effect("elastic", 0.2, 1.2, "c_f (I + e (m m' - I/3)) g with m a direction of the bone in V",
        lambda x, d: {"anisotropy": x, "axis": list(d["axis"])}, lambda rng, bone, probe: {"axis": direction(rng)})
def anisotropic_wall(p, force, q):
    m = np.array(q["axis"])
    return q["anisotropy"] * ((force @ m)[..., None] * m - force / 3)


@effect("rig", 0.05, 0.6, "unloaded shank at angle (z - z_k) (cos beta, sin beta) beyond a kink near the tip",
        lambda x, d: {"angle_rad": x, "kink_from_tip_m": d["kink"], "direction_rad": d["beta"]},
        lambda rng, bone, probe: {"kink": rng.uniform(8, 16) * MM, "beta": rng.uniform(-np.pi, np.pi)})
def set_bend(rig, probe, q):
    beyond = np.maximum(0, rig.z - rig.length + q["kink_from_tip_m"])[:, None]
    to = np.array([np.cos(q["direction_rad"]), np.sin(q["direction_rad"])])
    rig.rest = rig.rest + q["angle_rad"] * beyond * to


@effect("points", 0.15, 0.8, "F - q1 - q2, dq_k/dt = (share/2 F - q_k)/tau_k at each point",
        lambda x, d: {"share": x, "fast_s": d["fast"], "slow_s": d["slow"]},
        lambda rng, bone, probe: {"fast": between(rng, 0.15, 0.5), "slow": between(rng, 1.5, 5)})
def wall_creep(c, q):
    return -q["share"] / 2 * (low_pass(c.force, c.dt, q["fast_s"]) + low_pass(c.force, c.dt, q["slow_s"]))


@effect("points", 0.3, 6.0, "stiffness x overlap of tip and chip, up to a yield force at which the chip is shoved away",
        lambda x, d: {"yield_N": x, "stiffness_N_per_m": x / (0.6 * MM), "radius_m": d["radius"], "_at": d["at"]},
        lambda rng, bone, probe: {"radius": rng.uniform(1.5, 2.5) * MM,
                                  "at": rng.uniform([-.5, -.5, .6], [.5, .5, .9], (64, 3))})
def moving_debris(c, q):
    tip = in_tract(c.bone, c.p[:, :, 0])[0]
    widest = np.append(c.bone.radii_m, c.bone.length_m)
    chip, stiff, force = q["_at"][:len(tip)] * widest, q["stiffness_N_per_m"], np.zeros_like(tip)
    for j in range(tip.shape[1]):
        away = tip[:, j] - chip
        away[:, 2] = np.where(np.abs(away).sum(-1) < 1e-9, -1e-9, away[:, 2])
        overlap = np.maximum(0, q["radius_m"] - size(away))
        chip = chip - unit(away) * np.maximum(0, overlap - q["yield_N"] / stiff)
        side = np.hypot(chip[:, 0] / widest[0], chip[:, 1] / widest[1])[:, None]
        chip[:, :2] *= 0.7 / np.maximum(side, 0.7)  # the walls of the tract keep it in
        chip[:, 2] = np.clip(chip[:, 2], 3 * MM, c.bone.length_m - 1 * MM)
        away = tip[:, j] - chip
        push = np.minimum(stiff * np.maximum(0, q["radius_m"] - size(away)), 1.5 * q["yield_N"])
        force[:, j] = push * away / np.maximum(size(away), 1e-9)
    return at_tip(c, force @ c.bone.frame.T)


@effect("elastic", 3e5, 1e9, "+ b d^2 along the field, d the depth beyond the analytic wall moved in by moved_in_m",
        lambda x, d: {"stiffening_N_per_m2": x, "moved_in_m": d["inset"], "_bone": d["bone"]},
        lambda rng, bone, probe: {"inset": rng.uniform(1.2, 2.2) * bone.spacing_m.mean(), "bone": bone})
def depth_stiffening(p, force, q):
    x, past = in_tract(q["_bone"], p)
    depth = np.maximum(0, np.maximum(past, x[..., 2] - q["_bone"].length_m) + q["moved_in_m"])[..., None]
    depth = depth * (x[..., 2:] > 0)
    return q["stiffening_N_per_m2"] * np.minimum(depth, 2 * MM) ** 2 * force / (size(force) + 1e-3)


@effect("rig", 0.5 * MM, 3 * MM, "tip force = c_f g on the ball's surface, weights exp(sharpness x blurred opacity)",
        lambda x, d: {"radius_m": x, "sharpness": 12.0})
def ball_other_size(rig, probe, q):
    nodes = np.array([(i, j, k) for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1) if i or j or k], float)
    rig.ball, rig.sharp = (q["radius_m"] * unit(nodes), np.ones(26)), q["sharpness"]


@effect("points", 0.1, 1.5, "-mu |F| z/delta, dz/dt = v_t - |v_t| z/delta (vector form of Dahl's law in Olsson1998)",
        lambda x, d: {"coefficient": x, "yield_displacement_m": d["way"]},
        lambda rng, bone, probe: {"way": between(rng, 0.4 * MM, 2 * MM)})
def presliding_memory(c, q):
    v, way = across(c), q["yield_displacement_m"]
    touch = size(c.force) > 0.02

    def step(z, now, touches):
        keep = np.exp(-size(now) * c.dt / way)  # exact for a constant velocity
        return (z * keep + way * (1 - keep) * now / np.maximum(size(now), 1e-9)) * touches

    return -q["coefficient"] * size(c.force) / way * remember(step, np.zeros_like(v[:, 0]), v, touch)


@effect("sensor", 0.5, 1.0, "share (y - F) for the lateral force F, y'' + 2 zeta w y' + w^2 y = w^2 (F - m a)",
        lambda x, d: {"share": x, "frequency_Hz": d["frequency"], "damping_ratio": d["zeta"], "mass_kg": d["mass"]},
        lambda rng, bone, probe: {"frequency": rng.uniform(4, 9), "zeta": rng.uniform(0.05, 0.15),
                                  "mass": rng.uniform(0.01, 0.03)})
def shank_resonance(c, q):
    lever = 0.9 * c.probe.length_m
    force = c.wrench + probe_inertia(c, {"mass_kg": q["mass_kg"], "centre_m": lever})
    w, parts = 2 * np.pi * q["frequency_Hz"], 8
    h = c.dt / parts

    def step(state, now):
        y, rate = state
        for _ in range(parts):
            rate = rate + h * (w ** 2 * (now - y) - 2 * q["damping_ratio"] * w * rate)
            y = y + h * rate
        return np.stack([y, rate])

    y = np.moveaxis(remember(step, np.zeros((2, len(force), 2)), force[..., :2])[0], 0, 1)
    ring = np.concatenate([q["share"] * (y - c.wrench[..., :2]), np.zeros(y.shape[:2] + (1,))], -1)
    return along_shank(lever, ring)


@effect("points", 5.0, 500, "-c (depth/length of the tract) v at the tip, within the tract",
        lambda x, d: {"damping_Ns_per_m": x})
def depth_damping(c, q):
    x, _ = in_tract(c.bone, c.p[:, :, 0])
    return at_tip(c, -q["damping_Ns_per_m"] * np.clip(x[..., 2:] / c.bone.length_m, 0, 1) * c.v[:, :, 0])


@effect("shift", 2e-5, 5e-4, "bone displaced by compliance x (force on it), first-order lag",
        lambda x, d: {"compliance_m_per_N": x, "lag_s": d["lag"]},
        lambda rng, bone, probe: {"lag": between(rng, 0.03, 0.3)})
def bone_gives_way(c, q):
    force = c.probe.force_scale * c.total.sum(2)
    return q["compliance_m_per_N"] * low_pass(force, c.dt, q["lag_s"])
