"""Recurrences on a fixed time grid, and the sensor chain with which programmed drives and oscillators are recorded.

The chain, in this order: anti-alias filter, white noise, slow thermal wander, clipping, sampling, quantisation of every
channel, dropped rows, rounded time stamps. All signals are one trial each, on a grid of constant rate.
"""
import numpy

BUTTERWORTH_4 = (0.7653668647301796, 1.8477590650225735)  # damping terms of the two second-order factors of order 4


def linear_recurrence(factor, addend, start=0.0):
    """Returns y with y[n] = factor[n] y[n-1] + addend[n], where y[-1] is start; steps are composed by doubling."""
    kind = numpy.result_type(factor, addend, start)
    factor, total = numpy.array(numpy.broadcast_to(factor, len(addend)), kind), numpy.array(addend, kind)
    total[0] += factor[0] * start
    factor[0] = 0.0
    span = 1
    while span < len(total) and numpy.abs(factor).max() > 1e-30:
        total[span:] = total[span:] + factor[span:] * total[:-span]
        factor[span:] = factor[span:] * factor[:-span]
        span *= 2
    return total


def bounded_recurrence(low, high, start):
    """Returns y with y[n] = min(max(y[n-1], low[n]), high[n]), where y[-1] is start; needs low <= high everywhere."""
    low, high = numpy.array(low), numpy.array(high)
    low[0] = high[0] = min(max(start, low[0]), high[0])
    span = 1
    while span < len(low) and (high - low).max() > 0.0:
        new_low = numpy.clip(low[:-span], low[span:], high[span:])
        high[span:] = numpy.clip(high[:-span], low[span:], high[span:])
        low[span:] = new_low
        span *= 2
    return low


def rms(signals):
    """Returns the root mean square of one array or of a list of arrays."""
    signals = signals if isinstance(signals, list) else [signals]
    return float(numpy.sqrt(sum(numpy.sum(s * s) for s in signals) / sum(len(s) for s in signals)))


def log_uniform(random, low, high):
    """Returns a random number whose logarithm is uniform."""
    return float(numpy.exp(random.uniform(numpy.log(low), numpy.log(high))))


def low_pass(signal, cutoff_Hz, rate_Hz, compensated):
    """Filters with an analogue Butterworth filter of order 4; compensated: shifted early by its delay at 0 Hz.

    The transfer function is 1 / product of (s^2 + b s + 1) at s = i f / cutoff (Butterworth 1930); its delay at 0 Hz is
    the sum of the two b over 2 pi cutoff.
    """
    before = int(0.2 * rate_Hz)
    size = 1 << int(numpy.ceil(numpy.log2(len(signal) + 3 * before)))
    after = size - len(signal) - before
    ramp = 0.5 - 0.5 * numpy.cos(numpy.linspace(0.0, numpy.pi, after))
    padded = numpy.concatenate([numpy.full(before, signal[0]), signal, signal[-1] + ramp * (signal[0] - signal[-1])])
    frequency = numpy.fft.rfftfreq(size, 1.0 / rate_Hz) / cutoff_Hz
    gain = 1.0 / numpy.prod([1.0 - frequency**2 + 1j * b * frequency for b in BUTTERWORTH_4], axis=0)
    if compensated:
        gain = gain * numpy.exp(1j * sum(BUTTERWORTH_4) * frequency)
    return numpy.fft.irfft(numpy.fft.rfft(padded) * gain, size)[before : before + len(signal)]


def slow_course(random, duration_s):
    """Returns a function of time with range 1 over the trial: a warm-up and two slow half waves."""
    warm, first, second = random.normal(size=3)
    constant_s = duration_s * random.uniform(0.3, 1.0)

    def shape(time):
        part = time / duration_s
        return (warm * (1.0 - numpy.exp(-time / constant_s)) + 0.5 * first * numpy.cos(numpy.pi * part)
                + 0.3 * second * numpy.cos(2.0 * numpy.pi * part))

    span = shape(numpy.linspace(0.0, duration_s, 200))
    low, high = span.min(), span.max()
    return lambda time: (shape(time) - 0.5 * (low + high)) / (high - low)


