"""Holds the rivals against linear models and laws that are known."""
import gzip
import pathlib
import struct
import sys
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import baselines  # noqa: E402
import palpation_library as palpation  # noqa: E402
import probing_library as probing  # noqa: E402

IDS = [("friction", 0), ("mass", 0), ("ripple", 0), ("ripple", 1), ("bias", 0)]


def channel(coefficients, noise=0.1, trials=6, curve=0.0):
    """A made-up channel: 2 base columns and 5 independent library columns; `curve` adds a function of no column."""
    random, made = np.random.default_rng(2), []
    for _ in range(trials):
        base, library, x = random.normal(size=(400, 2)), random.normal(size=(400, 5)), random.uniform(-2, 2, 400)
        y = base @ [3.0, -2.0] + library @ coefficients + noise * random.normal(size=400) + curve * np.sin(2 * x)
        made.append((y, base, library, probing.random_features([x], [1.0]), probing.trends(400)))
    return baselines.Channel("fz_N", IDS, made)


def named(solver, *channels):
    return [e["id"] for e in baselines.SOLVERS[solver](list(channels))["effects"]]


class Methods(unittest.TestCase):
    def test_leaving_a_trial_out_by_gram_matrices_is_leaving_its_rows_out(self):
        made = channel([0.5, 0, 0, 0, 0])
        left, count = 0.0, 0
        for k, (y, base, *_) in enumerate(made.trials):
            rest = [t for j, t in enumerate(made.trials) if j != k]
            x = np.linalg.lstsq(np.concatenate([t[1] for t in rest]), np.concatenate([t[0] for t in rest]),
                                rcond=None)[0]
            left, count = left + np.sum((y - base @ x) ** 2), count + len(y)
        grams = baselines.Grams(made, False)
        self.assertAlmostEqual(grams.error(grams.base), np.sqrt(left / count), places=6)

    def test_each_method_names_one_strong_effect(self):
        for solver in ("best_single", "stlsq", "lasso_bic"):
            self.assertEqual(named(solver, channel([0, 0.6, 0, 0, 0])), ["mass"], solver)

    def test_sparse_methods_name_two_and_nothing(self):
        for solver in ("stlsq", "lasso_bic"):
            self.assertEqual(named(solver, channel([0.6, 0, 0, 0, 0.5])), ["friction", "bias"], solver)
        self.assertEqual(baselines.SOLVERS["lasso_bic"]([channel([0] * 5)])["verdict"], "complete")

    def test_the_best_single_effect_is_always_named(self):
        self.assertEqual(len(named("best_single", channel([0] * 5))), 1)

    def test_the_gaussian_process_announces_a_function_and_nothing_else(self):
        answer = baselines.SOLVERS["gaussian_process"]
        self.assertEqual(answer([channel([0] * 5, curve=0.3)])["verdict"], "unexplained")
        self.assertEqual(answer([channel([0] * 5)])["verdict"], "complete")
        self.assertEqual(answer([channel([0, 0.6, 0, 0, 0])])["verdict"], "complete")

    def test_a_drift_is_named_where_slow_trends_differ_between_trials(self):
        made, random = channel([0, 0.6, 0, 0, 0]), np.random.default_rng(5)
        made.trials = [(y + random.normal() * np.linspace(-1, 1, len(y)), *rest) for y, *rest in made.trials]
        self.assertEqual(named("stlsq", made), ["mass", "sensor_drift"])


class Columns(unittest.TestCase):
    def test_derivatives_of_a_cubic_are_exact(self):
        t = np.arange(300) * 0.002
        value, slope, bend = probing.local_polynomial(t**3 - t, 7, 0.002)
        inner = slice(7, -7)
        np.testing.assert_allclose(value[inner], (t**3 - t)[inner], atol=1e-12)
        np.testing.assert_allclose(slope[inner], (3 * t**2 - 1)[inner], atol=1e-9)
        np.testing.assert_allclose(bend[inner], (6 * t)[inner], atol=1e-7)

    def test_play_follows_by_half_its_gap(self):
        np.testing.assert_allclose(probing.play(np.array([0.0, 1.0, 0.8, 0.0]), 0.4), [0.0, 0.8, 0.8, 0.2])

    def test_a_first_order_state_reaches_its_closed_form(self):
        # dq/dt = 0.01 - q/0.2 for 0.5 s: 0.002 (1 - exp(-2.5))
        q = probing.first_order(np.full(500, 0.01), np.full(500, 5.0), 1e-3)
        self.assertAlmostEqual(q[-1], 0.002 * (1 - np.exp(-2.5)), places=9)

    def test_samples_at_borders_and_ends_are_left_out(self):
        number = np.array([0] * 100 + [1] * 100)
        kept = probing.kept_samples(number, 5, 0.005)  # 15 ms are three samples
        self.assertEqual([k for k in range(200) if k not in kept], [*range(5), *range(96, 104), *range(195, 200)])

    def test_both_volume_formats_give_the_same_voxels_at_the_same_place(self):
        hu = np.arange(24, dtype="<i2").reshape(2, 3, 4)
        nrrd = (b"NRRD0004\ntype: short\nsizes: 2 3 4\nspace directions: (1,0,0) (0,2,0) (0,0,3)\nencoding: gzip\n"
                b"space origin: (10,20,30)\n\n" + gzip.compress(hu.tobytes("F")))
        head = bytearray(352)
        head[40:48] = struct.pack("<4h", 3, 2, 3, 4)
        head[108:112] = struct.pack("<f", 352)
        rows = np.array([[1, 0, 0, -11], [0, 2, 0, -24], [0, 0, 3, 30]], "<f4")  # R and A of the last voxel of LPS
        head[280:328] = rows.tobytes()
        nifti = gzip.compress(bytes(head) + hu[::-1, ::-1].tobytes("F"))
        for got, want in zip(palpation.nifti_of(nifti), palpation.nrrd_of(nrrd)):
            np.testing.assert_allclose(got, want)
        np.testing.assert_array_equal(palpation.nrrd_of(nrrd)[0], hu)


if __name__ == "__main__":
    unittest.main()
