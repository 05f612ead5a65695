"""Holds the definitions of the benchmark against values worked out by hand."""
import math
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import report  # noqa: E402
import scoring  # noqa: E402

FRICTION = {"id": "coulomb_friction", "contains": [], "parameters": [{"name": "friction_N", "unit": "N"}]}
CATALOGUE = {
    "coulomb_friction": FRICTION,
    "hysteresis": {"id": "hysteresis", "contains": ["coulomb_friction"], "parameters": [
        {"name": "stiffness_N_per_m", "unit": "N/m"}, {"name": "yield_displacement_m", "unit": "m"}]},
    "inertia": {"id": "inertia", "contains": [], "parameters": [{"name": "mass_kg", "unit": "kg"}]},
    "force_ripple": {"id": "force_ripple", "contains": [], "parameters": [{"name": "phase_rad", "unit": "rad"}]},
    "time_delay": {"id": "time_delay", "contains": [], "parameters": [{"name": "delay_s", "unit": "s"}]},
    "sensor_drift": {"id": "sensor_drift", "contains": ["sensor_bias"], "parameters": []},
}


def hidden(name, share=0.05, left=1.0, **numbers):
    return {"id": name, "parameters": numbers, "share_of_force_rms": share, "left_after_base_refit": left}


def truth_of(*effects, rig="probing", noise=0.1, **more):
    """10 N rms, 0.1 N of noise: an effect of 5 % makes 0.5 N."""
    return {"set": "set1", "rig": rig, "generator": "g", "kind": "one", "hidden": list(effects), "force_rms_N": 10.0,
            "force_noise_sd_N": noise, **more}


def reply_of(*named, verdict="missing", steps=(), probability=0.9, **more):
    effects = [{"id": n, "parameters": {}} if isinstance(n, str) else n for n in named]
    return {"answer": {"verdict": verdict, "effects": effects, "probability": probability, "steps": list(steps),
                       "base": {"noise_floor": 0.1}}, "wall_s": 2.0, **more}


def scored(truth, reply):
    return scoring.outcome(truth, reply, CATALOGUE)


class Truth(unittest.TestCase):
    def test_floor_adds_the_chain_to_the_generators_noise(self):
        # gain 0.99 on 0.1 N; chain 0.05 N; a step of 0.12 N is 0.12/sqrt(12) = 0.034641 N: sqrt(0.009801+0.0025+0.0012)
        chain = {"gain": 0.99, "noise_sd": {"N": 0.05, "Nm": 0.0}, "step": {"N": 0.12, "Nm": 0.0}}
        self.assertAlmostEqual(scoring.true_floor(truth_of(chain=chain)), math.sqrt(0.013501), places=9)

    def test_floor_holds_what_the_noise_of_the_motion_leaves_of_the_force(self):
        truth = truth_of(noise=0.3, chain={"motion_noise_as_force_N": 0.4})
        self.assertAlmostEqual(scoring.true_floor(truth), 0.5, places=9)

    def test_floor_of_a_vector_counts_the_chain_on_three_axes_and_the_noise_of_the_pose(self):
        # sqrt(0.3^2 + 0.4^2) = 0.5 N of the generator; 3 axes of 0.1 N: sqrt(0.25 + 0.03)
        truth = truth_of(rig="palpation", noise=0.3, sensor={"pose_noise_as_force_sd_N": 0.4},
                         chain={"gain": 1.0, "noise_sd": {"N": 0.1}, "step": {"N": 0.0}})
        self.assertAlmostEqual(scoring.true_floor(truth), math.sqrt(0.28), places=9)

    def test_gain_is_what_a_model_with_the_effect_takes_from_the_error(self):
        # left 0.3 N against 0.4 N of noise: 1 - 0.4/0.5 = 20 %
        self.assertAlmostEqual(scoring.gain(truth_of(noise=0.4), hidden("inertia", 0.05, 0.6)), 0.2, places=9)

    def test_two_percent_is_left_of_a_fifth_of_the_floor(self):
        # 1 - 1/sqrt(1 + q^2) = 0.02 at q = sqrt(1/0.98^2 - 1) = 0.20306
        truth = truth_of(hidden("inertia", 0.00202))  # 0.0202 N against 0.1 N
        self.assertFalse(scored(truth, reply_of()).detectable)
        self.assertTrue(scored(truth_of(hidden("inertia", 0.00204)), reply_of()).detectable)

    def test_torque_effects_are_held_against_the_torque(self):
        truth = truth_of(torque_rms_Nm=0.1, torque_noise_sd_Nm=0.004)
        effect = {**hidden("rotary_bias", 0.03), "channel": "tz_Nm"}  # 0.003 against 0.004: 1 - 4/5
        self.assertAlmostEqual(scoring.gain(truth, effect), 0.2, places=9)


