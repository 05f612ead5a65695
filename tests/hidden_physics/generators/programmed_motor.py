"""Probing sets from a rig whose linear and rotary motors follow programs; the force is computed on a 20 kHz grid.

Motion is prescribed (motor_programs.py). States with memory are advanced by exact exponential steps in time or in
distance. Friction is sgn(v) smoothed over 50 um/s: it is 0 at standstill, as sgn 0 = 0. The base law is that of
layered bone, F = K (x - x0) + D v (Probing, eq. (2)), outside the layers 0, and on the rotary stage
T = c omega + A sin(2 pi theta / pitch) (form of the detents: own).

Sources beside shared/doc/bibliography.md: Bagley1983 (R. L. Bagley, P. J. Torvik: A theoretical basis for the
application of fractional calculus to viscoelasticity), Ostwald1925 (power law of viscosity), DenHartog1956 (Mechanical
vibrations), Mullins1948 (softening of rubber by work), Coulomb1785 (friction in proportion to load), Janot2019 (EMPS).
"eq. ?": the equation is the known one; its number was not looked up.
"""
import collections
import math
import pathlib
import sys
import zlib

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import made_set  # noqa: E402
import motor_recording as recording  # noqa: E402
from motor_programs import GRID_HZ, STEP_S, Motion, moved  # noqa: E402
from motor_recording import linear_recurrence, log_uniform, rms  # noqa: E402

NAME = "programmed_motor"
RIG = "probing"
SLOW_M_S = 5e-5  # speed over which sgn(v) is smoothed


def sign(v):
    return numpy.tanh(v / SLOW_M_S)


def layer_of(base, x):
    """Returns the layer that each depth lies in; -1 above the bone, the count of layers below it."""
    return numpy.searchsorted(base["borders_m"], x, side="right") - 1


class State:
    """Forces of one trial while they are built up, stage by stage: depth, bone, added, torque, sensor, timing."""

    def __init__(self, motion, base):
        self.motion, self.base = motion, base
        self.depth, self.damped = motion.x, 1.0
        self.bone = self.force = self.torque = None

    def begin_bone(self):
        """Force of the layered bone at the depth that it sees (Probing, eq. (2))."""
        layer = layer_of(self.base, self.depth)
        inside = (layer >= 0) & (layer < len(self.base["stiffness_N_per_m"]))
        layer = numpy.where(inside, layer, 0)
        spring = numpy.array(self.base["stiffness_N_per_m"])[layer] \
            * (self.depth - numpy.array(self.base["equilibrium_m"])[layer])
        damper = numpy.array(self.base["damping_Ns_per_m"])[layer] * self.motion.v * self.damped
        self.bone = inside * (spring + damper)

    def begin_torque(self):
        """Torque of the rotary stage: viscous friction and detents (own form)."""
        rotary = self.base["rotary"]
        self.torque = rotary["viscous_Nms_per_rad"] * self.motion.omega + rotary["detent_Nm"] * numpy.sin(
            2 * numpy.pi * self.motion.theta / rotary["detent_pitch_rad"]) if rotary else numpy.zeros(len(self.depth))


def backlash(s, p):
    """Play operator of full width gap, centred at the start; the damper misses what the play takes, or does not."""
    x, half = s.motion.x, 0.5 * p["gap_m"]
    s.depth = recording.bounded_recurrence(x - half, x + half, x[0])
    if p["damping_share"]:
        free = numpy.abs(numpy.diff(s.depth, prepend=s.depth[0])) < 1e-15
        s.damped = numpy.where(free, 1.0 - p["damping_share"], 1.0)


def rotation_coupling(s, p):
    s.bone = s.bone / (1.0 + p["coefficient_s_per_rad"] * numpy.abs(s.motion.omega))


def work_softening(s, p):
    work = numpy.cumsum(numpy.abs(s.bone * s.motion.v)) * STEP_S
    s.bone = s.bone * (1.0 + p["surplus"] * numpy.exp(-work / p["work_J"]))


