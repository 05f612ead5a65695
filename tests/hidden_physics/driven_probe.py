"""A probe of small mass, driven by a hand through layered bone: the equation of motion with its switches.

    (M + m) dv/dt = hand(t, x, v) - resistance,      the force sensor reads resistance + m dv/dt,

with M the mass above the sensor and m the mass below it. Dry friction sticks and slips, layers have sharp borders, play
opens and closes. Each switch is an event that bisection locates on the continuous extension of the integrator's step;
the acceleration may jump there. Base law [Probing, eq. (2), solved for the force]: F = K (x - x0) + D v in a layer,
nothing outside the layers; about the axis T = b omega + T_d sin(2 pi theta / pitch) (form own). Keys such as Flash1985
are those of the project's bibliography.
"""
from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from math import cos, inf, pi, sin
from types import SimpleNamespace
from typing import Callable, Optional

import numpy as np

# Dormand-Prince 5(4): J. R. Dormand, P. J. Prince, J. Comput. Appl. Math. 6 (1980). Continuous extension of order 4:
# E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, section II.6.
NODES = (0.0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1.0, 1.0)
WEIGHTS = [np.array(row) for row in (
    [], [1 / 5], [3 / 40, 9 / 40], [44 / 45, -56 / 15, 32 / 9],
    [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729],
    [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656],
    [35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84])]
ERROR = np.array([71 / 57600, 0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40])
EXTENSION = np.array([-12715105075 / 11282082432, 0, 87487479700 / 32700410799, -10690763975 / 1880347072,
                      701980252875 / 199316789632, -1453857185 / 822651844, 69997945 / 29380423])

RELATIVE_TOLERANCE = 2e-6
LONGEST_STEP_S = 4e-3
EVENT_WITHIN_S = 1e-10
MOST_STEPS = 300000
PINNED_WITHIN_M = 2e-7  # a border that pushes back from both sides holds the tip once its rebound is smaller than this
AXIAL, BORDER, PLAY, TURNING = range(4)  # the switches


def dormand_prince_step(rates, t, y, h, slopes):
    """One step from slopes[0]: fills slopes[1:], returns the new state and the estimated error of each component."""
    for stage in range(1, 7):
        reached = y + h * (WEIGHTS[stage] @ slopes[:stage])
        slopes[stage] = rates(t + NODES[stage] * h, reached.tolist())
    return reached, h * (ERROR @ slopes)


def extension(y, reached, h, slopes):
    """Coefficients of the continuous extension of a step."""
    change = reached - y
    bend = h * slopes[0] - change
    return np.array([y, change, bend, change - h * slopes[6] - bend, h * (EXTENSION @ slopes)])


def extended(c, share):
    """The state at a share of the step whose coefficients are c, or of many steps: [coefficient, step, state]."""
    rest = 1 - share
    return c[0] + share * (c[1] + rest * (c[2] + share * (c[3] + rest * c[4])))


class MinimumJerkPath:
    """A chain of minimum-jerk moves [Flash1985]: x0 + d (10 s^3 - 15 s^4 + 6 s^5), s = t / T; a hold has d = 0."""

    def __init__(self, start, moves):
        self.start, self.times, self.moves, t = start, [], [], 0.0
        for duration, distance in moves:
            self.times.append(t)
            self.moves.append((t, duration, start, distance))
            t, start = t + duration, start + distance
        self.duration, self.last = t, start

    def __call__(self, t):
        begin, duration, start, distance = self.moves[max(bisect_right(self.times, t) - 1, 0)]
        s = min((t - begin) / duration, 1.0)
        return start + distance * s ** 3 * (10 + s * (6 * s - 15)), 30 * distance / duration * (s * (1 - s)) ** 2


@dataclass
class Hand:
    """Spring and damper to a path, with physiological tremor of 8 to 12 Hz [Novak2017]; it expects a resistance."""
    path: MinimumJerkPath
    stiffness: float
    damping: float
    expected_stiffness: float = 0.0  # of the bone, where the path is inside it
    expected_damping: float = 0.0
    tremor: tuple = ()  # (amplitude, angular frequency, phase)

    def push(self, t, x, v):
        aim, speed = self.path(t)
        expected = self.expected_stiffness * max(aim, 0.0) + self.expected_damping * speed
        for amplitude, frequency, phase in self.tremor:
            aim += amplitude * sin(frequency * t + phase)
            speed += amplitude * frequency * cos(frequency * t + phase)
        return expected + self.stiffness * (aim - x) + self.damping * (speed - v)


