"""Holds the generator of programmed motors against values worked out by hand."""
import math
import pathlib
import sys
import tempfile
import unittest

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import programmed_motor as rig  # noqa: E402
import motor_programs  # noqa: E402  (its folder is on the path once the generator is imported)

BASE = {"borders_m": [0.0, 0.004, 0.01], "stiffness_N_per_m": [2000.0, 3000.0], "damping_Ns_per_m": [100.0, 50.0],
        "equilibrium_m": [-0.001, 0.002],
        "rotary": {"viscous_Nms_per_rad": 0.02, "detent_Nm": 0.01, "detent_pitch_rad": 0.4}}
AIR = {**BASE, "stiffness_N_per_m": [0.0, 0.0], "damping_Ns_per_m": [0.0, 0.0]}


def motion_of(x, omega=0.0):
    """Returns a motion with these depths on the grid and a constant speed of turning."""
    t = numpy.arange(len(x)) * rig.STEP_S
    v = numpy.gradient(x, rig.STEP_S)
    return rig.Motion(0, t, x, v, numpy.gradient(v, rig.STEP_S), omega * t, numpy.full(len(x), omega))


def ramp(speed_m_s, duration_s):
    return speed_m_s * numpy.arange(int(duration_s * rig.GRID_HZ)) * rig.STEP_S


def force(x, name, parameters, base=AIR, omega=0.0):
    return rig.true_forces(motion_of(x, omega), base, [(name, parameters)])[0]


class Numerics(unittest.TestCase):
    def test_recurrences_equal_their_loops(self):
        random = numpy.random.default_rng(1)
        factor, addend = random.uniform(0.2, 1.0, 777), random.normal(size=777)
        low = random.normal(size=777)
        high = low + random.uniform(0.0, 1.0, 777)
        y, z, sums, bounded = 0.3, 0.1, [], []
        for i in range(777):
            y = factor[i] * y + addend[i]
            z = min(max(z, low[i]), high[i])
            sums.append(y)
            bounded.append(z)
        numpy.testing.assert_allclose(rig.linear_recurrence(factor, addend, 0.3), sums, rtol=1e-11, atol=1e-11)
        numpy.testing.assert_array_equal(rig.recording.bounded_recurrence(low, high, 0.1), bounded)

    def test_filter_has_half_the_power_at_its_cutoff_and_the_delay_of_its_order(self):
        # Butterworth of order 4: |H| = 1/sqrt(2) at the cutoff; delay at 0 Hz 2.6131 / (2 pi 200 Hz) = 2.0795 ms.
        t = numpy.arange(40000) * rig.STEP_S
        inner = slice(10000, 30000)
        passed = rig.recording.low_pass(numpy.sin(2 * numpy.pi * 200.0 * t), 200.0, rig.GRID_HZ, False)
        self.assertAlmostEqual(rig.rms(passed[inner]), 0.5, places=4)
        late = rig.recording.low_pass(t, 200.0, rig.GRID_HZ, False)
        self.assertAlmostEqual((t - late)[inner].mean(), 2.0795e-3, delta=2e-6)
        level = rig.recording.low_pass(t, 200.0, rig.GRID_HZ, True)
        self.assertLess(numpy.abs((t - level)[inner]).max(), 2e-6)

    def test_stroke_takes_the_time_of_a_trapezoid(self):
        # 20 mm at 20 mm/s with 0.2 m/s^2: 0.02/0.02 + 0.02/0.2 = 1.1 s.
        x = motor_programs.stroke(0.0, 0.02, 0.02, 0.2)
        self.assertAlmostEqual(len(x) * rig.STEP_S, 1.1, delta=1.1 * rig.STEP_S)
        self.assertAlmostEqual(x[-1], 0.02, places=12)
        self.assertAlmostEqual(numpy.diff(x).max() * rig.GRID_HZ, 0.02, places=6)


