"""Checks of the generator `closed_loop_hand` against values worked out by hand and laws of mechanics."""
import sys
import tempfile
import unittest
from math import exp, inf, pi, sqrt
from pathlib import Path
from types import SimpleNamespace

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
import closed_loop_hand as generator  # noqa: E402
from driven_probe import (Hand, MinimumJerkPath, Plant, Trial, dormand_prince_step, extended,  # noqa: E402
                          extension)
from made_set import csv_text, decimals, write  # noqa: E402
from probe_effects import LAWS  # noqa: E402

AIR = [(-inf, inf, 0.0, 0.0, 0.0)]


def bone(*layers):
    """Regions of layers (to, K, D, x0) that begin at depth 0."""
    regions, start = [(-inf, 0.0, 0.0, 0.0, 0.0)], 0.0
    for end, stiffness, damping, equilibrium in layers:
        regions.append((start, end, stiffness, damping, equilibrium))
        start = end
    return regions + [(start, inf, 0.0, 0.0, 0.0)]


def trial(regions, moves, effects=(), start=0.0, stiffness=1000.0, damping=0.0, mass=0.2):
    hand = Hand(MinimumJerkPath(start, moves), stiffness, damping)
    return Trial(Plant(regions, mass, 0.0), hand, None, list(effects), 0)


def at(solved, seconds):
    return solved.sample(np.atleast_1d(np.asarray(seconds, float)), shares=True)


def effect(name, **parameters):
    """An effect of the list with these parameters."""
    scale = SimpleNamespace(trials=1, share=0.1, aim=1.0, **dict.fromkeys(
        ("force", "speed", "depth", "speed_squared", "acceleration", "force_rate", "stiffness", "work", "theta",
         "omega", "torque"), 1.0))
    made = LAWS[name].make(np.random.default_rng(1), scale)
    made.name = name
    made.parameters.update(parameters)
    return made


class Integrator(unittest.TestCase):
    def test_error_falls_with_the_fifth_power_of_the_step_and_the_extension_with_the_fourth(self):
        def errors(steps):  # y'' = -y from (1, 0): cos t
            y, h, slopes, between = np.array([1.0, 0.0]), 2.0 / steps, np.empty((7, 2)), 0.0
            for k in range(steps):
                slopes[0] = [y[1], -y[0]]
                reached, _ = dormand_prince_step(lambda t, s: [s[1], -s[0]], k * h, y, h, slopes)
                middle = extended(extension(y, reached, h, slopes), 0.4)
                between = max(between, abs(middle[0] - np.cos((k + 0.4) * h)))
                y = reached
            return np.hypot(y[0] - np.cos(2.0), y[1] + np.sin(2.0)), between
        coarse, fine = errors(10), errors(20)
        self.assertGreater(coarse[0] / fine[0], 25)  # 2^5 = 32
        self.assertGreater(coarse[1] / fine[1], 14)  # 2^4 = 16 or better


