"""Probing sets from oscillators and a servo axis of the literature: the recorded force drives the recorded motion.

The base is m a + c v + k (x - x0) = F; hidden is the element that the publication adds to it. All trials of a set are
advanced together on a fixed grid: half a drift, a kick of the velocity by the forces in the middle of the step (viscous
part by the trapezoidal rule), half a drift. Hysteretic states are advanced exactly in the distance, dry friction is
semi-implicit: it takes at most the whole velocity, so that a mass may stick.

An element on the rig of its publication has the published numbers, and is therefore not scaled: such a set is accepted
if at least 3 % of the force is left after a linear refit of the base. Any other element is scaled to 4 to 10 % of the
force on short trials, and half of it must be left.

Sources: Noel2016 (J. P. Noel, M. Schoukens: Hysteretic benchmark with a dynamic nonlinearity), Wigren2013 (T. Wigren,
J. Schoukens: Three free data sets for development and benchmarking in nonlinear system identification), Dahl1976
(P. R. Dahl: Solid friction damping of mechanical vibrations), Janot2019 (A. Janot, M. Gautier, M. Brunot: Data set and
reference models of EMPS), Kovacic2011 (I. Kovacic, M. J. Brennan: The Duffing equation). "eq. ?": the equation is the
known one; its number was not looked up.
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
from motor_programs import stroke  # noqa: E402
from motor_recording import log_uniform, rms  # noqa: E402

NAME = "oscillators"
RIG = "probing"

Oscillator = collections.namedtuple("Oscillator", "mass_kg damping_Ns_per_m stiffness_N_per_m middle_m grid_Hz "
                                    "rates_Hz band_Hz force_N position_steps_m source")
OSCILLATORS = {
    "bouc_wen": Oscillator(2.0, 10.0, 5e4, 0.02, 15000.0, (750, 1500, 3000), (5.0, 150.0), (25.0, 60.0), (2e-9, 1e-8),
                           "Noel2016, eq. ?; numbers as its table has them, 50 N rms and 750 Hz there"),
    # Wigren2013 prints the equation; the circuit is in volts, so that the numbers are own: 70 Hz, 5 % of damping
    "silverbox": Oscillator(0.5, 22.0, 96720.0, 0.02, 19531.25, (610.3515625, 2441.40625), (1.0, 200.0), (8.0, 25.0),
                            (1e-9, 5e-9), "Wigren2013, eq. ?; numbers own"),
    "dahl": Oscillator(1.0, 4.0, 3950.0, 0.1, 20000.0, (500, 1000, 4000), (1.0, 30.0), (6.0, 15.0), (5e-9, 2e-8),
                       "Dahl1976, eq. ?, oscillator with solid friction; numbers own"),
    "servo_axis": Oscillator(95.1089, 203.5034, 0.0, 0.02, 20000.0, (1000,), None, None, (1e-7, 5e-7),
                             "Janot2019 (EMPS), symmetric model; drive 35.15 N/V, gains 160.18 1/s and 243.45 V s/m"),
}
DRIVE_N_PER_V, POSITION_GAIN, SPEED_GAIN, LIMIT_V = 35.15, 160.18, 243.45, 10.0  # Janot2019, closed loop at 1 kHz

# Element: the rig of its publication; parameters there; parameters elsewhere from the rms of force, path and speed, of
# which those in FORCES are then scaled.
Element = collections.namedtuple("Element", "home published elsewhere formula")
IN_CATALOGUE = {
    "hysteresis": Element("dahl", {"stiffness_N_per_m": 4000.0, "yield_displacement_m": 2.5e-4}, lambda f, x, v: {
        "stiffness_N_per_m": 0.8 * f / x, "yield_displacement_m": 0.1 * x}, "k z, dz/dt = v - |v| z / delta"),
    "coulomb_friction": Element("servo_axis", {"friction_N": 20.3935}, lambda f, x, v: {"friction_N": 0.08 * f},
                                "friction sgn v; at standstill what holds the mass, up to friction"),
    # breakaway and velocity own: Janot2019 prints no Stribeck model
    "stribeck_friction": Element(
        "servo_axis", {"friction_N": 20.3935, "breakaway_N": 32.0, "stribeck_velocity_m_s": 0.008}, lambda f, x, v: {
            "friction_N": 0.06 * f, "breakaway_N": 0.12 * f, "stribeck_velocity_m_s": 0.3 * v},
        "(Fc + (Fs - Fc) exp(-(v/vs)^2)) sgn v; at standstill what holds the mass, up to Fs"),
    "sensor_bias": Element("servo_axis", {"force_N": -3.1648}, lambda f, x, v: {"force_N": -0.08 * f},
                           "constant force"),
    "inertia": Element("servo_axis", {"mass_kg": 95.1089}, None, "m a, the whole mass: the model has none"),
}
IN_NO_CATALOGUE = {
    "bouc_wen_hysteresis": Element(  # Noel2016, eq. ?, with nu = 1
        "bouc_wen", {"alpha_N_per_m": 5e4, "beta_per_m": 1e3, "gamma": 0.8, "delta": -1.1}, lambda f, x, v: {
            "alpha_N_per_m": 0.3 * f / x, "beta_per_m": 2.0 / x, "gamma": 0.8, "delta": -1.1},
        "z, dz/dt = alpha v - beta (gamma |v| z + delta v |z|)"),
    "cubic_stiffness": Element(  # Wigren2013, eq. ?, k(y) = a + b y^2; b own
        "silverbox", {"stiffness_N_per_m3": 1e11}, lambda f, x, v: {"stiffness_N_per_m3": 0.02 * f / x**3}, "b x^3"),
    "direction_dependent_viscosity": Element(  # Janot2019, asymmetric model: 166.7 and 240.4 N s/m, mean 203.5
        "servo_axis", {"half_difference_Ns_per_m": -36.9}, lambda f, x, v: {"half_difference_Ns_per_m": 0.08 * f / v},
        "half_difference |v|"),
    "quadratic_stiffness": Element(  # Kovacic2011, eq. ? (Helmholtz-Duffing); number own
        None, None, lambda f, x, v: {"stiffness_N_per_m2": 0.045 * f / x**2}, "k2 x^2"),
    "cubic_damping": Element(None, None, lambda f, x, v: {"damping_Ns3_per_m3": 0.02 * f / v**3}, "c3 v^3"),  # own
    "end_stops": Element(None, None, lambda f, x, v: {"stiffness_N_per_m": 0.6 * f / x, "clearance_m": 1.3 * x},
                         "k (|x| - clearance) sgn x beyond the clearance, about the middle of the motion"),  # own
}
FORCES = {"stiffness_N_per_m", "friction_N", "breakaway_N", "force_N", "alpha_N_per_m", "stiffness_N_per_m3",
          "half_difference_Ns_per_m", "stiffness_N_per_m2", "damping_Ns3_per_m3"}
ELEMENTS = {**IN_CATALOGUE, **IN_NO_CATALOGUE}
CATALOGUE = list(IN_CATALOGUE)
OUTSIDE = list(IN_NO_CATALOGUE)


def multisine(random, count, grid_Hz, band_Hz, level_N):
    """Returns random phases at equal amplitudes on all lines of a band, from rest over 0.2 s."""
    frequency = numpy.fft.rfftfreq(count, 1.0 / grid_Hz)
    lines = (frequency >= band_Hz[0]) & (frequency <= band_Hz[1])
    signal = numpy.fft.irfft(lines * numpy.exp(2j * numpy.pi * random.uniform(size=len(lines))), count)
    rise = 0.5 - 0.5 * numpy.cos(numpy.pi * numpy.minimum(numpy.arange(count) / (0.2 * grid_Hz), 1.0))
    return level_N * rise * signal / rms(signal)


def reference(random, count, grid_Hz, middle_m):
    """Returns the position that a servo axis is told: strokes and small steps at speeds of two decades, with rests."""
    pieces, here, done = [numpy.zeros(int(0.1 * grid_Hz))], 0.0, int(0.1 * grid_Hz)
    while done < count:
        speed = log_uniform(random, 0.004, 0.15)
        goal = min(max(here + speed * random.uniform(-1.5, 1.5), 0.0), 0.2)  # at most 1.5 s away
        pieces += [stroke(here, goal, speed, log_uniform(random, 0.3, 2.0), grid_Hz)]
        here = pieces[-1][-1] if len(pieces[-1]) else here
        pieces += [numpy.full(int(random.uniform(0.02, 0.3) * grid_Hz), here)]
        done += len(pieces[-1]) + len(pieces[-2])
    return middle_m + numpy.concatenate(pieces)[:count]


def advanced(oscillator, hidden, drive):
    """Advances all trials together. Returns position, applied force and force of the hidden elements, [step][trial].

    drive is the force, [step][trial], or, where the oscillator has no band, the reference of a closed loop. The
    elements act on the motion about the oscillator's middle.
    """
    closed_loop = oscillator.band_Hz is None
    count, trials = drive.shape
    h, m, c, k = 1.0 / oscillator.grid_Hz, *oscillator[:3]
    p = {name: parameters for name, parameters in hidden}
    half_c = 0.5 * h * c / m
    position, force, extra = (numpy.empty((count, trials)) for _ in range(3))
    start = drive[0] - oscillator.middle_m if closed_loop else numpy.zeros(trials)
    x = seen = middle = start
    v = u = z = w = numpy.zeros(trials)
    bias = p["sensor_bias"]["force_N"] if "sensor_bias" in p else 0.0
    control_steps = int(round(1e-3 * oscillator.grid_Hz))
    for n in range(count):
        before, u_before = middle, u
        if not closed_loop:
            u = 0.5 * (drive[n] + drive[min(n + 1, count - 1)])
        elif n % control_steps == 0:  # Janot2019: volts from the position's error and the speed
            speed, seen = (x - seen) / 1e-3, x
            volts = SPEED_GAIN * (POSITION_GAIN * (drive[n] - oscillator.middle_m - x) - speed)
            u = DRIVE_N_PER_V * numpy.clip(volts, -LIMIT_V, LIMIT_V)
        # the force of a step is that of its middle; the recorded one belongs to the moment of the position
        position[n], force[n] = x, 0.5 * (u_before + u) if closed_loop else drive[n]
        middle = x + 0.5 * h * v
        dx = middle - before
        added = numpy.full(trials, bias)
        if "hysteresis" in p:  # Dahl: z -> delta sgn(dx) + (z - delta sgn(dx)) exp(-|dx| / delta)
            limit = p["hysteresis"]["yield_displacement_m"] * numpy.sign(dx)
            z = limit + (z - limit) * numpy.exp(-numpy.abs(dx) / p["hysteresis"]["yield_displacement_m"])
            added += p["hysteresis"]["stiffness_N_per_m"] * z
        if "bouc_wen_hysteresis" in p:  # dw/d|x| = alpha s - r w, r = beta (gamma + delta s sgn w), s = sgn dx
            q = p["bouc_wen_hysteresis"]
            heading = numpy.sign(dx)
            rate = q["beta_per_m"] * (q["gamma"] + q["delta"] * heading * numpy.sign(w))
            goal = q["alpha_N_per_m"] * heading / rate
            w = goal + (w - goal) * numpy.exp(-rate * numpy.abs(dx))
            added += w
        if "cubic_stiffness" in p:
            added += p["cubic_stiffness"]["stiffness_N_per_m3"] * middle**3
        if "quadratic_stiffness" in p:
            added += p["quadratic_stiffness"]["stiffness_N_per_m2"] * middle**2
        if "end_stops" in p:
            over = numpy.maximum(numpy.abs(middle) - p["end_stops"]["clearance_m"], 0.0)
            added += p["end_stops"]["stiffness_N_per_m"] * over * numpy.sign(middle)
        if "cubic_damping" in p:
            added += p["cubic_damping"]["damping_Ns3_per_m3"] * v**3
        if "direction_dependent_viscosity" in p:
            added += p["direction_dependent_viscosity"]["half_difference_Ns_per_m"] * numpy.abs(v)
        free = (v * (1.0 - half_c) + h / m * (u - k * middle - added)) / (1.0 + half_c)
        grip = p["coulomb_friction"]["friction_N"] if "coulomb_friction" in p else 0.0
        if "stribeck_friction" in p:
            q = p["stribeck_friction"]
            grip = grip + q["friction_N"] + (q["breakaway_N"] - q["friction_N"]) * numpy.exp(
                -((v / q["stribeck_velocity_m_s"]) ** 2))
        if p.keys() & {"coulomb_friction", "stribeck_friction"}:
            v = numpy.sign(free) * numpy.maximum(numpy.abs(free) - h * grip / m / (1.0 + half_c), 0.0)
            added += (free - v) * m / h * (1.0 + half_c)
        else:
            v = free
        x = middle + 0.5 * h * v
        extra[n] = added
    return position + oscillator.middle_m, force, extra


def driven(random, oscillator, count, trials, level_N):
    """Returns what drives the trials: force, or the reference of the closed loop."""
    if oscillator.band_Hz is None:
        return numpy.stack([reference(random, count, oscillator.grid_Hz, oscillator.middle_m)
                            for _ in range(trials)], axis=1)
    return numpy.stack([multisine(random, count, oscillator.grid_Hz, oscillator.band_Hz,
                                  level_N * random.uniform(0.6, 1.3)) for _ in range(trials)], axis=1)


def derivatives(x, grid_Hz):
    """Returns speed and acceleration of a position on the grid."""
    v = numpy.gradient(x, 1.0 / grid_Hz)
    return v, numpy.gradient(v, 1.0 / grid_Hz)


def examined(oscillator, hidden, x, force, extra):
    """Returns share and remainder after a linear refit of the base for all hidden elements together."""
    columns, wanted = [], []
    for trial in range(x.shape[1]):
        v, a = derivatives(x[:, trial], oscillator.grid_Hz)
        rows = numpy.stack([v, x[:, trial] - oscillator.middle_m] + ([] if "inertia" in dict(hidden) else [a]), axis=1)
        hidden_force = extra[:, trial] + (oscillator.mass_kg * a if "inertia" in dict(hidden) else 0.0)
        columns.append(rows[200:-200:10])
        wanted.append(hidden_force[200:-200:10])
    return rms(wanted) / rms(force.ravel()), recording.share_left(wanted, columns)


def rig_of(random, hidden):
    """Returns the rig: that of the first element's publication; one that is hidden nowhere else goes first."""
    if "inertia" in hidden:
        return "servo_axis"
    homes = [ELEMENTS[name].home for name in hidden if ELEMENTS[name].home]
    return homes[0] if homes else str(random.choice(["bouc_wen", "silverbox", "dahl", "servo_axis"]))