def specimen_of(motion, p):
    """Returns by how much this trial's specimen is harder (above 0) or softer, as a share of the force."""
    return p["spread"] * numpy.random.default_rng([p["pattern"], motion.index]).normal()


def unlike_specimens(s, p):
    s.bone = s.bone * (1.0 + specimen_of(s.motion, p))


def hysteresis(s, p):
    """Dahl's state, exact in the distance: over |dx| the state decays by exp(-|dx|/delta) towards delta sgn(dx)."""
    dx = numpy.diff(s.motion.x, prepend=s.motion.x[0])
    keep = numpy.exp(-numpy.abs(dx) / p["yield_displacement_m"])
    z = linear_recurrence(keep, numpy.sign(dx) * p["yield_displacement_m"] * (1.0 - keep))
    s.force += p["stiffness_N_per_m"] * z


def viscoelastic_relaxation(s, p):
    dx, tau = numpy.diff(s.motion.x, prepend=s.motion.x[0]), p["time_constant_s"]
    keep = math.exp(-STEP_S / tau)
    s.force += p["stiffness_N_per_m"] * linear_recurrence(keep, dx * (1.0 - keep) * tau / STEP_S)


def fractional_branch(s, p):
    """Spring-pot by the L1 rule: the Caputo derivative of a depth that is linear over each step."""
    order, count = p["order"], len(s.motion.x)
    powers = numpy.arange(count + 1) ** (1.0 - order)
    size = 1 << (2 * count).bit_length()
    memory = numpy.fft.rfft(numpy.diff(powers), size) * numpy.fft.rfft(numpy.diff(s.motion.x, prepend=s.motion.x[0]),
                                                                       size)
    derivative = numpy.fft.irfft(memory, size)[:count] * STEP_S**-order / math.gamma(2.0 - order)
    s.force += p["stiffness_N_s_per_m"] * derivative


def resonator(s, p):
    """A mass on a spring and damper on the probe: w'' + 2 zeta p w' + p^2 w = a by one exact complex mode."""
    natural, zeta = 2 * numpy.pi * p["frequency_Hz"], p["damping_ratio"]
    damped = natural * math.sqrt(1.0 - zeta**2)
    pole = complex(-zeta * natural, damped)
    keep = numpy.exp(pole * STEP_S)
    mode = linear_recurrence(keep, s.motion.a * (keep - 1.0) / pole)
    s.force += p["mass_kg"] * (natural**2 * mode.imag + 2 * zeta * natural * (pole * mode).imag) / damped


def since_reversal(motion):
    """Returns the distance covered since the motion last turned back."""
    way = numpy.cumsum(numpy.abs(numpy.diff(motion.x, prepend=motion.x[0])))
    heading = numpy.where(numpy.abs(motion.v) > SLOW_M_S, numpy.sign(motion.v), 0.0)
    last = numpy.maximum.accumulate(numpy.where(heading != 0.0, numpy.arange(len(way)), 0))
    heading = heading[last]
    turned = numpy.diff(heading, prepend=heading[0]) != 0.0
    return way - numpy.maximum.accumulate(numpy.where(turned, way, 0.0))


def reversal_friction(s, p):
    way = since_reversal(s.motion)
    s.force += p["friction_N"] * way / (way + p["half_way_m"]) * sign(s.motion.v)


def texture(s, p):
    random = numpy.random.default_rng(p["pattern"])
    lengths = numpy.exp(random.uniform(math.log(p["shortest_m"]), math.log(6.0 * p["shortest_m"]), 30))
    s.force += p["sd_N"] * math.sqrt(2 / 30) * (s.motion.x > 0) * sum(
        numpy.sin(2 * numpy.pi * (s.motion.x / length + random.uniform())) for length in lengths)


