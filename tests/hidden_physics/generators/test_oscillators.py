"""Holds the oscillators against closed forms of vibration theory and against the printed equations."""
import math
import pathlib
import sys
import unittest

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import oscillators  # noqa: E402
from oscillators import ELEMENTS, OSCILLATORS, advanced  # noqa: E402

DAHL, BOUC_WEN, AXIS = OSCILLATORS["dahl"], OSCILLATORS["bouc_wen"], OSCILLATORS["servo_axis"]


class Linear(unittest.TestCase):
    def test_steady_amplitude_is_that_of_the_transfer_function(self):
        # bouc_wen without its element at 20 Hz: 30 N / |5e4 - 2 w^2 + 10 i w|
        t = numpy.arange(int(4.0 * BOUC_WEN.grid_Hz)) / BOUC_WEN.grid_Hz
        w = 2 * math.pi * 20.0
        x, _, _ = advanced(BOUC_WEN, [], 30.0 * numpy.sin(w * t)[:, None])
        wanted = 30.0 / abs(complex(5e4 - 2.0 * w**2, 10.0 * w))
        self.assertAlmostEqual((x[-15000:, 0].max() - BOUC_WEN.middle_m) / wanted, 1.0, delta=2e-3)

    def test_work_of_the_force_is_kinetic_and_elastic_energy_and_what_the_damper_took(self):
        drive = oscillators.multisine(numpy.random.default_rng(2), 30000, DAHL.grid_Hz, DAHL.band_Hz, 10.0)[:, None]
        x, u, extra = advanced(DAHL, [("hysteresis", ELEMENTS["hysteresis"].published)], drive)
        x = x[:, 0] - DAHL.middle_m
        v = numpy.diff(x) * DAHL.grid_Hz
        step = 1.0 / DAHL.grid_Hz
        work = numpy.sum(u[:-1, 0] * v) * step
        lost = numpy.sum((DAHL.damping_Ns_per_m * v + extra[:-1, 0]) * v) * step
        stored = 0.5 * DAHL.mass_kg * v[-1] ** 2 + 0.5 * DAHL.stiffness_N_per_m * x[-1] ** 2
        self.assertAlmostEqual((lost + stored) / work, 1.0, delta=5e-3)


class Elements(unittest.TestCase):
    def test_dry_friction_takes_four_times_friction_over_stiffness_from_the_amplitude_in_each_period(self):
        # free oscillation after a push is let go, no damper: successive maxima fall by 4 F / k (Coulomb damping)
        free = DAHL._replace(damping_Ns_per_m=0.0)
        count = int(1.2 * free.grid_Hz)
        drive = numpy.where(numpy.arange(count) < 0.3 * free.grid_Hz, 30.0, 0.0)[:, None]
        x, _, _ = advanced(free, [("coulomb_friction", {"friction_N": 0.5})], drive)
        x = x[int(0.35 * free.grid_Hz):, 0] - free.middle_m
        tops = [x[i] for i in range(1, len(x) - 1) if x[i] > x[i - 1] and x[i] >= x[i + 1]]
        for before, after in zip(tops, tops[1:]):
            self.assertAlmostEqual(before - after, 4 * 0.5 / free.stiffness_N_per_m, delta=1e-5)

    def test_a_push_below_the_friction_moves_nothing(self):
        x, _, extra = advanced(DAHL, [("coulomb_friction", {"friction_N": 2.0})], numpy.full((2000, 1), 1.5))
        self.assertLess(numpy.abs(x - DAHL.middle_m).max(), 1e-12)
        self.assertAlmostEqual(extra[-1, 0], 1.5, places=9)

    def test_bouc_wen_force_on_a_monotone_way_is_the_integral_of_its_equation(self):
        # z > 0, v > 0: dz/dx = alpha - beta (gamma + delta) z = 5e4 + 300 z, so z = 5e4/300 (exp(300 x) - 1)
        soft = BOUC_WEN._replace(stiffness_N_per_m=0.0)
        element = ("bouc_wen_hysteresis", ELEMENTS["bouc_wen_hysteresis"].published)
        drive = numpy.full((300, 1), 60.0)
        x, _, extra = advanced(soft, [element], drive)
        way = x[:, 0] - soft.middle_m
        rising = int(numpy.argmax(way)) // 2
        middle = 0.5 * (way[rising] + way[rising + 1])
        self.assertAlmostEqual(extra[rising, 0], 5e4 / 300.0 * (math.exp(300.0 * middle) - 1.0), delta=0.02)

    def test_servo_axis_at_constant_speed_pushes_against_viscous_and_dry_friction_and_offset(self):
        # 0.1 m/s: 203.5034 0.1 + 20.3935 - 3.1648 = 37.579 N (Janot2019's symmetric model)
        count = int(1.5 * AXIS.grid_Hz)
        drive = AXIS.middle_m + 0.1 * (numpy.arange(count) / AXIS.grid_Hz)[:, None]
        hidden = [(name, ELEMENTS[name].published) for name in ("coulomb_friction", "sensor_bias")]
        x, u, _ = advanced(AXIS, hidden, drive)
        self.assertAlmostEqual(u[-2000:, 0].mean(), 37.579, delta=0.01)
        self.assertAlmostEqual((x[-1, 0] - x[-2001, 0]) * AXIS.grid_Hz / 2000, 0.1, delta=1e-4)


class Sets(unittest.TestCase):
    def test_a_seed_gives_the_same_set_with_the_published_numbers(self):
        first, second = (oscillators.make(4, ["coulomb_friction"]) for _ in range(2))
        self.assertEqual(first.truth, second.truth)
        self.assertEqual(first.truth["hidden"][0]["parameters"], {"friction_N": 20.3935})
        for (_, a), (_, b) in zip(first.trials, second.trials):
            for name in a:
                numpy.testing.assert_array_equal(a[name], b[name])
        positions = numpy.concatenate([columns["x_m"] for _, columns in first.trials])
        self.assertTrue(0.0 < positions.min() and positions.max() < 0.3)

    def test_recordings_with_nothing_hidden_obey_the_equation_of_motion_to_the_stated_noise(self):
        # m a + c v + k x = F by derivatives in the frequency domain, away from the trial's ends
        made = oscillators.make(9, [])
        base, rate_Hz, columns = made.truth["base"], made.truth["sensor"]["rate_Hz"], made.trials[0][1]
        self.assertEqual((base["oscillator"], made.truth["sensor"]["dropped_rows"]), ("silverbox", 0))
        x, count = columns["x_m"] - base["middle_m"], len(columns["x_m"])
        t = numpy.arange(count) / rate_Hz
        slope = 2j * numpy.pi * numpy.fft.rfftfreq(count, 1 / rate_Hz)
        spectrum = numpy.fft.rfft(x * numpy.minimum(1.0, numpy.minimum(t, t[-1] - t) / 0.3))
        v, a = (numpy.fft.irfft(spectrum * slope**order, count) for order in (1, 2))
        rest = columns["fz_N"] - base["mass_kg"] * a - base["damping_Ns_per_m"] * v - base["stiffness_N_per_m"] * x
        self.assertLess(oscillators.rms(rest[400:-400]), 1.1 * made.truth["force_noise_sd_N"])


if __name__ == "__main__":
    unittest.main()