def sized(random, oscillator, drive, name, scale, shares):
    """Returns parameters with which an element that is foreign to the rig makes a drawn share of the force's rms."""
    parameters, target = ELEMENTS[name].elsewhere(*scale), log_uniform(random, *shares)
    for _ in range(3):
        share, _ = examined(oscillator, [(name, parameters)], *advanced(oscillator, [(name, parameters)], drive))
        factor = min(max(target / max(share, 1e-9), 0.05), 20.0)
        parameters = {key: float(value * (factor if key in FORCES else 1.0)) for key, value in parameters.items()}
    return parameters


def sufficient(name, key, share, left):
    """Returns whether enough of an element is left after a linear refit of the base."""
    return share * left >= 0.03 if ELEMENTS[name].home == key else left >= 0.5


def drawn(random, hidden, shares):
    """Draws rig, level and elements, and tries them on short trials."""
    key = rig_of(random, hidden)
    oscillator = OSCILLATORS[key]
    level_N = log_uniform(random, *oscillator.force_N) if oscillator.force_N else 0.0
    elements, enough = [], True
    if hidden:
        drive = driven(random, oscillator, int(2.5 * oscillator.grid_Hz), 8, level_N)
        x, force, _ = advanced(oscillator, [], drive)
        speed = rms([derivatives(column, oscillator.grid_Hz)[0] for column in x.T])
        scale = rms(force.ravel()), rms((x - x.mean()).ravel()), speed
    for name in hidden:
        home = ELEMENTS[name].home == key
        parameters = dict(ELEMENTS[name].published) if home else sized(random, oscillator, drive, name, scale, shares)
        elements.append((name, parameters))
        found = examined(oscillator, elements[-1:], *advanced(oscillator, elements[-1:], drive))
        enough = enough and sufficient(name, key, *found)
    return key, level_N, elements, enough


