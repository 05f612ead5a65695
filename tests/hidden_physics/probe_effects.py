"""The hidden effects of the probing generator `closed_loop_hand`: a maker for each, with its formula and its source.

A maker takes the random source and s: what the same hand did without the effect (rms values such as `force`, `speed`,
`torque`, `depth`; `work` of a trial; number of `trials`), and what the effect shall make: `aim`, in N or N m, which is
the `share` of its channel's rms. Keys such as Olsson1998 are those of the project's bibliography; "catalogue" is the
equation that `tractus effects` prints for the id; "own" is the author's.
"""
from __future__ import annotations

from math import cos, exp, log, pi, sin, sqrt
from types import SimpleNamespace

import numpy as np

from driven_probe import Effect

LAWS = {}


def law(name, formula, source):
    def keep(make):
        LAWS[name] = SimpleNamespace(formula=formula, source=source, make=make)
        return make
    return keep


def log_uniform(rng, low, high):
    return float(exp(rng.uniform(log(low), log(high))))


def either_sign(rng):
    return float(rng.choice((-1, 1)))


# ---- effects of the catalogue
@law("backlash", "K (xs - x0) + D v (1 - share within the play), xs = play(x, gap), layers chosen by xs", "catalogue")
def _(rng, s):
    return Effect({"gap_m": 2 * s.aim / s.stiffness, "damping_share": float(rng.integers(2))}, ("gap_m",))


@law("coulomb_friction", "F_c sgn v; within +-F_c at rest", "Olsson1998, Coulomb friction")
def _(rng, s):
    p = {"friction_N": s.aim}
    return Effect(p, ("friction_N",), level=lambda c: p["friction_N"])


@law("stribeck_friction", "(F_c + (F_s - F_c) exp(-(v/v_s)^2)) sgn v; within +-F_s at rest",
     "Olsson1998, Stribeck friction")
def _(rng, s):
    p = {"friction_N": 0.7 * s.aim, "breakaway_N": 0.7 * s.aim * rng.uniform(1.8, 3.0),
         "stribeck_velocity_m_s": log_uniform(rng, 2e-3, 0.012)}

    def level(c):
        fallen = exp(-min((c.speed / p["stribeck_velocity_m_s"]) ** 2, 700.0))
        return p["friction_N"] + (p["breakaway_N"] - p["friction_N"]) * fallen
    return Effect(p, ("friction_N", "breakaway_N"), level=level)


@law("depth_friction", "mu x sgn v for x >= 0; within +-mu x at rest", "catalogue")
def _(rng, s):
    p = {"slope_N_per_m": s.aim / s.depth}
    return Effect(p, ("slope_N_per_m",), level=lambda c: p["slope_N_per_m"] * max(c.x, 0.0))


@law("force_ripple", "A sin(2 pi x/p + phi)", "catalogue")
def _(rng, s):
    p = {"amplitude_N": 1.4 * s.aim, "period_m": log_uniform(rng, 8e-4, 5e-3), "phase_rad": rng.uniform(-pi, pi)}
    return Effect(p, ("amplitude_N",),
                  force=lambda c: p["amplitude_N"] * sin(2 * pi * c.x / p["period_m"] + p["phase_rad"]))


@law("hysteresis", "k z, dz/dt = v - |v| z/delta, z = 0 at the start", "Olsson1998, the Dahl model")
def _(rng, s):
    width = log_uniform(rng, 1e-4, 1e-3)
    p = {"stiffness_N_per_m": s.aim / width, "yield_displacement_m": width}
    return Effect(p, ("stiffness_N_per_m",), force=lambda c: p["stiffness_N_per_m"] * c.q[0],
                  rates=lambda c: (c.v - c.speed * c.q[0] / width,), states=(0.0,), scales=(width,))


@law("inertia", "m dv/dt, m below the force sensor", "Probing, eq. (1)")
def _(rng, s):
    return Effect({"mass_kg": s.aim / s.acceleration}, ("mass_kg",))


@law("quadratic_drag", "c v |v|", "catalogue")
def _(rng, s):
    p = {"coefficient_Ns2_per_m2": s.aim / s.speed_squared}
    return Effect(p, ("coefficient_Ns2_per_m2",), force=lambda c: p["coefficient_Ns2_per_m2"] * c.v * c.speed)


@law("viscoelastic_relaxation", "k q, dq/dt = v - q/tau, q = 0 at the start", "catalogue")
def _(rng, s):
    tau = log_uniform(rng, 0.08, 1.5)
    p = {"stiffness_N_per_m": s.aim / min(s.speed * tau, 0.5 * s.depth), "time_constant_s": tau}
    return Effect(p, ("stiffness_N_per_m",), force=lambda c: p["stiffness_N_per_m"] * c.q[0],
                  rates=lambda c: (c.v - c.q[0] / tau,), states=(0.0,), scales=(1e-3,))