class Laws(unittest.TestCase):
    def test_base_has_the_force_of_the_layer_and_none_in_air(self):
        # layer 2 at 6 mm and 10 mm/s: 3000 (0.006 - 0.002) + 50 0.01 = 12.5 N; torque 0.02 2 + 0.01 sin(2 pi 1.2 / 0.4)
        f, t = rig.true_forces(motion_of(-0.001 + ramp(0.01, 1.0), 2.0), BASE, [])
        self.assertAlmostEqual(f[14000], 12.5, places=6)
        self.assertEqual(f[1000], 0.0)
        self.assertAlmostEqual(t[12000], 0.04 + 0.01 * math.sin(2 * math.pi * 1.2 / 0.4), places=6)

    def test_dahl_follows_its_closed_form_and_loses_work_over_a_cycle(self):
        k, d = 5000.0, 2e-4
        x = numpy.concatenate([ramp(0.01, 0.1), 0.001 - ramp(0.01, 0.1)])
        f = force(x, "hysteresis", {"stiffness_N_per_m": k, "yield_displacement_m": d})
        self.assertAlmostEqual(f[1000], k * d * (1 - math.exp(-x[1000] / d)), places=9)
        top = 1.0 - math.exp(-0.001 / d)
        self.assertAlmostEqual(f[2500], k * d * (-1 + (1 + top) * math.exp(-0.00025 / d)), places=3)
        self.assertGreater(numpy.sum(f[1:] * numpy.diff(x)), 0.0)

    def test_maxwell_branch_and_fractional_branch_follow_a_ramp(self):
        # k v tau (1 - exp(-t/tau)); Caputo derivative of v t: v t^(1-a) / Gamma(2-a)
        f = force(ramp(0.01, 1.0), "viscoelastic_relaxation", {"stiffness_N_per_m": 800.0, "time_constant_s": 0.2})
        self.assertAlmostEqual(f[10000], 800.0 * 0.01 * 0.2 * (1 - math.exp(-2.5)), places=6)
        f = force(ramp(0.01, 1.0), "fractional_viscoelasticity", {"stiffness_N_s_per_m": 300.0, "order": 0.4})
        self.assertAlmostEqual(f[10000], 300.0 * 0.01 * 0.5**0.6 / math.gamma(1.6), places=6)

    def test_resonator_pushes_its_mass_and_rings_at_its_frequency(self):
        # constant acceleration: the mass goes along once the oscillation has died out, F = m a = 0.4 2 N
        t = numpy.arange(60000) * rig.STEP_S
        p = {"mass_kg": 0.4, "frequency_Hz": 10.0, "damping_ratio": 0.05}
        f = force(t**2, "resonator", p)
        self.assertAlmostEqual(f[50000], 0.8, delta=1e-3)
        early = f[:10000]  # first overshoot after half a damped period, 1 + exp(-pi zeta / sqrt(1 - zeta^2))
        self.assertAlmostEqual(early.argmax() * rig.STEP_S, 0.05 / math.sqrt(1 - 0.05**2), delta=4e-3)
        self.assertAlmostEqual(early.max() / 0.8, 1 + math.exp(-math.pi * 0.05), delta=0.01)

    def test_play_keeps_the_spring_still_over_the_gap(self):
        x = 0.005 + numpy.concatenate([ramp(0.01, 0.1), 0.001 - ramp(0.01, 0.1)])
        f = force(x, "backlash", {"gap_m": 4e-4, "damping_share": 1.0}, BASE)
        self.assertAlmostEqual(f[1000], 3000.0 * (x[1000] - 2e-4 - 0.002) + 50.0 * 0.01, places=6)
        self.assertAlmostEqual(f[2400], 3000.0 * (0.006 - 2e-4 - 0.002), delta=0.002)  # 0.2 of 0.4 mm turned back
        self.assertAlmostEqual(f[3400], 3000.0 * (x[3400] + 2e-4 - 0.002) - 50.0 * 0.01, places=6)

    def test_friction_laws_have_their_hand_values(self):
        # at 10 mm/s inward: Stribeck 1 + 2 exp(-1) with vs = 10 mm/s; 90 N/m at 5 mm; reversal: 2 s/(s + 1 mm) at 5 mm
        x = ramp(0.01, 1.0)
        p = {"friction_N": 1.0, "breakaway_N": 3.0, "stribeck_velocity_m_s": 0.01}
        self.assertAlmostEqual(force(x, "stribeck_friction", p)[5000], 1.0 + 2.0 / math.e, places=9)
        self.assertAlmostEqual(force(x, "depth_friction", {"slope_N_per_m": 90.0})[10000], 0.45, places=9)
        p = {"friction_N": 2.0, "half_way_m": 1e-3}
        self.assertAlmostEqual(force(x, "friction_growing_since_reversal", p)[10000], 2.0 * 5 / 6, places=4)
        turned = numpy.concatenate([x, x[-1] - ramp(0.01, 0.2)])  # 1 mm after the reversal: -2 N 1/2
        self.assertAlmostEqual(force(turned, "friction_growing_since_reversal", p)[22000], -1.0, places=2)

    def test_late_force_is_that_of_an_earlier_moment(self):
        x = 0.005 + ramp(0.01, 0.3)
        f = force(x, "time_delay", {"delay_s": 0.004}, BASE)
        self.assertAlmostEqual(f[4000], 3000.0 * (x[4000] - 4e-5 - 0.002) + 0.5, places=6)

    def test_every_law_vanishes_with_its_size(self):
        random = numpy.random.default_rng(3)
        m = motion_of(0.002 + 0.003 * (1 - numpy.cos(7 * numpy.arange(4000) * rig.STEP_S)), 1.5)
        plain = rig.true_forces(m, BASE, [])
        for name, law in rig.LAWS.items():
            shape = law.draw(random, {"depth_m": 0.01, "work_J": 0.1})
            size = 1e-9 if law.stage == rig.TIMING or name == "backlash" else 0.0
            parameters = {**shape, law.size: size, **{tied: size for tied in law.tied}}
            for with_law, without in zip(rig.true_forces(m, BASE, [(name, parameters)]), plain):
                numpy.testing.assert_allclose(with_law, without, atol=2e-3, err_msg=name)


