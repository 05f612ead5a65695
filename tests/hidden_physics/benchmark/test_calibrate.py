"""Holds the calibration against labels worked out by hand and against odds that simulated answers were drawn from."""
import math
import pathlib
import sys
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import calibrate  # noqa: E402

CATALOGUE = {"coulomb_friction": {}, "rotary_bias": {}}  # as `tractus effects` has it: without a channel


def hidden(name, share, channel="fz_N"):
    return {"id": name, "share_of_force_rms": share, "left_after_base_refit": 1.0, "channel": channel}


def truth_of(*effects):
    """10 N and 1 N m rms, 0.1 N and 0.01 N m of noise: an effect of 5 % makes 0.5 N."""
    return {"rig": "probing", "generator": "g", "hidden": list(effects), "force_rms_N": 10.0, "force_noise_sd_N": 0.1,
            "torque_rms_Nm": 1.0, "torque_noise_sd_Nm": 0.01}


def part(*named, error=0.1, floor=0.1, share=0.0):
    return {"effects": [{"id": name} for name in named], "rest_explained": share,
            "steps": [{"held_out_rmse": error, "noise_floor": floor}]}


class Rows(unittest.TestCase):
    def row(self, truth, named=(), channel="force", **what):
        return calibrate.row_of(truth, channel, part(*named, **what), CATALOGUE)

    def test_more_is_missing_where_a_material_effect_is_not_named(self):
        truth = truth_of(hidden("coulomb_friction", 0.05))
        self.assertTrue(self.row(truth)["more"])
        self.assertFalse(self.row(truth, ["coulomb_friction"])["more"])
        self.assertTrue(self.row(truth_of(hidden("outside", 0.05)), ["coulomb_friction"])["more"])

    def test_an_effect_too_small_to_lower_the_error_is_not_missing(self):
        # 0.1 % of 10 N beside 0.1 N: the error rises by 0.5 %.
        self.assertFalse(self.row(truth_of(hidden("coulomb_friction", 0.001)))["more"])

    def test_force_and_torque_are_judged_by_themselves(self):
        truth = truth_of(hidden("rotary_bias", 0.05, "tz_Nm"))
        self.assertFalse(self.row(truth)["more"])
        about_axis = self.row(truth, channel="tz_Nm")
        self.assertTrue(about_axis["more"])
        self.assertEqual(about_axis["channel"], "torque")
        self.assertFalse(self.row(truth, ["rotary_bias"], channel="tz_Nm")["more"])

    def test_the_error_counts_from_the_floor_on(self):
        self.assertAlmostEqual(self.row(truth_of(), error=0.2)["above"], math.log(2.0))
        self.assertEqual(self.row(truth_of(), error=0.09)["above"], 0.0)


class Fit(unittest.TestCase):
    def test_finds_the_odds_that_answers_were_drawn_from(self):
        random = np.random.default_rng(3)
        true = np.array([-2.0, -3.0, -1.0, 4.0, 2.0, 6.0, 5.0, 12.0])
        rows = [{"channel": calibrate.CHANNELS[k % 3], "above": float(random.exponential(0.4)),
                 "share": float(random.choice([0.0, random.uniform(0, 0.5)])),
                 "law_share": float(random.choice([0.0, random.uniform(0, 0.2)]))} for k in range(30000)]
        x = np.array([calibrate.features(row) for row in rows])
        p = calibrate.probability(x, true)
        for row, more in zip(rows, random.random(len(rows)) < p):
            row["more"] = bool(more)
        error = np.sqrt(np.diag(np.linalg.inv((x * (p * (1 - p))[:, None]).T @ x)))  # Fisher's information
        self.assertLess(np.max(np.abs(calibrate.fitted(rows) - true) / error), 3.5)

    def test_keeps_to_the_prior_where_there_are_no_answers(self):
        rows = [{"channel": "probing", "above": 0.0, "share": 0.0, "law_share": 0.0, "more": False}]
        np.testing.assert_allclose(calibrate.fitted(rows)[[1, 2, 4, 5]], calibrate.PRIOR_MEAN[[1, 2, 4, 5]])


if __name__ == "__main__":
    unittest.main()