@dataclass
class Effect:
    """A hidden effect: each function takes the Moment and acts at its own place of the equation of motion."""
    parameters: dict
    size: tuple  # the parameters that scale the effect, together
    force: Optional[Callable] = None  # N, added to the resistance
    level: Optional[Callable] = None  # N, the most that dry friction resists
    softens: Optional[Callable] = None  # factor on the bone's springs
    eases: Optional[Callable] = None  # factor on the bone's springs and dampers
    torque: Optional[Callable] = None  # N m, added to the resistance about the axis
    turn_level: Optional[Callable] = None  # N m, the most that dry friction resists about the axis
    reads: Optional[Callable] = None  # what its channel shows beside the truth: (t, force, torque, trial) -> values
    rates: Optional[Callable] = None  # derivatives of the effect's own states
    states: tuple = ()  # their start values
    scales: tuple = ()  # their usual sizes, for the error of a step
    channel: str = "fz_N"
    name: str = ""


class Moment:
    """What an effect may look at: time, motion, loads of the bone, the effect's own states q."""
    __slots__ = ("t", "x", "v", "speed", "theta", "turn", "base", "in_bone", "q", "trial")


@dataclass
class Plant:
    """The bone's regions along the axis, air included: (from, to, K, D, x0); the probe; `rotary` if the probe turns."""
    regions: list
    mass_above_kg: float
    mass_below_kg: float
    rotary: Optional[SimpleNamespace] = None  # inertia_kgm2, viscous_Nms_per_rad, detent_Nm, detent_pitch_rad

    def region(self, x):
        return next(i for i, region in enumerate(self.regions) if x < region[1])


