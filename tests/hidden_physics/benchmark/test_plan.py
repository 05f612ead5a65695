"""Holds plan and sensor chain against what they promise."""
import collections
import json
import math
import pathlib
import sys
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import plan  # noqa: E402
import sensor_chain as chain  # noqa: E402
from made_set import MadeSet  # noqa: E402


class Plan(unittest.TestCase):
    def test_two_thousand_sets_differ_and_a_longer_list_begins_with_the_shorter(self):
        for rig in plan.GENERATORS:
            long = plan.planned_sets("development", rig, 2000)
            self.assertEqual(long[:40], plan.planned_sets("development", rig, 40))
            self.assertEqual(len({s.seed for s in long}), 2000)
            self.assertEqual(len({s.name for s in long}), 2000)

    def test_generations_share_no_set(self):
        seeds = [{s.seed for s in plan.planned_sets(g, "probing", 500)} for g in ("development", "frozen-1", "other")]
        self.assertFalse(seeds[0] & seeds[1] or seeds[0] & seeds[2] or seeds[1] & seeds[2])
        self.assertTrue(plan.is_frozen("frozen-1") and not plan.is_frozen("development"))

    def test_every_kind_of_every_generator_comes(self):
        for rig, names in plan.GENERATORS.items():
            sets = plan.planned_sets("g", rig, 800)
            for name in set(names):
                module = plan.generator_module(name)
                singles = {s.hidden[0] for s in sets if s.generator == name and s.kind == "one"}
                self.assertEqual(singles, set(module.CATALOGUE))
                self.assertEqual({s.hidden[0] for s in sets if s.generator == name and s.kind == "outside"},
                                 set(module.OUTSIDE))
            share = collections.Counter(s.kind for s in sets)
            self.assertEqual((share["nothing"], share["parameters"], share["one"]), (160, 80, 320))

    def test_pairs_are_two_effects_that_are_no_limit_of_one_another(self):
        for s in plan.planned_sets("g", "probing", 2000):
            if s.kind == "pair":
                self.assertEqual(len(set(s.hidden)), 2)
                self.assertFalse(any(set(s.hidden) <= family for family in plan.FAMILIES))

    def test_strengths_are_log_uniform(self):
        logs = [math.log(s.shares[0] * plan.SHARE_WITHIN) for s in plan.planned_sets("g", "palpation", 2000)]
        low, high = math.log(plan.WEAKEST), math.log(plan.STRONGEST)
        self.assertTrue(low <= min(logs) and max(logs) <= high)
        self.assertAlmostEqual(np.mean(logs), (low + high) / 2, delta=4 * (high - low) / math.sqrt(12 * 2000))

    def test_the_named_sets_are_there_with_their_reasons(self):
        listed = json.loads((pathlib.Path(__file__).parent / "named_sets.json").read_text())
        self.assertEqual([s.name for s in plan.named_sets()], [entry["name"] for entry in listed])
        self.assertTrue(all(entry["why"] and not plan.is_frozen(entry["generation"]) for entry in listed))

    def test_a_frozen_list_stays_what_it_was(self):
        first = plan.planned_sets("frozen-1", "probing", 1)[0]  # written down when the plan was made
        self.assertEqual((first.name, first.seed), FIRST_FROZEN)


FIRST_FROZEN = ("probing0001-closed_loop_hand-rotary_coulomb_friction", 391333975)

QUIET = {"delay_s": 0.0, "gain": 1.0, "noise_sd": {"N": 0.0, "Nm": 0.0}, "noise_time_constant_s": 0.01,
         "step": {"N": 0.0, "Nm": 0.0}, "clips_at": None, "clock_jitter_in_periods": 0.0, "dropped_share": 0.0,
         "longest_gap_rows": 3}


def trial(count=2000, rate_Hz=500.0):
    t = np.arange(count) / rate_Hz
    return {"t_s": t, "x_m": np.round(0.01 * np.sin(5 * t), 7), "fz_N": 8 * np.cos(5 * t)}


def passed(columns, rate_Hz=500.0, **changes):
    return chain.passed(np.random.default_rng(1), {**QUIET, **changes}, columns, 1 / rate_Hz)