@law("rotation_coupling", "(K (x - x0) + D v) / (1 + kappa |omega|)", "catalogue")
def _(rng, s):
    p = {"coefficient_s_per_rad": s.share / s.omega}
    return Effect(p, ("coefficient_s_per_rad",), eases=lambda c: 1 / (1 + p["coefficient_s_per_rad"] * c.turn))


@law("rotary_coulomb_friction", "T_c sgn omega; within +-T_c at rest", "Olsson1998, Coulomb friction")
def _(rng, s):
    p = {"torque_Nm": s.aim}
    return Effect(p, ("torque_Nm",), turn_level=lambda c: p["torque_Nm"], channel="tz_Nm")


@law("rotary_stiffness", "k theta", "catalogue")
def _(rng, s):
    p = {"stiffness_Nm_per_rad": s.aim / s.theta}
    return Effect(p, ("stiffness_Nm_per_rad",), torque=lambda c: p["stiffness_Nm_per_rad"] * c.theta, channel="tz_Nm")


@law("rotary_bias", "T_0 in the torque's reading", "catalogue")
def _(rng, s):
    p = {"torque_Nm": s.aim * either_sign(rng)}
    return Effect(p, ("torque_Nm",), reads=lambda t, force, torque, trial: np.full_like(t, p["torque_Nm"]),
                  channel="tz_Nm")


@law("sensor_bias", "F_0 in the force's reading", "catalogue")
def _(rng, s):
    p = {"force_N": s.aim * either_sign(rng)}
    return Effect(p, ("force_N",), reads=lambda t, force, torque, trial: np.full_like(t, p["force_N"]))


@law("sensor_drift", "range spread_i cubic_i(t/T - 1/2) / (greatest - least value of cubic_i) in trial i",
     "catalogue; the course is own")
def _(rng, s):
    cubics = rng.normal(size=(s.trials, 4)) * (1.0, 2.0, 1.5, 1.5)
    spread = np.exp(rng.normal(0, 0.3, s.trials))
    p = {"range_N": 3 * s.aim, "cubic_coefficients": cubics.tolist(), "spread_by_trial": spread.tolist()}

    def drift(t, force, torque, trial):
        curve = np.polynomial.polynomial.polyval(t / t[-1] - 0.5, cubics[trial])
        return p["range_N"] * spread[trial] * curve / np.ptp(curve)
    return Effect(p, ("range_N",), reads=drift)


@law("time_delay", "F(t - delay), of the force alone", "catalogue")
def _(rng, s):
    p = {"delay_s": s.aim / s.force_rate}
    return Effect(p, ("delay_s",), reads=lambda t, force, torque, trial: np.interp(t - p["delay_s"], t, force) - force)


@law("torque_crosstalk", "c T_z in the force's reading", "catalogue")
def _(rng, s):
    p = {"coefficient_per_m": s.aim / s.torque * either_sign(rng)}
    return Effect(p, ("coefficient_per_m",), reads=lambda t, force, torque, trial: p["coefficient_per_m"] * torque)


# ---- effects that are in no catalogue
@law("load_friction", "mu |K (x - x0) + D v| sgn v; within this at rest", "own (Amontons' law)")
def _(rng, s):
    p = {"coefficient": s.share}
    return Effect(p, ("coefficient",), level=lambda c: p["coefficient"] * abs(c.base))


@law("direction_drag", "b v where v has the sign of direction, else 0", "own")
def _(rng, s):
    p = {"damping_Ns_per_m": 1.5 * s.aim / s.speed, "direction": either_sign(rng)}
    return Effect(p, ("damping_Ns_per_m",),
                  force=lambda c: p["damping_Ns_per_m"] * c.v if c.v * p["direction"] > 0 else 0.0)


@law("shear_thinning_drag", "c v (1 + (v/v_0)^2)^((n - 1)/2)", "Carreau 1972 (form), own use")
def _(rng, s):
    v0, n = log_uniform(rng, 2e-3, 6e-3), rng.uniform(0.2, 0.45)
    p = {"damping_Ns_per_m": s.aim / v0, "velocity_m_s": v0, "exponent": n}
    return Effect(p, ("damping_Ns_per_m",),
                  force=lambda c: p["damping_Ns_per_m"] * c.v * (1 + (c.v / v0) ** 2) ** ((n - 1) / 2))


@law("bouc_wen", "k z, dz/dt = v (1 - |z/delta|^2 (gamma + beta sgn(v z))), beta + gamma = 1, z = 0 at the start",
     "Wen 1976 (form)")
def _(rng, s):
    width, beta = log_uniform(rng, 4e-4, 1.5e-3), rng.uniform(0.55, 0.7)
    p = {"stiffness_N_per_m": s.aim / width, "yield_displacement_m": width, "beta": beta, "gamma": 1 - beta}

    def rates(c):
        return c.v * (1 - (c.q[0] / width) ** 2 * (1 - beta + (beta if c.v * c.q[0] > 0 else -beta))),
    return Effect(p, ("stiffness_N_per_m",), force=lambda c: p["stiffness_N_per_m"] * c.q[0], rates=rates,
                  states=(0.0,), scales=(width,))


