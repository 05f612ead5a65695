"""What the sensors leave of the force of a true model, at best, beside their own noise.

Probing: a reader of the files knows the position up to noise, mostly its counts. The force that a model makes of it has
the noise N(f) = |Z(f)|^2 S_x(f), Z = K - m w^2 + i D w, and the force itself the spectrum S_F(f). The best linear
estimate (N. Wiener, Extrapolation, Interpolation and Smoothing of Stationary Time Series, 1949) is off by
S_F N / (S_F + N) at each frequency. Forces of bone change from moment to moment, so that this is an estimate for
recordings that are stationary on average.

Palpation: each axis of the wrench sensor has a gain of its own and a share of the other axes. A refit takes up what the
three forces have in common (the model's force scale); the rest is left.
"""
from __future__ import annotations

import math

import numpy as np


def position_noise_sd_m(sensor: dict) -> float:
    """Standard deviation of the position's noise: its counts, and what is added before they are counted."""
    return sensor["position_step_m"] * math.sqrt(1 / 12 + sensor.get("position_noise_in_steps", 0.0) ** 2)


def impedance(truth: dict, frequency_Hz):
    """Z of the probing rig's true base: mean stiffness and damping of the layers, and the mass that moves, if any."""
    base, w = truth["base"], 2 * np.pi * frequency_Hz
    layers = base.get("layers")
    stiffness = base["stiffness_N_per_m"] if layers is None else [at["stiffness_N_per_m"] for at in layers]
    damping = base["damping_Ns_per_m"] if layers is None else [at["damping_Ns_per_m"] for at in layers]
    mass = base.get("mass_kg", base.get("mass_below_sensor_kg", 0.0))
    mass = max([mass] + [h["parameters"]["mass_kg"] for h in truth["hidden"] if h["id"] == "inertia"])
    return np.mean(stiffness) - mass * w**2 + 1j * np.mean(damping) * w


def spectrum(values, rate_Hz):
    """One-sided density of a signal at the frequencies of its Fourier transform, smoothed over a twentieth of an octave
    at least, after its linear trend is taken off."""
    count = len(values)
    t = np.linspace(-1, 1, count)
    window = np.hanning(count)
    rest = (values - np.polyval(np.polyfit(t, values, 1), t)) * window
    density = 2 * np.abs(np.fft.rfft(rest)) ** 2 / (rate_Hz * np.sum(window**2))
    frequency = np.fft.rfftfreq(count, 1 / rate_Hz)
    sums = np.concatenate([[0.0], np.cumsum(density)])
    half = np.maximum(2, (np.arange(len(density)) * 0.02).astype(int))
    at = np.arange(len(density))
    low, high = np.maximum(at - half, 0), np.minimum(at + half + 1, len(density))
    return frequency, (sums[high] - sums[low]) / (high - low)


def motion_floor_N(truth: dict, trials: list, noise_sd_N: float) -> float:
    """Root mean square over all trials of what the position's noise leaves of the force; noise_sd_N: of the sensor."""
    left, time = 0.0, 0.0
    for _, columns in trials:
        t, force = np.asarray(columns["t_s"]), np.asarray(columns["fz_N"])
        rate_Hz = 1 / float(np.median(np.diff(t)))
        grid = np.arange(t[0], t[-1], 1 / rate_Hz)
        frequency, density = spectrum(np.interp(grid, t, force), rate_Hz)
        true = np.maximum(density - 2 * noise_sd_N**2 / rate_Hz, 0.0)
        noise = np.abs(impedance(truth, frequency)) ** 2 * 2 * position_noise_sd_m(truth["sensor"]) ** 2 / rate_Hz
        error = true * noise / np.maximum(true + noise, 1e-300)
        left += float(np.sum(error) * (frequency[1] - frequency[0])) * grid[-1]
        time += grid[-1]
    return math.sqrt(left / time)


def crosstalk_floor_N(truth: dict, trials: list) -> float:
    """Root mean square (vector length) that gains and cross-talk of the wrench sensor leave of the force."""
    mixing = np.array(truth["sensor"]["gain_and_crosstalk_minus_1"])
    unit = np.array([1, 1, 1] + 3 * [truth["base"]["length_m"]])
    left = mixing[:3] - np.mean(np.diag(mixing)[:3]) * np.eye(6)[:3]
    names = ("fx_N", "fy_N", "fz_N", "tx_Nm", "ty_Nm", "tz_Nm")
    wrench = np.concatenate([np.stack([columns[n] for n in names], 1) for _, columns in trials])
    return float(np.sqrt(np.mean(np.sum((wrench / unit @ left.T) ** 2, 1))))