class Trial:
    """One solved trial. States: x, v, then theta, omega if the probe turns, then those of the effects.

    sign and turn_sign: direction of slip, 0 while stuck. side: the flank of the play that is in touch, 0 for none, then
    the bone sees the depth `held`. pinned: the two regions at whose border the tip is held.
    """

    def __init__(self, plant, hand, turner, effects, number):
        self.plant, self.hand, self.turner, self.effects = plant, hand, turner, effects
        self.turning = turner is not None
        self.m = plant.mass_below_kg + sum(e.parameters["mass_kg"] for e in effects if e.name == "inertia")
        self.moving_mass = plant.mass_above_kg + self.m
        play = next((e.parameters for e in effects if e.name == "backlash"), {"gap_m": 0.0, "damping_share": 0.0})
        self.gap, self.play_share = play["gap_m"], play["damping_share"]
        self.c = Moment()
        self.c.trial, self.c.theta, self.c.turn = number, 0.0, 0.0
        y, scales, self.own = [hand.path.start, 0.0], [1e-2, 0.1], []
        if self.turning:
            y, scales = y + [turner.path.start, 0.0], scales + [1.0, 5.0]
        for e in effects:
            self.own.append((len(y), len(y) + len(e.states)))
            y, scales = y + list(e.states), scales + list(e.scales)
        at = {place: [(i, getattr(e, place), *self.own[i]) for i, e in enumerate(effects) if getattr(e, place)]
              for place in ("force", "level", "softens", "eases", "torque", "turn_level", "rates")}
        self.at = SimpleNamespace(**at)
        self.least = RELATIVE_TOLERANCE * np.array(scales)
        self.region, self.pinned = plant.region(y[0]), None
        self.sign, self.side, self.held, self.turn_sign = 1, 0, y[0], 1
        self.solve(np.array(y))

    # ---- loads
    def seen(self, x):
        """The depth that the bone sees."""
        if not self.gap:
            return x
        return x - self.side * self.gap / 2 if self.side else self.held

    def loads(self, t, y, v, skip=-1):
        """Resistance along the axis without dry friction, and the most that dry friction resists; `skip`: left out."""
        c, x = self.c, y[0]
        _, _, stiffness, damping, equilibrium = self.plant.regions[self.region]
        c.t, c.x, c.v, c.speed, c.in_bone = t, x, v, abs(v), stiffness > 0
        if self.turning:
            c.theta, c.turn = y[2], abs(y[3])
        spring = stiffness * (self.seen(x) - equilibrium)
        for i, softens, a, b in self.at.softens:
            if i != skip:
                c.q = y[a:b]
                spring *= softens(c)
        c.base = spring + damping * v * (1 - self.play_share if self.gap and not self.side else 1)
        for i, eases, a, b in self.at.eases:
            if i != skip:
                c.base *= eases(c)
        force, level = c.base, 0.0
        for i, acts, a, b in self.at.force:
            if i != skip:
                c.q = y[a:b]
                force += acts(c)
        for i, acts, a, b in self.at.level:
            c.q = y[a:b]
            level += acts(c)
        return force, level

    def torques(self, y, omega):
        """The same about the axis."""
        rotary, c = self.plant.rotary, self.c
        c.theta = y[2]
        torque = rotary.viscous_Nms_per_rad * omega + rotary.detent_Nm * sin(2 * pi * y[2] / rotary.detent_pitch_rad)
        return (torque + sum(acts(c) for _, acts, _, _ in self.at.torque),
                sum(acts(c) for _, acts, _, _ in self.at.turn_level))

    def rates(self, t, y):
        v = y[1] if self.sign else 0.0
        force, level = self.loads(t, y, v)
        out = [v, (self.hand.push(t, y[0], v) - force - self.sign * level) / self.moving_mass if self.sign else 0.0]
        if self.turning:
            omega = y[3] if self.turn_sign else 0.0
            torque, most = self.torques(y, omega)
            out += [omega, (self.turner.push(t, y[2], omega) - torque - self.turn_sign * most)
                    / self.plant.rotary.inertia_kgm2 if self.turn_sign else 0.0]
        for _, rates, a, b in self.at.rates:
            self.c.q = y[a:b]
            out.extend(rates(self.c))
        return out

    # ---- switches
    def bounds(self, t, y):
        """The least and the greatest push that leave the probe at rest."""
        here, least, greatest = self.region, inf, -inf
        for self.region in self.pinned or (here,):
            force, level = self.loads(t, y, 0.0)
            least, greatest = min(least, force - level), max(greatest, force + level)
        self.region = here
        return least, greatest

    def margins(self, t, y):
        """One number for each switch: below 0 once it has to switch."""
        border = play = turn = inf
        if self.sign:
            axial, low, high = self.sign * y[1], *self.plant.regions[self.region][:2]
            seen = self.seen(y[0])
            border = min(seen - low, high - seen)
            if self.gap and not self.side:
                play = self.gap / 2 - abs(y[0] - self.held)
        else:
            least, greatest = self.bounds(t, y)
            push = self.hand.push(t, y[0], 0.0)
            axial = min(greatest - push, push - least)
        if self.turning and self.turn_sign:
            turn = self.turn_sign * y[3]
        elif self.turning:
            torque, most = self.torques(y, 0.0)
            turn = most - abs(self.turner.push(t, y[2], 0.0) - torque)
        return axial, border, play, turn

    def depart(self, t, y):
        """From rest: stick, or slip to the side to which the push exceeds what resists."""
        y[1] = 0.0
        least, greatest = self.bounds(t, y.tolist())
        push = self.hand.push(t, y[0], 0.0)
        self.sign = 0 if least <= push <= greatest and least < greatest else 1 if push > greatest else -1
        if self.sign and self.pinned:
            self.region, self.pinned = self.pinned[self.sign > 0], None
        if self.side and self.sign == -self.side:
            self.held = self.seen(y[0])
            self.held += self.side * 1e-9 * self.gap
            self.side = 0

    def switch(self, which, t, y):
        if which == AXIAL:
            self.depart(t, y)
        elif which == PLAY:
            self.side = 1 if y[0] > self.held else -1
        elif which == BORDER:
            before, after = self.region, self.region + (1 if y[1] > 0 else -1)
            sides, push, limits = tuple(sorted((before, after))), self.hand.push(t, y[0], 0.0), []
            for self.region in sides:
                limits.append(self.loads(t, y.tolist(), 0.0)[0])
            self.region = after
            if self.moving_mass * y[1] ** 2 / 2 < PINNED_WITHIN_M * min(push - limits[0], limits[1] - push):
                y[0] += self.plant.regions[sides[1]][0] - self.seen(y[0])
                self.pinned = sides
                self.depart(t, y)
        elif which == TURNING:
            y[3] = 0.0
            torque, most = self.torques(y.tolist(), 0.0)
            excess = self.turner.push(t, y[2], 0.0) - torque
            self.turn_sign = 0 if most and abs(excess) <= most else 1 if excess > 0 else -1

    # ---- solution
    def solve(self, y):
        t, h, end = 0.0, 1e-3, self.hand.path.duration
        stops = sorted({*self.hand.path.times, *(self.turner.path.times if self.turning else ()), end})
        slopes, fresh = np.empty((7, len(y))), True
        self.begins, self.steps, self.pieces, self.modes = [], [], [], []
        self.depart(t, y)
        if self.turning:
            self.switch(TURNING, t, y)
        while t < end - 1e-9:
            if fresh:
                slopes[0], fresh = self.rates(t, y.tolist()), False
            step = min(h, LONGEST_STEP_S, stops[bisect_right(stops, t + 1e-9)] - t)
            reached, error = dormand_prince_step(self.rates, t, y, step, slopes)
            wrong = np.max(np.abs(error) / (self.least + RELATIVE_TOLERANCE * np.abs(reached)))
            proposed = step * min(4.0, max(0.2, 0.9 * max(wrong, 1e-9) ** -0.2))
            h = max(h, proposed) if step < h and wrong <= 1 else proposed
            if wrong > 1:
                continue
            piece, taken = extension(y, reached, step, slopes), step
            switched = min(margins := self.margins(t + step, reached.tolist())) < 0
            if switched:
                low, high = 0.0, 1.0
                while (high - low) * step > EVENT_WITHIN_S:
                    middle = (low + high) / 2
                    there = self.margins(t + middle * step, extended(piece, middle).tolist())
                    low, high, margins = (low, middle, there) if min(there) < 0 else (middle, high, margins)
                taken, reached = high * step, extended(piece, high)
            if len(self.steps) > MOST_STEPS:
                raise RuntimeError(f"trial {self.c.trial} takes more than {MOST_STEPS} steps to reach {t:.6f} s")
            self.begins.append(t)
            self.steps.append(step)
            self.pieces.append(piece)
            self.modes.append((self.sign, self.region, self.side, self.held, self.turn_sign, self.pinned is not None))
            t, y = t + taken, reached
            if switched:
                self.switch(int(np.argmin(margins)), t, y)
                h, fresh = max(h, 1e-5), True
            else:
                slopes[0] = slopes[6]
        self.begins, self.steps, self.pieces = np.array(self.begins), np.array(self.steps), np.array(self.pieces)
        self.last = y

    def states(self, times):
        """The states at these times, and the number of the step that each lies in."""
        step = np.clip(np.searchsorted(self.begins, times, "right") - 1, 0, len(self.begins) - 1)
        share = ((times - self.begins[step]) / self.steps[step])[:, None]
        return extended(self.pieces[step].transpose(1, 0, 2), share), step

    def sample(self, times, shares=False):
        """Motion and true loads at these times; with `shares`, also what each effect that moves the probe adds."""
        states, steps = self.states(times)
        force, torque = np.empty(len(times)), np.zeros(len(times))
        region, pinned = np.empty(len(times), int), np.empty(len(times), bool)
        added = np.zeros((len(self.effects), len(times)))
        rub = 0.0
        for k, (t, step) in enumerate(zip(times.tolist(), steps.tolist())):
            y = states[k].tolist()
            self.sign, self.region, self.side, self.held, self.turn_sign, pinned[k] = self.modes[step]
            region[k] = self.region
            resisting, level = self.loads(t, y, y[1])
            push = self.hand.push(t, y[0], y[1])
            acceleration = (push - resisting - self.sign * level) / self.moving_mass if self.sign else 0.0
            friction = self.sign * level if self.sign else min(max(push - resisting, -level), level)
            force[k] = resisting + friction + self.m * acceleration if self.sign else push
            if self.turning:
                turning, most = self.torques(y, y[3])
                rub = self.turn_sign * most if self.turn_sign else self.turner.push(t, y[2], 0.0) - turning
                torque[k] = turning + rub
            if shares:
                added[:, k] = [self.added(i, e, t, y, resisting, level, friction, acceleration, rub)
                               for i, e in enumerate(self.effects)]
        return SimpleNamespace(t=times, x=states[:, 0], v=states[:, 1], theta=states[:, 2] if self.turning else None,
                               omega=states[:, 3] if self.turning else None, force=force, torque=torque, region=region,
                               pinned=pinned, added=added)

    def added(self, i, effect, t, y, resisting, level, friction, acceleration, rub):
        """What one effect adds to its channel on this motion: all, less what there would be without it."""
        if effect.name == "inertia":
            return effect.parameters["mass_kg"] * acceleration
        if effect.level:
            self.loads(t, y, y[1])
            self.c.q = y[slice(*self.own[i])]
            return friction * effect.level(self.c) / level if level else 0.0
        if effect.turn_level:
            return rub
        if effect.torque:
            return effect.torque(self.c)
        if effect.name == "backlash":
            gap, region, self.gap, self.region = self.gap, self.region, 0.0, self.plant.region(y[0])
            without, self.gap, self.region = self.loads(t, y, y[1])[0], gap, region
            return resisting - without
        return resisting - self.loads(t, y, y[1], skip=i)[0] if effect.force or effect.softens or effect.eases else 0.0