class Mechanics(unittest.TestCase):
    def test_dry_friction_takes_the_same_from_each_swing_and_then_holds(self):
        # Spring 1000 N/m pulled 10 mm, friction 1.5 N: each half swing loses 2 F/k = 3 mm; -10, +7, -4, +1 mm, and
        # there the spring's 1 N is below 1.5 N. Half a swing lasts pi sqrt(m/k) = 44.43 ms.
        solved = trial(AIR, [(1e-6, 0.01), (0.4, 0.0)], [effect("coulomb_friction", friction_N=1.5)])
        half = pi * sqrt(0.2 / 1000)
        got = at(solved, [half, 2 * half, 3 * half, 0.39])
        np.testing.assert_allclose(got.x, [0.017, 0.006, 0.011, 0.011], atol=3e-6)
        self.assertEqual(got.v[3], 0.0)
        self.assertAlmostEqual(got.force[3], -1.0, places=2)  # the sensor shows what the hand pulls
        self.assertAlmostEqual(got.added[0][3], -1.0, places=2)

    def test_energy_of_the_hand_is_stored_moved_or_lost(self):
        regions = bone((0.004, 2000, 60, 0.0), (0.05, 3500, 150, 0.001))
        effects = [effect("coulomb_friction", friction_N=1.2), effect("resonator", mass_kg=0.5)]
        solved = trial(regions, [(0.3, 0.012), (0.1, 0.0), (0.2, -0.008), (0.2, 0.005)], effects, -0.001, damping=20)
        grid = np.arange(0, 0.7, 2e-5)  # ends in the midst of the last move
        s = at(solved, grid)
        hand = np.array([solved.hand.push(t, x, v) for t, x, v in zip(grid, s.x, s.v)])

        def work(force, speed):
            return float(np.sum((force * speed)[1:] + (force * speed)[:-1]) / 2 * 2e-5)
        kinetic = 0.1 * (s.v[-1] ** 2 - s.v[0] ** 2)
        self.assertAlmostEqual(work(hand, s.v), kinetic + work(s.force, s.v), delta=2e-5)
        states, _ = solved.states(grid)
        stretch, mass_speed = states[:, -2], states[:, -1]
        impulse = np.cumsum(s.added[1]) * 2e-5
        np.testing.assert_allclose(impulse, 0.5 * mass_speed, atol=2e-5)  # momentum
        frequency, ratio = (effects[1].parameters[n] for n in ("angular_frequency_rad_s", "damping_ratio"))
        stored = 0.25 * (mass_speed[-1] ** 2 + frequency ** 2 * stretch[-1] ** 2)  # m/2 = 0.25 kg
        lost = work(2 * 0.5 * ratio * frequency * (s.v - mass_speed), s.v - mass_speed)
        self.assertGreater(stored + lost, 1e-4)
        self.assertAlmostEqual(work(s.added[1], s.v), stored + lost, delta=2e-6)
        self.assertGreaterEqual(np.min(s.added[0] * s.v), 0.0)  # friction never gives energy

    def test_a_border_holds_the_tip_between_the_forces_of_its_sides(self):
        # Border at 5 mm: 1000 * 5 mm = 5 N before, 4000 * (5 - 2) mm = 12 N after. Hand 1000 N/m aims at 13 mm: 8 N.
        solved = trial(bone((0.005, 1000, 50, 0.0), (0.05, 4000, 50, 0.002)), [(0.5, 0.013), (1.0, 0.0), (0.5, 0.008),
                                                                               (1.0, 0.0)], damping=20)
        got = at(solved, [1.4, 2.9])
        self.assertAlmostEqual(got.x[0], 0.005, delta=1e-8)
        self.assertAlmostEqual(got.force[0], 8.0, places=4)
        self.assertTrue(got.pinned[0])
        # Then it aims at 21 mm: 1000 (21 - x) = 4000 (x - 2), x = 5.8 mm, 15.2 N.
        self.assertAlmostEqual(got.x[1], 0.0058, delta=1e-7)
        self.assertAlmostEqual(got.force[1], 15.2, delta=1e-3)

    def test_play_shifts_the_springs_by_half_its_width_each_way(self):
        solved = trial(bone((0.05, 3000, 0, 0.0)), [(1.0, 0.02), (1.0, -0.008)],
                       [effect("backlash", gap_m=6e-4, damping_share=0.0)], 0.0, 2000.0, 80.0)
        s = at(solved, np.arange(0.2, 1.9, 0.01))
        into, out = (s.v > 2e-4) & (s.t < 0.95), (s.v < -2e-4) & (s.t > 1.4)
        np.testing.assert_allclose(s.force[into], 3000 * (s.x[into] - 3e-4), atol=1e-5)
        np.testing.assert_allclose(s.force[out], 3000 * (s.x[out] + 3e-4), atol=1e-5)
        np.testing.assert_allclose(s.added[0][out], 0.9, atol=1e-5)

    def test_states_of_effects_follow_their_closed_forms(self):
        dahl = LAWS["hysteresis"].make(np.random.default_rng(1), SimpleNamespace(aim=2.0))
        dahl.name, width = "hysteresis", dahl.parameters["yield_displacement_m"]
        branch = effect("viscoelastic_relaxation")
        tau = branch.parameters["time_constant_s"]
        solved = trial(AIR, [(1.0, 0.003), (1.0, 0.0)], [dahl, branch], 0.0, 4000.0, 200.0)
        s = at(solved, [0.3, 0.5, 0.8, 1.4, 1.7])
        one_way = 2.0 * (1 - np.exp(-s.x[:3] / width))  # k delta = 2 N
        np.testing.assert_allclose(s.added[0][:3], one_way, rtol=1e-3)
        stays = s.added[1][4] / s.added[1][3]
        self.assertAlmostEqual(stays, exp(-0.3 / tau), delta=0.02)  # held: the branch relaxes

    def test_a_bond_that_aged_at_rest_breaks_at_its_strength(self):
        # n grows to 1 - exp(-1 s / tau) while the hand waits 1 s; then the push rises until F_b n.
        bond = effect("breakaway_after_rest", strength_N=6.0)
        tau = bond.parameters["time_constant_s"]
        s = at(trial(AIR, [(1.0, 0.0), (2.0, 0.02), (0.2, 0.0)], [bond], 0.0, 1000.0, 10.0), np.arange(0, 3.1, 1e-3))
        loose = int(np.argmax(s.v > 1e-6))
        self.assertAlmostEqual(s.force[loose - 1], 6.0 * (1 - exp(-s.t[loose - 1] / tau)), delta=0.1)
        self.assertLess(s.force[loose + 100], 0.5 * s.force[loose - 1])


