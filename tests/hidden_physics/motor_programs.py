"""Motion of a rig whose linear and rotary motors follow programs, on a 20 kHz grid.

Strokes of trapezoidal velocity, staircases with holds, sums of sines, chirps, pulses, and small reversals inside each
layer. Each motor follows its command with a small lag and has a ripple of its own.
"""
import collections
import math

import numpy

from motor_recording import linear_recurrence, log_uniform

GRID_HZ = 20000.0
STEP_S = 1.0 / GRID_HZ

Motion = collections.namedtuple("Motion", "index t x v a theta omega")


def stroke(start_m, goal_m, speed_m_s, acceleration_m_s2, grid_Hz=GRID_HZ):
    """Returns the positions of a move of trapezoidal velocity, start left out, goal included."""
    length = abs(goal_m - start_m)
    if length == 0.0:
        return numpy.zeros(0)
    speed = min(speed_m_s, math.sqrt(length * acceleration_m_s2))
    ramp = speed / acceleration_m_s2
    total = length / speed + ramp
    time = numpy.minimum(numpy.arange(1, int(numpy.ceil(total * grid_Hz)) + 1) / grid_Hz, total)
    left = total - time
    way = numpy.where(time < ramp, 0.5 * acceleration_m_s2 * time**2, speed * (time - 0.5 * ramp))
    way = numpy.where(left < ramp, length - 0.5 * acceleration_m_s2 * left**2, way)
    return start_m + numpy.sign(goal_m - start_m) * way


def wave(random, kind, duration_s, reach_m, speed_m_s):
    """Returns offsets of a sum of sines, a chirp or pulses that begins and ends at 0, within a reach and a speed."""
    time = numpy.arange(1, int(duration_s * GRID_HZ) + 1) * STEP_S
    if kind == "sines":
        offset = sum(random.uniform(0.3, 1.0) / f**0.5 * numpy.sin(2 * numpy.pi * (f * time + random.uniform()))
                     for f in numpy.exp(random.uniform(numpy.log(0.6), numpy.log(12.0), 5)))
    elif kind == "chirp":
        low, high = 0.5, random.uniform(6.0, 15.0)
        rate = low + 0.5 * (high - low) * time / duration_s
        offset = numpy.sin(2 * numpy.pi * rate * time) / (1.0 + rate)
    else:
        offset = numpy.zeros(len(time))
        centre = 0.1
        while centre < duration_s - 0.1:
            half = random.uniform(0.025, 0.07)
            inside = numpy.abs(time - centre) < half
            height = random.choice([-1.0, 1.0]) * random.uniform(0.3, 1.0)
            offset[inside] += height * (0.5 + 0.5 * numpy.cos(numpy.pi * (time[inside] - centre) / half))
            centre += 2 * half + random.uniform(0.03, 0.1)
    ends = numpy.minimum(numpy.minimum(time, duration_s - time) / 0.1, 1.0)
    offset = offset * (0.5 - 0.5 * numpy.cos(numpy.pi * ends))
    scale = min(reach_m / numpy.abs(offset).max(), speed_m_s / (numpy.abs(numpy.diff(offset)).max() * GRID_HZ))
    return offset * scale


def program(random, borders_m, duration_s, index, air_share):
    """Returns the commanded position of one trial; the trial's first visit is to a layer of its own."""
    layers = len(borders_m) - 1
    air_m = -random.uniform(0.4e-3, 3e-3)
    bottom_m = borders_m[-1] - 1e-4
    here = air_m if random.uniform() < 0.75 else random.uniform(0.0, bottom_m)
    pieces, count = [numpy.full(int(0.1 * GRID_HZ), here)], 0

    def add(positions):
        nonlocal here, count
        pieces.append(positions)
        count += len(positions)
        here = positions[-1] if len(positions) else here

    def move(goal, speed=None):
        add(stroke(here, goal, speed or log_uniform(random, 0.004, 0.08), log_uniform(random, 0.15, 2.0)))

    def hold(seconds):
        add(numpy.full(int(seconds * GRID_HZ), here))

    visit = index
    while count < duration_s * GRID_HZ:
        if random.uniform() < air_share:
            move(air_m, 0.06)
            hold(random.uniform(0.1, 0.5))
            add(here + wave(random, "sines", 0.6, 0.9 * abs(air_m), 0.06))
        layer = visit % layers
        visit += 1
        top, thick = borders_m[layer], borders_m[layer + 1] - borders_m[layer]
        kind = random.choice(["reversals", "strokes", "staircase", "sines", "chirp", "pulses"])
        move(top + thick * random.uniform(0.35, 0.65))
        if kind == "strokes":
            for _ in range(int(random.integers(2, 5))):
                move(random.uniform(0.5 * air_m, bottom_m))
        elif kind == "staircase":
            for goal in numpy.linspace(here, random.uniform(0.0, bottom_m), int(random.integers(3, 6)))[1:]:
                move(goal)
                hold(random.uniform(0.15, 0.6))
        elif kind in ("sines", "chirp", "pulses"):
            reach = min(here - air_m, bottom_m - here, thick * log_uniform(random, 0.15, 1.2))
            add(here + wave(random, kind, random.uniform(1.0, 2.0), reach, log_uniform(random, 0.015, 0.08)))
        for _ in range(int(random.integers(1, 4))):
            move(min(max(here + random.choice([-1, 1]) * thick * random.uniform(0.05, 0.3), air_m), bottom_m))
    return numpy.concatenate(pieces)[: int(duration_s * GRID_HZ)]


def rotary_program(random, duration_s):
    """Returns the commanded speed of turning: constant speeds of both directions, rests and sums of sines."""
    count = int(duration_s * GRID_HZ)
    pieces, done = [], 0
    while done < count:
        size = int(random.uniform(0.4, 1.5) * GRID_HZ)
        speed = random.choice([0.0, 1.0, 1.0, 1.0, -1.0]) * log_uniform(random, 0.4, 8.0)
        swing = random.choice([0.0, 0.0, 1.0]) * log_uniform(random, 0.5, 4.0)
        time = numpy.arange(size) * STEP_S
        pieces.append(speed + swing * numpy.sin(2 * numpy.pi * random.uniform(0.7, 4.0) * time))
        done += size
    return numpy.concatenate(pieces)[:count]


def follow(command, lag_s):
    """Returns the answer of a motor to its command: two equal first-order lags, each by exact exponential steps."""
    keep = math.exp(-STEP_S / lag_s)
    for _ in range(2):
        command = linear_recurrence(keep, (1.0 - keep) * command, command[0])
    return command


def moved(random, motor, borders_m, duration_s, index, air_share, turns):
    """Returns the motion of one trial: what the motors do, not what they were told."""
    x = follow(program(random, borders_m, duration_s, index, air_share), motor["lag_s"])
    x = x + motor["ripple_m"] * numpy.sin(2 * numpy.pi * x / motor["ripple_period_m"])  # error of the screw's pitch
    v = numpy.gradient(x, STEP_S)
    a = numpy.gradient(v, STEP_S)
    omega = follow(rotary_program(random, duration_s), motor["rotary_lag_s"]) if turns else numpy.zeros(len(x))
    theta = numpy.cumsum(omega) * STEP_S
    omega = omega * (1.0 + motor["rotary_ripple"] * numpy.cos(12.0 * theta))
    theta = numpy.concatenate([[0.0], numpy.cumsum(0.5 * (omega[1:] + omega[:-1])) * STEP_S])
    return Motion(index, numpy.arange(len(x)) * STEP_S, x, v, a, theta, omega)