def course(s, p):
    random = numpy.random.default_rng([p["pattern"], s.motion.index])
    factor = random.choice([-1.0, 1.0]) * random.uniform(0.5, 1.5)
    return factor, recording.slow_course(random, s.motion.t[-1])(s.motion.t)


def sensor_drift(s, p):
    factor, shape = course(s, p)
    s.force += p["range_N"] * factor * shape


def late(signal, delay_s):
    time = numpy.arange(len(signal)) * STEP_S
    return numpy.interp(time - delay_s, time, signal)


def time_delay(s, p):
    s.force = late(s.force, p["delay_s"])


def held_force(s, p):
    every = max(1, int(round(p["interval_s"] * GRID_HZ)))
    s.force = s.force[numpy.arange(len(s.force)) // every * every]


def lagging_force(s, p):
    keep = math.exp(-STEP_S / p["time_constant_s"])
    s.force = linear_recurrence(keep, (1.0 - keep) * s.force, s.force[0])


def adds(formula):
    """Returns a law that adds formula(motion, parameters) to the force."""
    def act(s, p):
        s.force += formula(s.motion, p)
    return act


def turns(formula):
    """Returns a law that adds formula(motion, parameters) to the torque."""
    def act(s, p):
        s.torque += formula(s.motion, p)
    return act


def crosstalk(s, p):
    s.force += p["coefficient_per_m"] * s.torque


def stribeck(m, p):
    surplus = (p["breakaway_N"] - p["friction_N"]) * numpy.exp(-((m.v / p["stribeck_velocity_m_s"]) ** 2))
    return (p["friction_N"] + surplus) * sign(m.v)


def cogging(m, p):
    u = 2 * numpy.pi * m.x / p["pitch_m"]
    return p["force_N"] * (numpy.sin(u + p["phase_1_rad"]) + 0.8 * numpy.sin(2 * u + p["phase_2_rad"])
                           + 0.6 * numpy.sin(5 * u + p["phase_5_rad"]))


def ripple(m, p):
    return p["amplitude_N"] * numpy.sin(2 * numpy.pi * m.x / p["period_m"] + p["phase_rad"])


def angle(r):
    return r.uniform(-math.pi, math.pi)


DEPTH, BONE, ADDED, TORQUE, SENSOR, TIMING = range(6)
# draw(random, scale) gives the shape parameters; size names the parameter that sets how large the effect is; guess is
# where the search for it begins; tied holds parameters that keep a fixed ratio to it.
Law = collections.namedtuple("Law", "stage size guess act draw formula channel tied turns",
                             defaults=("fz_N", {}, False))


def none(r, scale):
    return {}


IN_CATALOGUE = {  # sources as `tractus effects` prints them
    "backlash": Law(DEPTH, "gap_m", 2e-4, backlash, lambda r, c: {"damping_share": float(r.integers(2))},
                    "K (y - x0) + D v, y = play of x, width gap; D (1 - damping_share) v while y stands still"),
    "coulomb_friction": Law(ADDED, "friction_N", 1.0, adds(lambda m, p: p["friction_N"] * sign(m.v)), none,
                            "friction tanh(v / 50 um/s), Olsson1998"),
    "depth_friction": Law(ADDED, "slope_N_per_m", 100.0, adds(
        lambda m, p: p["slope_N_per_m"] * numpy.maximum(m.x, 0.0) * sign(m.v)), none, "slope max(x, 0) sgn v"),
    "force_ripple": Law(ADDED, "amplitude_N", 1.0, adds(ripple),
                        lambda r, c: {"period_m": log_uniform(r, 5e-4, 4e-3), "phase_rad": angle(r)},
                        "amplitude sin(2 pi x / period + phase)"),
    "hysteresis": Law(ADDED, "stiffness_N_per_m", 1e4, hysteresis,
                      lambda r, c: {"yield_displacement_m": log_uniform(r, 4e-5, 1e-3)},
                      "k z, dz/dt = v - |v| z / delta, Dahl in Olsson1998"),
    "inertia": Law(ADDED, "mass_kg", 1.0, adds(lambda m, p: p["mass_kg"] * m.a), none, "m a"),
    "quadratic_drag": Law(ADDED, "coefficient_Ns2_per_m2", 1e3, adds(
        lambda m, p: p["coefficient_Ns2_per_m2"] * m.v * numpy.abs(m.v)), none, "c v |v|"),
    "rotary_bias": Law(TORQUE, "torque_Nm", 0.01, turns(lambda m, p: p["torque_Nm"]), none, "constant torque", "tz_Nm",
                       turns=True),
    "rotary_coulomb_friction": Law(TORQUE, "torque_Nm", 0.01, turns(
        lambda m, p: p["torque_Nm"] * numpy.tanh(m.omega / 0.01)), none, "torque tanh(omega / 0.01 rad/s)", "tz_Nm",
        turns=True),
    "rotary_stiffness": Law(TORQUE, "stiffness_Nm_per_rad", 1e-3, turns(
        lambda m, p: p["stiffness_Nm_per_rad"] * m.theta), none, "k theta", "tz_Nm", turns=True),
    "rotation_coupling": Law(BONE, "coefficient_s_per_rad", 0.05, rotation_coupling, none,
                             "bone force / (1 + kappa |omega|)", turns=True),
    "sensor_bias": Law(SENSOR, "force_N", 1.0, adds(lambda m, p: p["force_N"]), none, "constant force"),
    "sensor_drift": Law(SENSOR, "range_N", 2.0, sensor_drift, lambda r, c: {"pattern": int(r.integers(2**31))},
                        "range f g(t), g: a warm-up and slow half waves, f in 0.5 ... 1.5 of both signs, per trial"),
    "stribeck_friction": Law(ADDED, "friction_N", 1.0, adds(stribeck),
                             lambda r, c: {"ratio": r.uniform(1.6, 3.0),
                                           "stribeck_velocity_m_s": log_uniform(r, 0.004, 0.02)},
                             "(Fc + (Fs - Fc) exp(-(v/vs)^2)) tanh(v / 50 um/s), Olsson1998",
                             tied={"breakaway_N": "ratio"}),
    "time_delay": Law(TIMING, "delay_s", 2e-3, time_delay, none, "F(t - delay)"),
    "torque_crosstalk": Law(SENSOR, "coefficient_per_m", 20.0, crosstalk, none, "c tz", turns=True),
    "viscoelastic_relaxation": Law(ADDED, "stiffness_N_per_m", 500.0, viscoelastic_relaxation,
                                   lambda r, c: {"time_constant_s": log_uniform(r, 0.03, 1.0)},
                                   "k q, dq/dt = v - q / tau, q = 0 at the start"),
}
IN_NO_CATALOGUE = {
    "direction_dependent_drag": Law(ADDED, "inward_Ns_per_m", 50.0, adds(  # after Janot2019 (EMPS), asymmetric model
        lambda m, p: p["inward_Ns_per_m"] * numpy.maximum(m.v, 0.0)), none, "c max(v, 0)"),
    "position_dependent_friction": Law(ADDED, "friction_N", 3.0, adds(  # own: a tight place of the guide
        lambda m, p: p["friction_N"] * numpy.exp(-(((m.x - p["centre_m"]) / p["width_m"]) ** 2)) * sign(m.v)),
        lambda r, c: {"centre_m": r.uniform(0.2, 0.7) * c["depth_m"], "width_m": r.uniform(0.08, 0.2) * c["depth_m"]},
        "friction exp(-((x - centre) / width)^2) sgn v"),
    "fractional_viscoelasticity": Law(ADDED, "stiffness_N_s_per_m", 300.0, fractional_branch,  # Bagley1983, eq. ?
                                      lambda r, c: {"order": r.uniform(0.35, 0.6)}, "k d^order x / dt^order, Caputo"),
    "shear_thinning_drag": Law(ADDED, "coefficient", 10.0, adds(  # Ostwald1925, power law; unit N (s/m)^exponent
        lambda m, p: p["coefficient"] * numpy.sign(m.v) * numpy.abs(m.v) ** p["exponent"]),
        lambda r, c: {"exponent": r.uniform(0.3, 0.5)}, "c sgn(v) |v|^exponent"),
    "friction_growing_since_reversal": Law(ADDED, "friction_N", 2.0, reversal_friction,  # own; presliding in Olsson1998
                                           lambda r, c: {"half_way_m": log_uniform(r, 3e-4, 2e-3)},
                                           "friction s / (s + half_way) sgn v, s: distance since the last reversal"),
    "resonator": Law(ADDED, "mass_kg", 0.5, resonator,  # own; a vibration absorber, DenHartog1956, eq. ?
                     lambda r, c: {"frequency_Hz": log_uniform(r, 8.0, 30.0), "damping_ratio": r.uniform(0.01, 0.06)},
                     "m (p^2 w + 2 zeta p w'), w'' + 2 zeta p w' + p^2 w = a"),
    "work_softening": Law(BONE, "surplus", 0.3, work_softening,  # own; after Mullins1948, softening by work
                          lambda r, c: {"work_J": r.uniform(0.05, 0.2) * c["work_J"]},
                          "bone force (1 + surplus exp(-W / work)), W: work done on the bone so far in the trial"),
    "cogging_with_harmonics": Law(ADDED, "force_N", 1.0, adds(cogging),  # own; cogging of a linear motor, three orders
                                  lambda r, c: {"pitch_m": log_uniform(r, 2e-3, 8e-3), "phase_1_rad": angle(r),
                                                "phase_2_rad": angle(r), "phase_5_rad": angle(r)},
                                  "force (sin(u + p1) + 0.8 sin(2 u + p2) + 0.6 sin(5 u + p5)), u = 2 pi x / pitch"),
    "friction_eased_by_turning": Law(ADDED, "friction_N", 2.0, adds(  # own; direction of Coulomb friction in a screw
        lambda m, p: p["friction_N"] * m.v / numpy.sqrt(m.v**2 + (p["radius_m"] * m.omega) ** 2 + SLOW_M_S**2)),
        lambda r, c: {"radius_m": r.uniform(2e-3, 6e-3)}, "friction v / sqrt(v^2 + (radius omega)^2)", turns=True),
    "force_held_between_updates": Law(TIMING, "interval_s", 5e-3, held_force, none,  # own; a slow output of the sensor
                                      "force of the last multiple of the interval: a dead time of 0 ... interval"),
    "first_order_sensor_lag": Law(TIMING, "time_constant_s", 3e-3, lagging_force, none,  # own; lag of an amplifier
                                  "time_constant dF/dt + F = true force"),
    "load_friction": Law(ADDED, "coefficient", 0.1, lambda s, p: s.force.__iadd__(  # Coulomb1785: friction after load
        p["coefficient"] * numpy.abs(s.bone) * sign(s.motion.v)), none, "mu |bone force| sgn v"),
    "unlike_specimens": Law(BONE, "spread", 0.07, unlike_specimens,  # own; a new piece of bone for each trial
                            lambda r, c: {"pattern": int(r.integers(2**31))},
                            "bone force (1 + spread n), n normal per trial"),
    "bone_texture": Law(ADDED, "sd_N", 1.0, texture,  # own; trabeculae: the same pattern in every trial
                        lambda r, c: {"pattern": int(r.integers(2**31)), "shortest_m": log_uniform(r, 2e-4, 6e-4)},
                        "sd sqrt(2/30) sum of 30 sines of the depth, wavelengths shortest ... 6 shortest"),
}
LAWS = {**IN_CATALOGUE, **IN_NO_CATALOGUE}
CATALOGUE = list(IN_CATALOGUE)
OUTSIDE = list(IN_NO_CATALOGUE)


def true_forces(motion, base, hidden):
    """Returns force and torque of one trial; hidden holds pairs of id and parameters."""
    s = State(motion, base)
    for stage in range(TIMING + 1):
        if stage == BONE:
            s.begin_bone()
        elif stage == ADDED:
            s.force = s.bone.copy()
        elif stage == TORQUE:
            s.begin_torque()
        for name, parameters in hidden:
            if LAWS[name].stage == stage:
                LAWS[name].act(s, parameters)
    return s.force, s.torque


def draw_base(random, turning):
    """Draws the true base: layers with their borders, and the rotary stage."""
    layers = int(random.integers(2, 6))
    borders = numpy.concatenate([[0.0], numpy.cumsum(random.uniform(1.8e-3, 6e-3, layers))])
    middle, damping_s = log_uniform(random, 1000.0, 5000.0), 1.0 / log_uniform(random, 8.0, 50.0)
    stiffness = [middle * log_uniform(random, 0.6, 1.7) for _ in range(layers)]
    common, equilibrium, reached = random.uniform() < 0.35, [], random.uniform(0.0, 6.0)
    for begin, end, k in zip(borders, borders[1:], stiffness):
        equilibrium.append(0.0 if common else round(float(begin - reached / k), 6))
        reached = k * (end - equilibrium[-1]) * random.uniform(0.3, 1.1)
    return {
        "borders_m": [float(b) for b in borders],
        "stiffness_N_per_m": stiffness,
        "damping_Ns_per_m": [k * damping_s * log_uniform(random, 0.7, 1.4) for k in stiffness],
        "equilibrium_m": equilibrium,
        "rotary": {"viscous_Nms_per_rad": log_uniform(random, 0.004, 0.04),
                   "detent_Nm": log_uniform(random, 0.005, 0.03),
                   "detent_pitch_rad": float(random.choice([0.2618, 0.35, 0.5236]))} if turning else None,
    }


def rounded(value, digits=4):
    return float(f"{value:.{digits}g}")


def model_of(random, base, equilibrium_known):
    """Returns the model that the lab is given: the base, with numbers as a user of the rig would know them."""
    starts = [round(b, 6) for b in base["borders_m"]]
    layers = []
    for i, stiffness in enumerate(base["stiffness_N_per_m"]):
        thickness = base["borders_m"][i + 1] - base["borders_m"][i]
        if i + 1 < len(base["stiffness_N_per_m"]):  # the reader refuses layers that overlap by as little as 0.1 um
            thickness = min(thickness, starts[i + 1] - starts[i])
        equilibrium = base["equilibrium_m"][i]
        if not equilibrium_known:
            equilibrium = round(equilibrium + random.uniform(-0.1, 0.1) * thickness, 6)
        layers.append({"start_m": starts[i], "thickness_m": math.floor(thickness * 1e7 + 1e-4) / 1e7,
                       "stiffness_N_per_m": rounded(stiffness * random.uniform(0.92, 1.08)),
                       "damping_Ns_per_m": rounded(base["damping_Ns_per_m"][i] * random.uniform(0.9, 1.1)),
                       "equilibrium_m": equilibrium})
    model = {"format": "tractus-model/1", "rig": RIG, "name": "layered bone", "base": {"layers": layers},
             "fixed": ["/base/layers/*/start_m", "/base/layers/*/thickness_m"], "effects": []}
    if equilibrium_known:
        model["fixed"].append("/base/layers/*/equilibrium_m")
    if base["rotary"]:
        rotary = base["rotary"]
        model["base"]["rotary"] = {
            "viscous_Nms_per_rad": rounded(rotary["viscous_Nms_per_rad"] * random.uniform(0.9, 1.1)),
            "detent_Nm": rounded(rotary["detent_Nm"] * random.uniform(0.9, 1.1)),
            "detent_pitch_rad": rotary["detent_pitch_rad"]}
        model["fixed"].append("/base/rotary/detent_pitch_rad")
    return model


def base_columns(motion, base, channel, equilibrium_known):
    """Returns what a linear refit of the base may use, 1000 moments a second."""
    m = Motion(motion.index, *(values[::20] for values in motion[1:]))
    if channel == "tz_Nm":
        return numpy.stack([m.omega, numpy.sin(2 * numpy.pi * m.theta / base["rotary"]["detent_pitch_rad"])], axis=1)
    columns, layer = [], layer_of(base, m.x)
    for i, equilibrium in enumerate(base["equilibrium_m"]):
        inside = layer == i
        columns += [inside * m.v, inside * (m.x - equilibrium)] + ([] if equilibrium_known else [inside * 1.0])
    return numpy.stack(columns, axis=1)


def contributions(motions, base, name, parameters):
    """Returns what one effect adds to its channel, per trial, and that channel without it."""
    index = 0 if LAWS[name].channel == "fz_N" else 1
    plain = [true_forces(m, base, [])[index] for m in motions]
    return [true_forces(m, base, [(name, parameters)])[index] - f for m, f in zip(motions, plain)], plain


def sized(random, motions, base, name, scale, shares):
    """Draws the parameters of an effect so that it makes a drawn share of its channel's rms, and what it adds."""
    law, target = LAWS[name], log_uniform(random, *shares)
    shape, size, share = law.draw(random, scale), law.guess, 0.0
    ratios = {tied: shape.pop(source) for tied, source in law.tied.items()}
    for _ in range(8):
        parameters = {law.size: size, **{tied: size * ratio for tied, ratio in ratios.items()}, **shape}
        added, plain = contributions(motions, base, name, parameters)
        share = rms(added) / rms(plain)
        if abs(share / target - 1.0) < 0.02:
            break
        size *= min(max(target / max(share, 1e-9), 0.05), 20.0)
    if name in ("sensor_bias", "rotary_bias") and random.uniform() < 0.5:
        parameters[law.size] = -parameters[law.size]
    return {key: float(value) if isinstance(value, float) else value for key, value in parameters.items()}, added, share


def attempt(random, hidden, shares):
    """Draws base, motion and effects once. Returns them as a dictionary."""
    turning = any(LAWS[name].turns for name in hidden) or random.uniform() < 0.85
    base = draw_base(random, turning)
    usual = random.uniform() < 0.8
    trials = 10 if usual else int(random.integers(6, 17))
    length_s = 8.0 if usual else random.uniform(4.0, 15.0)
    motor = {"lag_s": random.uniform(0.8e-3, 3e-3), "ripple_m": log_uniform(random, 3e-7, 3e-6),
             "ripple_period_m": float(random.choice([1e-3, 2e-3, 5e-3])), "rotary_lag_s": random.uniform(5e-3, 2e-2),
             "rotary_ripple": random.uniform(0.0, 0.02)}
    air_share = random.uniform(0.15, 0.7) if "sensor_bias" in hidden else random.uniform(0.1, 0.4)
    motions = [moved(random, motor, base["borders_m"], length_s * random.uniform(0.9, 1.1), i, air_share, turning)
               for i in range(trials)]
    equilibrium_known = random.uniform() < 0.5
    plain = [true_forces(m, base, []) for m in motions]
    scale = {"depth_m": base["borders_m"][-1],
             "work_J": numpy.mean([numpy.abs(f * m.v).sum() * STEP_S for (f, _), m in zip(plain, motions)])}
    found = []
    for name in hidden:
        parameters, added, share = sized(random, motions, base, name, scale, shares)
        columns = [base_columns(m, base, LAWS[name].channel, equilibrium_known) for m in motions]
        left = recording.share_left([a[::20] for a in added], columns)
        found.append((name, parameters, share, left))
    return {"base": base, "motor": motor, "motions": motions, "equilibrium_known": equilibrium_known, "found": found,
            "air_share": air_share, "force_rms_N": rms([f for f, _ in plain]),
            "torque_rms_Nm": rms([t for _, t in plain])}


def described(name, parameters, share, left, motions):
    """Returns one hidden effect as truth.json has it."""
    parameters = dict(parameters)
    if name == "sensor_drift":
        parameters["range_N_by_trial"] = [parameters["range_N"] * course(State(m, {}), parameters)[0] for m in motions]
    if name == "unlike_specimens":
        parameters["surplus_by_trial"] = [specimen_of(m, parameters) for m in motions]
    return {"id": name, "in_catalogue": name in CATALOGUE, "parameters": parameters, "formula": LAWS[name].formula,
            "channel": LAWS[name].channel, "share_of_force_rms": share, "left_after_base_refit": left}


def make(seed, hidden, shares=(0.04, 0.10)):
    """Returns the set with this seed and these hidden effects; the same arguments give the same set.

    Each effect makes a log-uniform share of its channel's rms between the two shares.
    """
    unknown = [name for name in hidden if name not in LAWS]
    if unknown:
        raise ValueError(f"{unknown[0]} is no effect of {NAME}")
    for draw in range(1, 21):
        random = numpy.random.default_rng([seed, draw] + [zlib.crc32(name.encode()) for name in hidden])
        drawn = attempt(random, hidden, shares)
        accepted = all(left >= 0.5 and 0.875 * shares[0] < share < 1.1 * shares[1] for _, _, share, left in drawn["found"])
        if accepted:
            break
    base, motions = drawn["base"], drawn["motions"]
    effects = [(name, parameters) for name, parameters, _, _ in drawn["found"]]
    forces = [true_forces(m, base, effects) for m in motions]
    sensor = recording.draw_sensor(random, drawn["force_rms_N"], drawn["torque_rms_Nm"])
    if sensor["clips"]:
        every_force = numpy.abs(numpy.concatenate([f for f, _ in forces]))
        sensor["clip_range_N"] = rounded(numpy.quantile(every_force, 1.0 - sensor["clip_share"]), 3)
    trials, errors, unfiltered_errors = [], [], []
    for m, (force, torque) in zip(motions, forces):
        rotary = (m.theta, torque) if base["rotary"] else ()
        columns, error, unfiltered_error = recording.record(random, sensor, GRID_HZ, m.x, force, *rotary)
        trials.append((f"trial{m.index + 1:02d}", columns))
        errors.append(error)
        unfiltered_errors.append(unfiltered_error)
    model = model_of(random, base, drawn["equilibrium_known"])
    stated = {"name": f"programmed motor, seed {seed}", "simulated": True}
    if random.uniform() < 1 / 3:
        stated["noise"] = {"fz_N": rounded(math.hypot(sensor["white_noise_sd_N"], sensor["force_step_N"] / 12**0.5), 3)}
    listed = [described(*found, motions) for found in drawn["found"]]
    outside = any(not effect["in_catalogue"] for effect in listed)
    kind = "nothing" if not listed else "outside" if outside else "one" if len(listed) == 1 else "two"
    truth = {"generator": NAME, "seed": seed, "rig": RIG, "kind": kind, "hidden": listed, "accepted": accepted,
             "draws": draw, "force_noise_sd_N": rms(errors),
             "force_noise_without_filter_sd_N": rms(unfiltered_errors), "force_rms_N": drawn["force_rms_N"],
             "torque_rms_Nm": drawn["torque_rms_Nm"], "base": base,
             "model_is_off": "stiffness up to 8 %, damping, viscous and detent torque up to 10 %, equilibrium "
                             + ("exact and fixed" if drawn["equilibrium_known"] else "up to 10 % of the thickness")
                             + ", borders 0.5 um; gaps of up to 0.6 um between layers",
             "motor": drawn["motor"], "air_share": drawn["air_share"], "sensor": sensor}
    return made_set.MadeSet(model, stated, trials, {}, truth)