class Answers(unittest.TestCase):
    def test_the_true_effect_alone_is_exact(self):
        o = scored(truth_of(hidden("inertia")), reply_of("inertia"))
        self.assertEqual((o.exact, o.right, o.named_in, o.wrong, o.missed), (True, True, True, (), ()))

    def test_a_second_effect_that_is_not_there_is_wrong_but_the_truth_is_named_in(self):
        o = scored(truth_of(hidden("inertia")), reply_of("inertia", "hysteresis"))
        self.assertEqual((o.exact, o.named_in, o.wrong), (False, True, ("hysteresis",)))

    def test_what_the_chain_truly_does_may_be_named(self):
        late = {"chain": {"delay_s": 1e-3, "gain": 1.0}}
        self.assertTrue(scored(truth_of(**late), reply_of("time_delay")).right)
        self.assertFalse(scored(truth_of(), reply_of("time_delay")).right)
        self.assertTrue(scored(truth_of(sensor={"wander_range_N": 0.1}), reply_of("sensor_drift")).right)
        self.assertTrue(scored(truth_of(hidden("inertia"), **late), reply_of("inertia", "time_delay")).exact)
        self.assertFalse(scored(truth_of(hidden("inertia"), **late), reply_of("time_delay")).exact)

    def test_nothing_is_right_only_without_an_alarm(self):
        self.assertTrue(scored(truth_of(), reply_of(verdict="complete")).right)
        self.assertFalse(scored(truth_of(), reply_of(verdict="unexplained")).right)
        self.assertFalse(scored(truth_of(), reply_of("inertia")).right)

    def test_what_is_in_no_catalogue_has_to_be_announced(self):
        truth = truth_of(hidden("work_softening"))
        self.assertTrue(scored(truth, reply_of(verdict="unexplained")).right)
        self.assertFalse(scored(truth, reply_of(verdict="complete")).right)
        o = scored(truth, reply_of("inertia", verdict="partly"))
        self.assertEqual((o.announced, o.right, o.wrong), (True, False, ("inertia",)))
        both = truth_of(hidden("inertia"), hidden("work_softening"))
        self.assertTrue(scored(both, reply_of("inertia", verdict="partly")).right)
        self.assertFalse(scored(both, reply_of("inertia", verdict="missing")).right)

    def test_an_effect_that_joins_the_catalogue_is_no_longer_outside(self):
        truth = truth_of(hidden("direction_dependent_viscosity"))
        wider = {**CATALOGUE, "direction_drag": {"id": "direction_drag", "contains": [], "parameters": []}}
        self.assertFalse(scored(truth, reply_of("direction_drag")).right)
        self.assertTrue(scoring.outcome(truth, reply_of("direction_drag"), wider).right)
        self.assertFalse(scoring.outcome(truth, reply_of(verdict="unexplained"), wider).right)

    def test_a_pair_needs_both(self):
        truth = truth_of(hidden("inertia"), hidden("coulomb_friction"))
        self.assertTrue(scored(truth, reply_of("coulomb_friction", "inertia")).right)
        o = scored(truth, reply_of("inertia"))
        self.assertEqual((o.right, o.missed), (False, ("coulomb_friction",)))

    def test_below_two_percent_nothing_and_the_truth_are_both_right(self):
        truth = truth_of(hidden("inertia", 0.001))
        for reply, right in ((reply_of(verdict="complete"), True), (reply_of("inertia"), True),
                             (reply_of("hysteresis"), False)):
            self.assertEqual(scored(truth, reply).right, right)
        pair = truth_of(hidden("inertia", 0.001), hidden("coulomb_friction"))
        self.assertTrue(scored(pair, reply_of("coulomb_friction")).right)
        self.assertFalse(scored(pair, reply_of("inertia")).right)

    def test_a_relative_of_the_truth_is_wrong_but_near(self):
        o = scored(truth_of(hidden("coulomb_friction")), reply_of("hysteresis"))
        self.assertEqual((o.right, o.near), (False, True))
        self.assertFalse(scored(truth_of(hidden("coulomb_friction")), reply_of("inertia")).near)

    def test_an_effect_that_lowers_nothing_is_useless(self):
        steps = [{"model": "base", "held_out_rmse": 0.211}, {"model": "+ coulomb_friction", "held_out_rmse": 0.214},
                 {"model": "+ inertia", "held_out_rmse": 0.2}]
        self.assertEqual(scored(truth_of(), reply_of("coulomb_friction", "inertia", steps=steps)).useless,
                         ("coulomb_friction",))

    def test_a_model_that_leaves_no_less_of_fresh_trials_is_useless(self):
        def useless(fresh, base, *named):
            return scored(truth_of(), reply_of(*named, fresh={"rmse": fresh}, fresh_base={"rmse": base})).useless
        self.assertEqual(useless(0.2, 0.2, "inertia"), ("fresh trials",))
        self.assertEqual(useless(0.19, 0.2, "inertia"), ())
        self.assertEqual(useless(0.2, 0.2), ())
        fresh, base = {"rmse": 0.2, "other_rmse": [0.001]}, {"rmse": 0.2, "other_rmse": [0.004]}
        self.assertEqual(scored(truth_of(), reply_of("rotary_stiffness", fresh=fresh, fresh_base=base)).useless, ())
        self.assertEqual(scored(truth_of(), reply_of("rotary_stiffness", fresh=base, fresh_base=fresh)).useless,
                         ("fresh trials",))

    def test_errors_are_counted_in_true_floors(self):
        steps = [{"model": "base", "held_out_rmse": 0.5}, {"model": "+ inertia", "held_out_rmse": 0.12}]
        right = {"fresh": {"rmse": 0.103, "phases": [{"rmse": 0.15, "share_of_time": 0.5},
                                                     {"rmse": 9.0, "share_of_time": 0.01},
                                                     {"rmse": None, "share_of_time": 0.4}]}}
        o = scored(truth_of(hidden("inertia")), reply_of("inertia", steps=steps, right_model=right,
                                                          fresh={"rmse": 0.11}))
        self.assertAlmostEqual(o.held_out_over_floor, 1.2)
        self.assertAlmostEqual(o.fresh_over_floor, 1.1)
        self.assertAlmostEqual(o.right_model_over_floor, 1.03)
        self.assertAlmostEqual(o.right_model_worst_phase, 1.5)

    def test_no_answer_is_not_right(self):
        o = scored(truth_of(), {"failed": "layer 2 lies inside layer 1", "wall_s": 0.1})
        self.assertEqual((o.right, o.failed), (False, "layer 2 lies inside layer 1"))


