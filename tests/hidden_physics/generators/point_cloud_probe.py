"""Palpation sets with hidden physics: a bending probe is a few points that a CT's blurred opacity pushes.

Volumes are made of analytic shapes; the hand is a stochastic process that circles, pokes, slides, rolls and lifts
off, and yields to the force that it causes; tracker and sensor add coloured noise. The parts are in point_cloud:
bone (volume and field), hand (motion), physics (the base law), effects (what can be hidden).
"""
import pathlib
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]
from made_set import MadeSet  # noqa: E402
from point_cloud.bone import MM, draw_bone, volume_file  # noqa: E402
from point_cloud.effects import DOWN_V, EFFECTS, between  # noqa: E402
from point_cloud.hand import draw_probe, palpate  # noqa: E402
from point_cloud.physics import equilibrium, predict, rig_of  # noqa: E402

NAME = "point_cloud_probe"
RIG = "palpation"
CATALOGUE = ["contact_damping", "contact_friction", "contact_hysteresis", "contact_nonlinearity", "pose_offset",
             "probe_inertia", "probe_weight", "sensor_bias", "sensor_drift", "shank_curvature", "shank_taper",
             "time_delay", "tip_ball"]
OUTSIDE = [
    "tissue_flap",        # a (exp(b d) - 1) towards the axis, from a soft layer on a part of the wall; own
    "anisotropic_wall",   # c_f (I + e (m m' - I/3)) g with m a direction of the bone; own
    "set_bend",           # a plastically set shank: beyond a kink near the tip it leaves at an angle; own
    "wall_creep",         # F - q1 - q2, dq/dt = (share F/2 - q)/tau with two time constants; own
    "moving_debris",      # a chip that pushes the tip, up to a yield force at which it is shoved away; own
    "depth_stiffening",   # + b d^2 along the field, d the depth past the analytic wall; own
    "ball_other_size",    # the tip's force is that at the surface of a ball that the base model does not have; own
    "presliding_memory",  # -mu |F| z/delta, dz/dt = v_t - |v_t| z/delta; vector form of the Dahl law in Olsson1998
    "shank_resonance",    # a share of the lateral force passes through a damped mode of second order; own
    "depth_damping",      # -c (depth/length of the tract) v at the tip, as of marrow in the tract; own
    "bone_gives_way",     # the bone moves by compliance x force in its clamp, with a lag; own
]
ROWS, DRAWS, LEAST_LEFT, SHARES = 15000, 20, 0.5, (0.04, 0.10)


def rms(vectors):
    """Root mean square of the vectors' length."""
    return float(np.sqrt((vectors ** 2).sum(-1).mean()))