class Sets(unittest.TestCase):
    def test_a_seed_gives_the_same_bytes_and_two_seeds_do_not(self):
        def content(seed):
            with tempfile.TemporaryDirectory() as folder:
                rig.made_set.write(rig.make(seed, ["coulomb_friction", "sensor_bias"]), folder)
                return {p.name: p.read_bytes() for p in sorted(pathlib.Path(folder).rglob("*")) if p.is_file()}
        first = content(11)
        self.assertEqual(first, content(11))
        self.assertNotEqual(first["model.json"], content(12)["model.json"])

    def test_a_set_keeps_the_contract(self):
        for hidden in ([], ["inertia"], ["resonator"], ["torque_crosstalk", "backlash"]):
            made = rig.make(5, hidden)
            self.assertEqual([effect["id"] for effect in made.truth["hidden"]], hidden)
            self.assertTrue(made.truth["accepted"])
            for effect in made.truth["hidden"]:
                self.assertTrue(0.035 < effect["share_of_force_rms"] < 0.11, effect)
            layers = made.model["base"]["layers"]
            for above, below in zip(layers, layers[1:]):
                gap = below["start_m"] - above["start_m"] - above["thickness_m"]
                self.assertTrue(-1e-12 < gap < 7e-7, gap)
            for _, columns in made.trials:
                steps = numpy.diff(columns["t_s"])
                self.assertGreater(steps.min(), 0.0)
                self.assertLess(steps.max(), 0.0202)
                self.assertEqual(len({len(column) for column in columns.values()}), 1)

    def test_with_nothing_hidden_a_refit_of_the_true_base_leaves_the_stated_noise(self):
        made = rig.make(1, [])
        base, noise = made.truth["base"], made.truth["force_noise_sd_N"]
        columns, forces = [], []
        for _, c in made.trials:
            x, v = c["x_m"], numpy.gradient(c["x_m"], c["t_s"])
            layer = rig.layer_of(base, x)
            rows = [(layer == i) * part for i in range(len(base["stiffness_N_per_m"])) for part in (x, v, 1.0)]
            columns.append(numpy.stack(rows, axis=1))
            forces.append(c["fz_N"])
        left = rig.recording.share_left(forces, columns) * rig.rms(forces)
        self.assertLess(left, 3.0 * noise)
        self.assertLess(left, 0.02 * made.truth["force_rms_N"])


if __name__ == "__main__":
    unittest.main()
