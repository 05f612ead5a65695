"""Holds the floor of a noisy motion against cases with a closed form."""
import math
import pathlib
import sys
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import motion_floor  # noqa: E402

STEP_M = 1e-6 * math.sqrt(12)  # noise of 1 um


def truth_of(stiffness=0.0, damping=0.0, mass=0.0, hidden=()):
    return {"base": {"stiffness_N_per_m": stiffness, "damping_Ns_per_m": damping, "mass_kg": mass},
            "hidden": list(hidden), "sensor": {"position_step_m": STEP_M}}


def white(count, sd, seed=1):
    return {"t_s": np.arange(count) * 1e-3, "fz_N": np.random.default_rng(seed).normal(0, sd, count)}


class Floor(unittest.TestCase):
    def test_a_spring_passes_the_noise_of_the_position_on(self):
        # 5000 N/m and 1 um: 5 mN, below a force of 1 N rms at every frequency: sqrt(5e-3^2 1 / (1 + 25e-6))
        floor = motion_floor.motion_floor_N(truth_of(5000.0), [("a", white(20000, 1.0))], 0.0)
        self.assertAlmostEqual(floor, 5e-3, delta=1e-4)

    def test_no_more_is_left_than_there_is(self):
        # 1e9 N/m and 1 um: 1000 N of noise; the best estimate is nothing, and all of the force is left
        floor = motion_floor.motion_floor_N(truth_of(1e9), [("a", white(20000, 1.0))], 0.0)
        self.assertAlmostEqual(floor, 1.0, delta=0.03)

    def test_where_noise_and_force_are_alike_half_is_left(self):
        # N = S_F: half of the power, 1/sqrt(2); the density of white noise is smoothed, but scatters
        floor = motion_floor.motion_floor_N(truth_of(1e6), [("a", white(200000, 1.0))], 0.0)
        self.assertAlmostEqual(floor, math.sqrt(0.5), delta=0.02)

    def test_a_mass_counts_with_the_square_of_the_frequency(self):
        f = np.array([50.0])
        self.assertAlmostEqual(motion_floor.impedance(truth_of(mass=95.0), f)[0], -95 * (100 * math.pi) ** 2, places=3)
        hidden = {"id": "inertia", "parameters": {"mass_kg": 95.0}}
        self.assertAlmostEqual(motion_floor.impedance(truth_of(hidden=[hidden]), f)[0].real,
                               -95 * (100 * math.pi) ** 2, places=3)

    def test_the_sensors_noise_is_no_force(self):
        floor = motion_floor.motion_floor_N(truth_of(1e9), [("a", white(50000, 1.0))], 1.0)
        self.assertLess(floor, 0.45)  # what scatters about the noise's density alone


class Crosstalk(unittest.TestCase):
    def test_a_common_gain_is_taken_up_and_a_share_of_the_torque_is_left(self):
        # gains 2 % on all forces; the x axis shows 1 % of the torque about y, 0.2 N m on a shank of 0.1 m: 0.02 N
        mixing = 0.02 * np.eye(6)
        mixing[0, 4] = 0.01
        truth = {"sensor": {"gain_and_crosstalk_minus_1": mixing.tolist()}, "base": {"length_m": 0.1}}
        columns = {n: np.zeros(10) for n in ("fx_N", "fy_N", "tx_Nm", "tz_Nm")}
        columns.update(fz_N=np.full(10, 3.0), ty_Nm=np.full(10, 0.2))
        self.assertAlmostEqual(motion_floor.crosstalk_floor_N(truth, [("a", columns)]), 0.02, places=12)


if __name__ == "__main__":
    unittest.main()