class World:
    """One draw of probe, hand and clock on a bone, with the force that the base physics alone gives."""

    def __init__(self, seed, attempt, bone):
        self.bone, rng = bone, np.random.default_rng([seed, attempt, 1])
        self.probe = draw_probe(rng, bone)
        layout = np.random.default_rng([seed, 2])  # the same in each draw
        trials, seconds = 10, layout.uniform(7, 9)
        if layout.random() < 0.2:
            trials = int(layout.integers(6, 17))
            seconds = layout.uniform(4, min(15, 150 / trials))
        self.rate_Hz = float(layout.choice([r for r in (100, 125, 150, 200, 250) if r * trials * seconds <= ROWS]))
        self.motion = palpate(rng, bone, self.probe, trials, seconds)
        ticks = np.arange(int(seconds * self.rate_Hz))
        self.jitter = float(layout.choice([0.0, 0.02]))  # of the sensor's clock, as a share of its period
        jitter = self.jitter * rng.uniform(-1, 1, (trials, len(ticks)))
        self.t_s = np.round(np.maximum(ticks + jitter, 0) / self.rate_Hz, 5)
        self.lengths = rng.integers(int(0.88 * len(ticks)), len(ticks) + 1, trials)
        self.base, self.bend, _ = predict(bone, self.probe, self.motion, self.t_s)
        self._columns = None

    def replay_differs(self):
        """Share of samples whose shank ends elsewhere when each equilibrium starts from the last recorded one, as in a
        replay. Where it does, the wall can hold the probe on either of two sides: the base is undecided."""
        o, r = self.motion.pose(self.t_s)
        rig, delta, away = rig_of(self.probe, []), np.zeros((len(o), 2)), []
        for j in range(o.shape[1]):
            delta = equilibrium(rig, self.bone.field, o[:, j], r[:, j], delta, 0.0, 1e-4)
            away.append(np.abs(delta - self.bend[:, j]).max(-1) > 0.05 * MM)
        return float(np.mean(away))

    def wrench(self, hidden):
        """Wrench with effects, and how far its iteration was from its end, in N."""
        wrench, _, change = predict(self.bone, self.probe, self.motion, self.t_s, hidden)
        return wrench, self.probe.force_scale * change

    def base_columns(self):
        """What small changes of the base's free numbers do to the force."""
        if self._columns is None:
            self._columns = [self.base[..., :3].ravel()]  # the force scale
            for name in ["force_factor_Nm"] + ["youngs_modulus_Pa"] * (not self.probe.youngs_modulus_known):
                changed = type(self.probe)(**{**vars(self.probe), name: 1.01 * getattr(self.probe, name)})
                moved = predict(self.bone, changed, self.motion, self.t_s, start=self.bend)[0]
                self._columns.append((moved - self.base)[..., :3].ravel())
        return self._columns

    def left_share(self, difference, partner="", partners_difference=None):
        """Share of a force difference that no change of the base's free numbers takes up, linearly, nor one of a partner:
        another hidden effect, of which a refit finds the size by its own difference, or, of a drift, the course."""
        columns, y = np.stack(self.base_columns(), 1), difference.ravel()
        if partner == "sensor_drift":
            columns = np.stack([self.without_drift(c) for c in columns.T], 1)
            y = self.without_drift(y)
        elif partner:
            columns = np.column_stack([columns, partners_difference.ravel()])
        left = y - columns @ np.linalg.lstsq(columns, y, rcond=None)[0]
        return float(np.linalg.norm(left) / max(np.linalg.norm(difference), 1e-12))

    def without_drift(self, values):
        """What no course of sensor_drift takes up: in each trial and axis, a constant and three waves are free."""
        left = np.array(values).reshape(len(self.t_s), self.t_s.shape[1], 3)
        for trial, t_s in zip(left, self.t_s):
            share = (t_s - t_s[0]) / (t_s[-1] - t_s[0])
            courses = np.cos(np.pi * share[:, None] * np.arange(4))
            trial -= courses @ np.linalg.lstsq(courses, trial, rcond=None)[0]
        return left.ravel()

    def refit_beside(self, sized):
        """Adds to the figures of two effects what a refit of the base and of the other one leaves of each."""
        alone = [(self.wrench([(effect, q)])[0] - self.base)[..., :3] for effect, q, _ in sized]
        for i, (_, _, figures) in enumerate(sized):
            figures["left_after_base_and_partner_refit"] = self.left_share(alone[i], sized[1 - i][0].id, alone[1 - i])

    def size_effect(self, effect, rng, shares):
        """The effect's numbers at which it makes the drawn share of the force, and what they come to."""
        target, drawn = between(rng, *shares), effect.draw(rng, self.bone, self.probe)
        x, known = effect.start, []
        for _ in range(6):
            q = effect.numbers(x, drawn)
            wrench, change = self.wrench([(effect, q)])
            difference = (wrench - self.base)[..., :3]
            share = rms(difference) / rms(self.base[..., :3])
            if abs(np.log(max(share, 1e-9) / target)) < 0.1 or (x == effect.limit and share < target):
                break
            known.append((np.log(x), np.log(max(share, 1e-9))))
            slope = 1.0
            if len(known) > 1:
                (x0, s0), (x1, s1) = known[-2:]
                slope = np.clip((s1 - s0) / (x1 - x0) if x1 != x0 else 1.0, 0.4, 2.5)
            x = min(effect.limit, x * float(np.exp(np.clip(np.log(target / max(share, 1e-9)) / slope, -2.5, 2.5))))
        squares = np.sort((difference ** 2).sum(-1), axis=None)
        spread = float(squares[:int(0.995 * squares.size)].sum() / max(squares.sum(), 1e-24))
        return q, {"share_of_force_rms": share, "left_after_base_refit": self.left_share(difference),
                   "energy_outside_largest_0.5_percent": spread,
                   "unsettled_share": change / max(rms(difference), 1e-12)}