def draw_sensor(random, force_rms_N, torque_rms_Nm, rates_Hz=(200, 500, 500, 1000, 1000, 1000, 4000, 10000)):
    """Draws the sensor chain of one set."""
    rate_Hz = float(random.choice(rates_Hz))
    return {
        "rate_Hz": rate_Hz,
        "antialias_cutoff_Hz": 0.4 * rate_Hz,
        "antialias_on": str(random.choice(["all channels", "force and torque, their delay compensated"])),
        "white_noise_sd_N": force_rms_N * log_uniform(random, 0.001, 0.004),
        "white_noise_sd_Nm": torque_rms_Nm * log_uniform(random, 0.001, 0.004),
        "wander_range_N": 0.0,
        "wander_share_of_noise": float(random.choice([0.0, random.uniform(0.2, 1.0)])),
        "clips": bool(random.integers(15) == 0),
        "clip_share": random.uniform(0.002, 0.01),
        "clip_range_N": None,
        "force_step_N": float(random.choice([0.001, 0.002, 0.005, 0.01, 0.02])),
        "torque_step_Nm": float(random.choice([1e-5, 2e-5, 5e-5])),
        "position_step_m": float(random.choice([5e-8, 1e-7, 2e-7, 5e-7, 1e-6])),
        "angle_step_rad": float(2.0 * numpy.pi / random.choice([2**16, 2**18, 2**20])),
        "dropped_share": float(random.choice([0.0, random.uniform(0.0, 0.005)])),
        "longest_gap_s": 0.02,
        "time_step_s": float(random.choice([1e-6, 1e-4])),
        "dropped_rows": 0,
        "clipped_rows": 0,
    }


def quantised(values, step, decimals):
    """Rounds to whole steps, and then to decimals so that the text of the value is short."""
    return numpy.round(numpy.round(values / step) * step, decimals) + 0.0


def kept_rows(random, count, sensor):
    """Returns which rows survive: single rows and gaps of up to 20 ms are lost until the drawn share is reached."""
    kept = numpy.ones(count, dtype=bool)
    to_lose = sensor["dropped_share"] * count
    longest = max(1, int(sensor["longest_gap_s"] * sensor["rate_Hz"]) - 1)
    while (~kept).sum() < to_lose - 0.5:
        size = min(int(random.integers(1, longest + 1)), int(to_lose - (~kept).sum() + 0.5))
        begin = int(random.integers(1, count - size - 1))
        kept[begin : begin + size] = False
    return kept


def record(random, sensor, grid_Hz, x_m, fz_N, theta_rad=None, tz_Nm=None):
    """Records one trial. Returns its columns, the whole error of the force and the error without that of the filter.

    The whole error is recorded minus true force, each late by the same delay if every channel is filtered. The sensor's
    counts of dropped and clipped rows are brought up to date.
    """
    every = int(round(grid_Hz / sensor["rate_Hz"]))
    time = numpy.arange(0, len(x_m), every) / grid_Hz
    all_channels = sensor["antialias_on"] == "all channels"

    def sampled(signal, filtered):
        if filtered and every > 1:
            signal = low_pass(signal, sensor["antialias_cutoff_Hz"], grid_Hz, compensated=not all_channels)
        return signal[::every]

    filtered_force = sampled(fz_N, True)
    force = filtered_force + random.normal(0.0, sensor["white_noise_sd_N"], len(time))
    sensor["wander_range_N"] = sensor["wander_share_of_noise"] * sensor["white_noise_sd_N"]
    force = force + sensor["wander_range_N"] * slow_course(random, time[-1])(time)
    if sensor["clip_range_N"] is not None:
        sensor["clipped_rows"] += int((numpy.abs(force) > sensor["clip_range_N"]).sum())
        force = numpy.clip(force, -sensor["clip_range_N"], sensor["clip_range_N"])
    force = quantised(force, sensor["force_step_N"], 4)
    columns = {"t_s": numpy.round(numpy.round(time / sensor["time_step_s"]) * sensor["time_step_s"], 6),
               "x_m": quantised(sampled(x_m, all_channels), sensor["position_step_m"], 9)}
    if theta_rad is not None:
        torque = sampled(tz_Nm, True) + random.normal(0.0, sensor["white_noise_sd_Nm"], len(time))
        columns["theta_rad"] = quantised(sampled(theta_rad, all_channels), sensor["angle_step_rad"], 7)
        columns["fz_N"] = force
        columns["tz_Nm"] = quantised(torque, sensor["torque_step_Nm"], 6)
    else:
        columns["fz_N"] = force
    kept = kept_rows(random, len(time), sensor)
    sensor["dropped_rows"] += int((~kept).sum())
    reference = sampled(fz_N, False)
    if all_channels and every > 1:  # every channel is late by the same delay, which is no error
        late = sum(BUTTERWORTH_4) / (2.0 * numpy.pi * sensor["antialias_cutoff_Hz"])
        reference = numpy.interp(time - late, numpy.arange(len(fz_N)) / grid_Hz, fz_N)
    columns = {name: column[kept] for name, column in columns.items()}
    return columns, (force - reference)[kept], (force - filtered_force)[kept]


def share_left(contributions, columns):
    """Returns the share of a contribution's rms that is left after a linear fit of the columns, over all trials."""
    matrix = numpy.concatenate(columns)
    wanted = numpy.concatenate(contributions)
    size = numpy.sqrt((matrix**2).sum(axis=0))
    matrix = matrix[:, size > 0] / size[size > 0]
    solution = numpy.linalg.lstsq(matrix, wanted, rcond=1e-9)[0]
    return rms(wanted - matrix @ solution) / rms(wanted)