@law("work_softening",
     "K (1 - d / (1 + exp((W_c - W)/w))), W = integral of max((K (x - x0) + D v) v, 0) dt of the trial", "own")
def _(rng, s):
    p = {"loss": 1.4 * s.share, "threshold_J": s.work * rng.uniform(0.35, 0.6),
         "width_J": s.work * rng.uniform(0.02, 0.06)}

    def softens(c):
        return 1 - p["loss"] / (1 + exp(min((p["threshold_J"] - c.q[0]) / p["width_J"], 50.0)))
    return Effect(p, ("loss",), softens=softens, rates=lambda c: (max(c.base * c.v, 0.0),),
                  states=(0.0,), scales=(s.work,))


@law("depth_texture", "sum_i A cos(k_i x + phi_i) in the bone, k_i normal with standard deviation 1/l", "own")
def _(rng, s):
    length, count = log_uniform(rng, 2e-4, 1e-3), 14
    numbers, phases = rng.normal(0, 1 / length, count).tolist(), rng.uniform(0, 2 * pi, count).tolist()
    waves = list(zip(numbers, phases))
    p = {"amplitude_N": s.aim * sqrt(2 / count), "length_m": length, "wavenumbers_rad_per_m": numbers,
         "phases_rad": phases}

    def force(c):
        return p["amplitude_N"] * sum(cos(k * c.x + phase) for k, phase in waves) if c.in_bone else 0.0
    return Effect(p, ("amplitude_N",), force=force)


@law("resonator", "m_r (omega_r^2 u + 2 zeta omega_r du/dt), u = x - y, m_r d2y/dt2 = that force on the mass at y",
     "own")
def _(rng, s):
    frequency, ratio = 2 * pi * rng.uniform(7.0, 16.0), rng.uniform(0.02, 0.06)
    p = {"mass_kg": s.aim / s.acceleration / 2, "angular_frequency_rad_s": frequency, "damping_ratio": ratio}

    def pull(c):  # states: stretch u of the spring, speed of the mass
        return frequency ** 2 * c.q[0] + 2 * ratio * frequency * (c.v - c.q[1])
    return Effect(p, ("mass_kg",), force=lambda c: p["mass_kg"] * pull(c), rates=lambda c: (c.v - c.q[1], pull(c)),
                  states=(0.0, 0.0), scales=(1e-3, 0.1))


@law("ageing_friction", "F_a ln(1 + age/age_0) sgn v, d age/dt = 1 - |v| age/D_c; within this at rest",
     "Dieterich-Ruina ageing law (form), own use")
def _(rng, s):
    slip, first = log_uniform(rng, 6e-5, 2e-4), log_uniform(rng, 0.01, 0.04)
    p = {"strength_N": s.aim, "slip_distance_m": slip, "age_0_s": first}
    return Effect(p, ("strength_N",), level=lambda c: p["strength_N"] * log(1 + max(c.q[0], 0.0) / first),
                  rates=lambda c: (1 - c.speed * c.q[0] / slip,), states=(0.0,), scales=(1.0,))


@law("breakaway_after_rest", "F_b n sgn v, dn/dt = (1 - n)/tau - |v| n/d; within this at rest", "own")
def _(rng, s):
    tau, slip = log_uniform(rng, 0.1, 0.5), log_uniform(rng, 1e-4, 4e-4)
    p = {"strength_N": 2 * s.aim, "time_constant_s": tau, "slip_distance_m": slip}
    return Effect(p, ("strength_N",), level=lambda c: p["strength_N"] * c.q[0],
                  rates=lambda c: ((1 - c.q[0]) / tau - c.speed * c.q[0] / slip,), states=(0.0,), scales=(1.0,))


@law("stiffness_varies_by_trial", "K (1 + d g_i) in trial i, g_i normal", "own")
def _(rng, s):
    normal = rng.normal(size=s.trials).tolist()
    p = {"spread": s.share, "normal_by_trial": normal}
    return Effect(p, ("spread",), softens=lambda c: 1 + p["spread"] * normal[c.trial])


@law("lateral_load_friction", "F_l (1 + sin(w_i t + phi_i)) / 2 sgn v in the bone, in trial i; within this at rest",
     "own")
def _(rng, s):
    turns, phases = (2 * pi * rng.uniform(0.15, 0.6, s.trials)).tolist(), rng.uniform(0, 2 * pi, s.trials).tolist()
    p = {"friction_N": 1.6 * s.aim, "angular_frequencies_rad_s": turns, "phases_rad": phases}

    def level(c):
        return p["friction_N"] * (1 + sin(turns[c.trial] * c.t + phases[c.trial])) / 2 if c.in_bone else 0.0
    return Effect(p, ("friction_N",), level=level)