def coloured(rng, shape, dt, sd, tau_s, white):
    """Noise along axis 1: a white part and a part with an exponential autocorrelation of time constant tau."""
    keep, grains = np.exp(-dt / tau_s), rng.standard_normal(shape)
    slow = np.empty(shape)
    slow[:, 0] = grains[:, 0]
    for j in range(1, shape[1]):
        slow[:, j] = keep * slow[:, j - 1] + np.sqrt(1 - keep ** 2) * grains[:, j]
    return sd * (np.sqrt(1 - white) * slow + np.sqrt(white) * rng.standard_normal(shape))


def quaternion(r):
    """Unit quaternions w, x, y, z of rotations (trials, times, 3, 3), continuous along the times."""
    d = np.einsum("...ii->...i", r)
    w = np.sqrt(np.maximum(0, 1 + d.sum(-1))) / 2
    xyz = np.sqrt(np.maximum(0, 1 + 2 * d - d.sum(-1, keepdims=True))) / 2
    sign = np.stack([r[..., 2, 1] - r[..., 1, 2], r[..., 0, 2] - r[..., 2, 0], r[..., 1, 0] - r[..., 0, 1]], -1)
    q = np.concatenate([w[..., None], np.copysign(xyz, sign)], -1)
    flips = np.where((q[:, 1:] * q[:, :-1]).sum(-1) < 0, -1.0, 1.0)
    q[:, 1:] *= np.cumprod(flips, 1)[..., None]
    return q / np.linalg.norm(q, axis=-1, keepdims=True)


def rotation(q):
    w, x, y, z = np.moveaxis(q / np.linalg.norm(q, axis=-1, keepdims=True), -1, 0)
    rows = [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
            2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
            2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]
    return np.stack(rows, -1).reshape(q.shape[:-1] + (3, 3))