class Intervals(unittest.TestCase):
    def covered(self, effect, truth):
        return scored(truth, reply_of(effect)).covered

    def test_ninety_percent_reach_1_645_standard_errors(self):
        truth = truth_of(hidden("inertia", mass_kg=2.0))
        for value, inside in ((2.164, True), (2.165, False), (1.836, True)):
            effect = {"id": "inertia", "parameters": {"mass_kg": {"value": value, "sd": 0.1}}}
            self.assertEqual(self.covered(effect, truth), (inside,))

    def test_the_gain_scales_forces_and_the_delays_add(self):
        # 2 kg at a gain of 1.01 is recorded as 2.02 kg; 3 ms hidden and 1.5 ms of the chain are 4.5 ms
        chain = {"delay_s": 1.5e-3, "gain": 1.01}
        effect = {"id": "inertia", "parameters": {"mass_kg": {"value": 2.02, "sd": 0.001}}}
        self.assertEqual(self.covered(effect, truth_of(hidden("inertia", mass_kg=2.0), chain=chain)), (True,))
        effect = {"id": "time_delay", "parameters": {"delay_s": {"value": 4.5e-3, "sd": 1e-5}}}
        self.assertEqual(self.covered(effect, truth_of(hidden("time_delay", delay_s=3e-3), chain=chain)), (True,))

    def test_an_angle_is_the_same_after_a_turn(self):
        effect = {"id": "force_ripple", "parameters": {"phase_rad": {"value": 3.13, "sd": 0.05}}}
        self.assertEqual(self.covered(effect, truth_of(hidden("force_ripple", phase_rad=-3.13))), (True,))