class Chain(unittest.TestCase):
    def test_a_quiet_chain_changes_nothing(self):
        columns = trial()
        for name, values in passed(columns).items():
            np.testing.assert_allclose(values, columns[name], atol=1e-9)

    def test_the_force_comes_late(self):
        # the motion of the moment t + 2 ms stands beside the force of t
        shown = passed(trial(), delay_s=2e-3)
        np.testing.assert_allclose(shown["x_m"], 0.01 * np.sin(5 * (shown["t_s"] + 2e-3)), atol=2e-7)
        np.testing.assert_allclose(shown["fz_N"], 8 * np.cos(5 * shown["t_s"]), atol=1e-9)
        slow = {("px_m" if name == "x_m" else name): values for name, values in trial().items()}
        half = passed(slow, delay_s=0.7e-3)  # a hand's, between two samples
        np.testing.assert_allclose(half["px_m"][5:-5], 0.01 * np.sin(5 * (half["t_s"][5:-5] + 0.7e-3)), atol=2e-7)

    def test_a_late_force_has_its_motion_where_rows_are_missing_too(self):
        columns = {name: np.delete(values, [500, 501]) for name, values in trial().items()}
        shown = passed(columns, delay_s=4e-3)
        np.testing.assert_allclose(shown["x_m"], 0.01 * np.sin(5 * (shown["t_s"] + 4e-3)), atol=2e-7)
        self.assertEqual(len(shown["t_s"]), 2000 - 2 - 2 - 2)  # the gap, its shadow, the end

    def test_stamps_that_were_rounded_do_not_drift_against_the_samples(self):
        columns = trial(5000, 610.3515625)  # 1.6384 ms, written as 1.638 and 1.639 ms
        columns["t_s"] = np.round(columns["t_s"], 6)
        shown = passed(columns, 610.3515625, delay_s=1 / 610.3515625)
        self.assertEqual(len(shown["t_s"]), 4999)
        np.testing.assert_array_equal(shown["x_m"], columns["x_m"][1:])

    def test_gain_clipping_and_counts(self):
        shown = passed(trial(), gain=1.01, clips_at={"fz_N": 8.0}, step={"N": 0.05, "Nm": 0.0})
        self.assertAlmostEqual(shown["fz_N"].max(), 8.0)
        self.assertLess(np.abs(shown["fz_N"] / 0.05 - np.round(shown["fz_N"] / 0.05)).max(), 1e-6)
        middle = np.abs(trial()["fz_N"]) < 7
        np.testing.assert_allclose(shown["fz_N"][middle], 1.01 * trial()["fz_N"][middle], atol=0.0251)

    def test_noise_has_its_size_and_colour(self):
        # at 500 Hz and 10 ms neighbours have a correlation of exp(-0.2)
        shown = passed(trial(100000), noise_sd={"N": 0.3, "Nm": 0.0})
        noise = shown["fz_N"] - 8 * np.cos(5 * shown["t_s"])
        self.assertAlmostEqual(np.std(noise), 0.3, delta=0.01)
        self.assertAlmostEqual(np.mean(noise[1:] * noise[:-1]) / np.var(noise), math.exp(-0.2), delta=0.01)

    def test_rows_are_lost_in_short_gaps_and_times_rise(self):
        shown = passed(trial(), dropped_share=0.01, clock_jitter_in_periods=0.1)
        lost = 2000 - len(shown["t_s"])
        self.assertTrue(10 <= lost <= 20, lost)  # gaps may overlap
        steps = np.diff(shown["t_s"])
        self.assertGreater(steps.min(), 0)
        self.assertLess(steps.max(), 8 * 2e-3)  # two gaps of three rows side by side at most

    def test_the_model_is_rounded_and_far_off_only_where_it_is_free(self):
        model = {"fixed": ["/base/layers/*/damping_Ns_per_m"], "effects": [], "base": {"layers": [
            {"start_m": 0.0012346, "thickness_m": 0.01, "stiffness_N_per_m": 2345.678, "damping_Ns_per_m": 98.765}]}}
        near = chain.written_down(np.random.default_rng(1), model, False)["base"]["layers"][0]
        self.assertEqual(near, {"start_m": 0.0012346, "thickness_m": 0.01, "stiffness_N_per_m": 2350.0,
                                "damping_Ns_per_m": 98.765})
        ratios = [chain.written_down(np.random.default_rng(k), model, True)["base"]["layers"][0]["stiffness_N_per_m"]
                  / 2345.678 for k in range(200)]
        self.assertTrue(0.495 < min(ratios) < 0.55 and 1.8 < max(ratios) < 2.02)

    def test_a_set_tells_what_the_chain_did(self):
        made = MadeSet({"fixed": [], "effects": [], "base": {}}, {"noise": {"fz_N": 0.1}}, [("a", trial())], {},
                       {"sensor": {"rate_Hz": 500.0}})
        chain.pass_through(np.random.default_rng(3), made, False)
        told = made.truth["chain"]
        self.assertTrue(0 <= told["delay_s"] <= 2e-3 and 0.99 <= told["gain"] <= 1.01)
        self.assertAlmostEqual(made.stated["noise"]["fz_N"], math.hypot(0.1, told["noise_sd"]["N"]), delta=0.006)


if __name__ == "__main__":
    unittest.main()