def record(world, wrench, rng):
    """What tracker and sensor say: (positions, quaternions, wrench, all that the chain did)."""
    t, trials = world.t_s, len(world.t_s)
    facts = {"pose_rate_Hz": float(rng.choice([100, 120, 200, 250, 500, 1000])),
             "position_noise_sd_m": between(rng, 0.01, 0.1) * MM,
             "rotation_noise_sd_rad": np.radians(between(rng, 0.02, 0.1)),
             "pose_noise_time_constant_s": between(rng, 0.005, 0.06), "pose_noise_white_share": rng.uniform(0.2, 0.8),
             "force_noise_set_N": between(rng, 0.004, 0.03), "torque_noise_set_Nm": between(rng, 0.0002, 0.001),
             "wrench_noise_time_constant_s": between(rng, 0.005, 0.1),
             "wrench_noise_white_share": rng.uniform(0.2, 0.8), "force_step_N": 1 / float(rng.choice([80, 160, 320])),
             "torque_step_Nm": 1 / float(rng.choice([16000, 64000]))}
    dt = 1 / facts["pose_rate_Hz"]
    ticks = rng.uniform(0, dt, (trials, 1)) + dt * np.arange(-2, int(t.max() / dt) + 4)
    o, r = world.motion.pose(ticks)
    colour = facts["pose_noise_time_constant_s"], facts["pose_noise_white_share"]
    o = o + coloured(rng, o.shape, dt, facts["position_noise_sd_m"], *colour)
    half = coloured(rng, o.shape, dt, facts["rotation_noise_sd_rad"], *colour) / 2
    q = quaternion(r)
    w, v = q[..., :1], q[..., 1:]
    q = np.concatenate([w - (v * half).sum(-1, keepdims=True), v + w * half + np.cross(v, half)], -1)
    pose = np.concatenate([o, q], -1)
    pose = np.stack([np.stack([np.interp(t[k], ticks[k], pose[k, :, i]) for i in range(7)], -1) for k in range(trials)])
    p, q = pose[..., :3], pose[..., 3:] / np.linalg.norm(pose[..., 3:], axis=-1, keepdims=True)
    # torque counts as the force that it is at the shank's length, in gain and cross-talk
    unit = np.array([1, 1, 1] + 3 * [world.probe.length_m])
    mixing = rng.uniform(-0.01, 0.01, (6, 6)) * rng.uniform(0.2, 1.0)
    facts["gain_and_crosstalk_minus_1"] = mixing.tolist()
    said = wrench + wrench / unit @ mixing.T * unit
    sd = np.array(3 * [facts["force_noise_set_N"]] + 3 * [facts["torque_noise_set_Nm"]])
    said += coloured(rng, said.shape, 1 / world.rate_Hz, sd, facts["wrench_noise_time_constant_s"],
                     facts["wrench_noise_white_share"])
    step = np.array(3 * [facts["force_step_N"]] + 3 * [facts["torque_step_Nm"]])
    return p, q, step * np.rint(said / step), facts


class Recorded:
    """Recorded poses in the place of a motion, to see what the tracker's noise does to the force."""

    def __init__(self, o, r, delta):
        self.o, self.r, self.delta = o, r, delta

    def pose(self, _):
        return self.o, self.r

    def bending(self, _):
        return self.delta


def stated_model(seed, probe, bone, volume):
    """The base model as a user has it: what cannot be measured by ruler or data sheet is off by up to 10 %."""
    rng = np.random.default_rng([seed, 3])
    off = {"force_factor_Nm": 0.1, "force_scale": 0.05, "torque_scale": 0.05,
           "youngs_modulus_Pa": 0.0 if probe.youngs_modulus_known else 0.1}
    names = ["force_factor_Nm", "force_scale", "torque_scale", "points", "point_spacing_m", "youngs_modulus_Pa",
             "length_m", "radius_m"]
    base = {name: getattr(probe, name) for name in names}
    for name, most in off.items():
        base[name] = float(f"{base[name] * (1 + most * rng.uniform(-1, 1)):.4g}")
    base.update(pose_offset_m=[0, 0, 0], field="paper")
    fixed = ["length_m", "radius_m", "point_spacing_m", "pose_offset_m"]
    fixed += ["youngs_modulus_Pa"] * probe.youngs_modulus_known
    model = {"format": "tractus-model/1", "rig": RIG, "name": "probe in a drilled pedicle", "volume": volume,
             "transfer": bone.transfer, "base": base, "fixed": [f"/base/{name}" for name in fixed], "effects": []}
    return model, {name: getattr(probe, name) for name in names}, {name: most for name, most in off.items() if most}


def good(figures, shares=SHARES):
    """Of the wanted size, not taken up by the base, not mostly moments at which the probe snaps over edges, solved."""
    return (0.9 * shares[0] < figures["share_of_force_rms"] < 1.1 * shares[1]
            and figures["left_after_base_refit"] > LEAST_LEFT and figures["unsettled_share"] < 0.02
            and figures["energy_outside_largest_0.5_percent"] > 0.3)