def model_of(random, oscillator, hidden):
    """Returns the base model: one layer with stiffness and damping, and the mass unless that is hidden."""
    def off(value):
        return float(f"{value * random.uniform(0.92, 1.08):.4g}")

    layer = {"start_m": 0.0, "thickness_m": 0.3, "stiffness_N_per_m": off(oscillator.stiffness_N_per_m),
             "damping_Ns_per_m": off(oscillator.damping_Ns_per_m), "equilibrium_m": oscillator.middle_m}
    fixed = ["start_m", "thickness_m", "equilibrium_m"]
    fixed += [] if oscillator.stiffness_N_per_m else ["stiffness_N_per_m"]
    mass_kg = min(off(oscillator.mass_kg), 100.0)  # the catalogue allows no more
    inertia = [] if "inertia" in hidden else [{"id": "inertia", "parameters": {"mass_kg": mass_kg}}]
    return {"format": "tractus-model/1", "rig": RIG, "name": "oscillator", "base": {"layers": [layer]},
            "fixed": [f"/base/layers/0/{name}" for name in fixed], "effects": inertia}


def make(seed, hidden, shares=(0.04, 0.10)):
    """Returns the set with this seed and these hidden elements; the same arguments give the same set.

    shares: of the force's rms, for elements that are foreign to the rig; at home they have the published numbers.
    """
    unknown = [name for name in hidden if name not in ELEMENTS]
    if unknown:
        raise ValueError(f"{unknown[0]} is no effect of {NAME}")
    for draw in range(1, 21):
        random = numpy.random.default_rng([seed, draw] + [zlib.crc32(name.encode()) for name in hidden])
        key, level_N, elements, enough = drawn(random, hidden, shares)
        if enough:
            break
    oscillator = OSCILLATORS[key]
    usual = random.uniform() < 0.8
    trials, length_s = (10, 8.0) if usual else (int(random.integers(6, 17)), random.uniform(4.0, 15.0))
    drive = driven(random, oscillator, int(length_s * oscillator.grid_Hz), trials, level_N)
    x, force, extra = advanced(oscillator, elements, drive)
    sensor = recording.draw_sensor(random, rms(force.ravel()), 0.0, oscillator.rates_Hz)
    sensor["antialias_on"] = "all channels"
    sensor["position_step_m"] = float(random.choice(oscillator.position_steps_m))
    if sensor["clips"]:
        sensor["clip_range_N"] = float(f"{numpy.quantile(numpy.abs(force), 1.0 - sensor['clip_share']):.3g}")
    recorded, errors = [], []
    for i in range(trials):
        # the base is linear and every channel is filtered alike, so that the filter adds no error
        columns, _, error = recording.record(random, sensor, oscillator.grid_Hz, x[:, i], force[:, i])
        recorded.append((f"trial{i + 1:02d}", columns))
        errors.append(error)
    listed = []
    for name, parameters in elements:
        alone = (x, force, extra) if len(elements) == 1 else advanced(oscillator, [(name, parameters)], drive[:, :3])
        share, left = examined(oscillator, [(name, parameters)], *alone)
        listed.append({"id": name, "in_catalogue": name in CATALOGUE, "parameters": parameters,
                       "formula": ELEMENTS[name].formula, "channel": "fz_N", "share_of_force_rms": share,
                       "left_after_base_refit": left, "published": ELEMENTS[name].home == key})
    enough = all(sufficient(e["id"], key, e["share_of_force_rms"], e["left_after_base_refit"]) for e in listed)
    outside = any(not effect["in_catalogue"] for effect in listed)
    kind = "nothing" if not listed else "outside" if outside else "one" if len(listed) == 1 else "two"
    truth = {"generator": NAME, "seed": seed, "rig": RIG, "kind": kind, "hidden": listed, "draws": draw,
             "accepted": enough, "force_noise_sd_N": rms(errors), "force_rms_N": rms(force.ravel()),
             "base": {"oscillator": key, "mass_kg": oscillator.mass_kg, "source": oscillator.source,
                      "damping_Ns_per_m": oscillator.damping_Ns_per_m,
                      "stiffness_N_per_m": oscillator.stiffness_N_per_m, "middle_m": oscillator.middle_m},
             "model_is_off": "mass, damping and stiffness up to 8 %", "excitation_level_N": level_N,
             "sensor": sensor}
    model = model_of(random, oscillator, hidden)
    return made_set.MadeSet(model, {"name": f"oscillator {key}, seed {seed}", "simulated": True}, recorded, {}, truth)