class Groups(unittest.TestCase):
    def test_wilson_interval_of_nine_of_ten(self):
        # (0.9 + 0.19207 ± 1.96 sqrt(0.009 + 0.0096037)) / 1.384146, by hand: 0.5958 and 0.9821 (Newcombe 1998, table)
        low, high = scoring.wilson(9, 10)
        self.assertAlmostEqual(low, 0.5958, places=4)
        self.assertAlmostEqual(high, 0.9821, places=4)
        self.assertEqual(scoring.wilson(0, 0), (0.0, 1.0))

    def test_brier_and_calibration_by_hand(self):
        # bin 0.9: stated 0.95 and 0.95, right 1 of 2: off by 0.45; bin 0.5: 0.5 stated, right: off by 0.5
        stated = [(0.95, True), (0.95, False), (0.5, True)]
        self.assertAlmostEqual(scoring.brier(stated), (0.0025 + 0.9025 + 0.25) / 3)
        self.assertEqual(scoring.reliability(stated), [(0.5, 1.0, 1), (0.95, 0.5, 2)])
        self.assertAlmostEqual(scoring.calibration_error(stated), (2 * 0.45 + 0.5) / 3)
        self.assertEqual(scoring.reliability([(1.0, True)]), [(1.0, 1.0, 1)])

    def test_median_and_quantile(self):
        self.assertEqual(scoring.median([3, None, 1, 2]), 2)
        self.assertEqual(scoring.median([1, 2, 3, 10]), 2.5)
        self.assertEqual(scoring.quantile(list(range(1, 11)), 0.9), 9)

    def test_sets_below_two_percent_stand_apart(self):
        outcomes = [scored(truth_of(hidden("inertia")), reply_of("inertia")),
                    scored(truth_of(hidden("inertia", 0.001)), reply_of("hysteresis")),
                    scored(truth_of(), reply_of("inertia")), scored(truth_of(), reply_of(verdict="complete")),
                    scored(truth_of(hidden("work_softening")), reply_of(verdict="unexplained"))]
        f = scoring.figures(outcomes)
        self.assertEqual((f["single_exact"].hits, f["single_exact"].count), (1, 1))
        self.assertEqual((f["undetectable_right"].hits, f["undetectable_right"].count), (0, 1))
        self.assertEqual((f["nothing_said_nothing"].hits, f["nothing_said_nothing"].count), (1, 2))
        self.assertEqual(f["false_alarm"].hits, 1)
        self.assertEqual((f["outside_right"].hits, f["outside_right"].count), (1, 1))
        self.assertEqual((f["right"].hits, f["right"].count), (3, 4))


class Page(unittest.TestCase):
    def test_an_effect_that_joins_the_catalogue_and_that_no_generator_hides_is_said(self):
        catalogue = {"probing": {"coulomb_friction": FRICTION, "new_effect": {}}, "palpation": {}}
        rows = dict(report.unhidden(catalogue)[1:])
        self.assertEqual(rows["closed_loop_hand"], "new_effect")
        self.assertEqual(rows["point_cloud_probe"], "none")

    def test_the_curve_has_a_point_for_each_bin(self):
        curve = report.reliability_curve([(0.5, 1.0, 1), (0.95, 0.5, 2)])
        self.assertEqual(curve.count("<circle"), 2)
        self.assertIn("2 sets: stated 0.950, right 0.500", curve)

    def test_a_rate_is_shown_with_its_interval(self):
        self.assertEqual(report.shown_rate(scoring.Rate(9, 10)), "9/10 90 % (60-98)")
        self.assertEqual(report.shown_rate(scoring.Rate(0, 0)), "-")

    def test_names_are_escaped(self):
        self.assertIn("&lt;b&gt;", report.page("<b>", [("h", [["x"], ["<b>"]])], {}))


if __name__ == "__main__":
    unittest.main()