def draw_hidden(seed, hidden, bone, shares):
    """World and sized effects of the first draw that is good enough, else of the best one, and whether it is."""
    best = None
    for attempt in range(DRAWS):
        world, sized = World(seed, attempt, bone), []
        peak = np.linalg.norm(world.base[..., :3], axis=-1).max()
        if (world.replay_differs() > 0.002 or not 1.0 < peak < 6.5) and attempt < DRAWS - 1:
            continue
        for name in hidden:
            rng = np.random.default_rng([seed, attempt, 4, *name.encode()])
            sized.append((EFFECTS[name], *world.size_effect(EFFECTS[name], rng, shares)))
            if not good(sized[-1][2], shares):
                break
        else:
            return world, sized, True, attempt + 1
        score = sum(good(figures, shares) + figures["left_after_base_refit"] for _, _, figures in sized)
        if len(sized) == len(hidden) and (best is None or score > best[0]):
            best = score, world, sized
    return best[1], best[2], False, DRAWS


def plain(value):
    """A number or list that JSON can hold."""
    return np.asarray(value, float).tolist() if not isinstance(value, (str, int)) else value


def make(seed, hidden, shares=SHARES):
    """A set with the named effects hidden in it; the same bytes for the same arguments.

    Each effect makes a log-uniform share of the force's rms between the two shares.
    """
    bone = draw_bone(np.random.default_rng([seed, 0]))
    world, sized, accepted, draws = draw_hidden(seed, hidden, bone, shares)
    probe, pairs = world.probe, [(effect, q) for effect, q, _ in sized]
    wrench, unsettled_N = world.wrench(pairs) if pairs else (world.base, 0.0)
    if len(sized) == 2:
        world.refit_beside(sized)
    rng = np.random.default_rng([seed, 5])
    p, q, said, sensor = record(world, wrench, rng)
    nifti = rng.random() < 0.5
    name, content = volume_file(bone, nifti)
    model, true_base, off = stated_model(seed, probe, bone, name)
    noisy = predict(bone, probe, Recorded(p, rotation(q), world.bend), world.t_s)[0]
    kept = np.arange(p.shape[1]) < world.lengths[:, None]
    noise = rms((said - wrench)[kept][:, :3])
    sensor["pose_noise_as_force_sd_N"] = rms((noisy - world.base)[kept][:, :3])
    trials, heads = [], "t_s,px_m,py_m,pz_m,qw,qx,qy,qz,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm".split(",")
    digits = [5] + 3 * [6] + 4 * [6] + 3 * [5] + 3 * [7]
    for k, rows in enumerate(world.lengths):
        table = np.concatenate([world.t_s[k, :, None], p[k], q[k], said[k]], -1)[:rows]
        trials.append((f"palpation{k + 1:02d}", {h: np.round(table[:, i], digits[i]) for i, h in enumerate(heads)}))
    told = [{"id": e.id, "in_catalogue": e.id in CATALOGUE, "formula": e.formula, **figures,
             "parameters": {key: plain(value) for key, value in numbers.items() if key[0] != "_"}}
            for e, numbers, figures in sized]
    kind = "outside" if set(hidden) & set(OUTSIDE) else ["nothing", "one", "two"][len(hidden)]
    truth = {"generator": NAME, "seed": seed, "rig": RIG, "kind": kind, "hidden": told, "accepted": accepted,
             "left_after_base_refit": min((h["left_after_base_refit"] for h in told), default=None), "draws": draws,
             "force_noise_sd_N": noise, "unsettled_N": unsettled_N, "force_rms_N": rms(wrench[kept][:, :3]),
             "force_peak_N": float(np.linalg.norm(wrench[kept][:, :3], axis=-1).max()),
             "base": {key: plain(value) for key, value in true_base.items()}, "stated_base_off_by_at_most": off,
             "base_fixed": model["fixed"], "bone": {key: plain(value) for key, value in bone.facts.items()},
             "sensor": {"rate_Hz": world.rate_Hz, "time_jitter_s": world.jitter / world.rate_Hz,
                        **{key: plain(value) for key, value in sensor.items()}}}
    stated = {"name": f"drilled pedicle {seed}", "simulated": True, "down": DOWN_V.tolist()}
    return MadeSet(model, stated, trials, {name: content}, truth)