class Sensors(unittest.TestCase):
    def test_filter_has_the_gain_and_the_lag_of_its_formula(self):
        t = np.arange(0, 2, 1 / 4000)
        got = generator.low_passed(np.sin(2 * pi * 200 * t), 4000.0, 200.0, 1e-3)[2000:6000]
        # At the cutoff: gain 1/sqrt 2, a quarter of a period late, and 1 ms = 72 degrees more.
        expected = np.sin(2 * pi * 200 * (t[2000:6000] - 1e-3) - pi / 2) / sqrt(2)
        np.testing.assert_allclose(got, expected, atol=1e-6)

    def test_noise_has_its_size_colour_and_hum(self):
        sensor = {"rate_Hz": 1000.0, "noise_correlation_s": 2e-3, "hum_Hz": 50.0, "hum_share_of_noise": 0.3}
        t = np.arange(200000) / 1000
        noise = generator.coloured_noise(np.random.default_rng(3), t, 0.2, sensor)
        hum = 2 * abs(np.mean(noise * np.exp(-2j * pi * 50 * t)))
        self.assertAlmostEqual(np.std(noise), 0.2 * sqrt(1.09), delta=0.004)
        self.assertAlmostEqual(hum / sqrt(2), 0.06, delta=0.004)
        neighbours = 0.04 * (exp(-0.5) + 0.09 * np.cos(0.1 * pi))  # 1 ms apart: e^(-1/2), 18 degrees of the hum
        self.assertAlmostEqual(np.mean(noise[1:] * noise[:-1]), neighbours, delta=0.001)

    def test_numbers_are_written_with_the_digits_that_they_have(self):
        self.assertEqual(decimals(np.array([0.25, 3.0])), 2)
        self.assertEqual(csv_text({"t_s": np.array([0.0, 0.002]), "x_m": np.array([1e-7, -2e-7])}),
                         "t_s,x_m\n0.000,0.0000001\n0.002,-0.0000002\n")


class Sets(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.nothing = generator.make(74, [])
        cls.pair = generator.make(193, ["coulomb_friction", "inertia"])

    def test_nothing_hidden_leaves_the_noise_of_the_sensor_chain(self):
        truth, residuals, predicted = self.nothing.truth, [], []
        for _, columns in self.nothing.trials:
            dt = columns["t_s"][1]
            v = np.convolve(np.gradient(columns["x_m"], dt), np.ones(15) / 15, "same")
            for layer in truth["base"]["layers"]:
                start, end = layer["start_m"], layer["start_m"] + layer["thickness_m"]
                inside = (columns["x_m"] > start + 2e-4) & (columns["x_m"] < end - 2e-4) & (np.abs(v) < 5e-3)
                inside[:20], inside[-20:] = False, False
                law = layer["stiffness_N_per_m"] * (columns["x_m"] - layer["equilibrium_m"])
                law += layer["damping_Ns_per_m"] * v
                residuals.append((columns["fz_N"] - law)[inside])
                predicted.append(law[inside])
        residuals, predicted = np.concatenate(residuals), np.concatenate(predicted)
        rest = np.sqrt(np.mean(residuals ** 2))
        self.assertLess(abs(residuals @ predicted / (predicted @ predicted)), 0.003)  # the gain of the chain is 1
        self.assertEqual(truth["kind"], "nothing")
        self.assertLess(rest, 1.6 * truth["force_noise_sd_N"])
        self.assertGreater(rest, 0.8 * truth["force_noise_sd_N"])

    def test_sizes_are_as_promised(self):
        truth = self.pair.truth
        self.assertTrue(truth["accepted"])
        self.assertEqual((truth["kind"], len(truth["hidden"])), ("two", 2))
        for hidden in truth["hidden"]:
            self.assertTrue(0.04 <= hidden["share_of_force_rms"] <= 0.10)
            self.assertGreaterEqual(hidden["left_after_base_refit"], 0.5)
        self.assertEqual(self.pair.model["effects"], [])
        for stated, true in zip(self.pair.model["base"]["layers"], truth["base"]["layers"]):
            self.assertLessEqual(abs(stated["start_m"] - true["start_m"]), 0.5001e-6)
            self.assertLess(abs(stated["stiffness_N_per_m"] / true["stiffness_N_per_m"] - 1), 0.1001)

    def test_same_seed_gives_the_same_bytes_and_another_seed_does_not(self):
        def content(made):
            with tempfile.TemporaryDirectory() as folder:
                write(made, folder)
                return {p.name: p.read_bytes() for p in sorted(Path(folder).rglob("*")) if p.is_file()}
        again = content(generator.make(193, ["inertia", "coulomb_friction"]))
        self.assertEqual(again, content(self.pair))
        self.assertNotEqual(again["trial1.csv"], content(self.nothing)["trial1.csv"])

    def test_every_effect_is_listed_once_and_what_is_unknown_is_refused(self):
        self.assertEqual(sorted(generator.CATALOGUE + generator.OUTSIDE), sorted(LAWS))
        self.assertGreaterEqual(len(generator.OUTSIDE), 8)
        for hidden in (["no_such_effect"], ["inertia", "inertia"], ["inertia", "backlash", "time_delay"]):
            with self.assertRaises(ValueError):
                generator.make(1, hidden)


if __name__ == "__main__":
    unittest.main()
