"""The calibration against maps that are known beforehand, and its promise that it never sees what it is judged by."""
import math
import pathlib
import random
import sys
import unittest

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent)]
import calibration  # noqa: E402
import scoring  # noqa: E402
from calibration import Map, Stated  # noqa: E402


def answers(count, offset, slope, generator="a", group="ended", seed=1):
    """Answers whose log odds of being right are offset + slope times those that they state."""
    source, made = random.Random(seed), []
    for _ in range(count):
        x = source.uniform(-4, 4)
        truth = 1 / (1 + math.exp(-(offset + slope * x)))
        made.append(Stated(generator, group, 1 / (1 + math.exp(-x)), source.random() < truth))
    return made


class Calibration(unittest.TestCase):
    def test_the_map_that_made_the_answers_is_found(self):
        found = calibration.fitted(answers(20000, -0.7, 0.5))
        self.assertAlmostEqual(found.offset, -0.7, delta=0.06)
        self.assertAlmostEqual(found.slope, 0.5, delta=0.04)

    def test_nothing_is_changed_by_no_answers(self):
        self.assertEqual(calibration.fitted([]), Map(0.0, 1.0))

    def test_one_wrong_answer_that_was_sure_moves_the_map_as_the_prior_allows(self):
        # By hand: offset a and slope 1 + s with s = a x / 4 (the same gradient times x and variance 1/4), x = ln 9, and
        # a + p = 0, p = 1 / (1 + exp(-(a + x + s x))).
        found = calibration.fitted([Stated("a", "ended", 0.9, False)])
        x = math.log(9)
        p = 1 / (1 + math.exp(-(found.offset + found.slope * x)))
        self.assertAlmostEqual(found.offset, -p, places=9)
        self.assertAlmostEqual(found.slope - 1, found.offset * x / 4, places=9)

    def test_a_generator_is_judged_by_maps_of_the_others(self):
        sure_and_wrong = [Stated("b", "ended", 0.99, False)] * 50
        found = calibration.left_out(answers(4000, 0.0, 1.0) + sure_and_wrong)
        (_, after) = found["b"]
        self.assertGreater(min(p for p, _ in after), 0.97)  # those of "a" are calibrated, so nothing was learnt of "b"
        (before, after) = found["a"]
        self.assertGreater(scoring.calibration_error(after), scoring.calibration_error(before) + 0.1)

    def test_over_confident_answers_of_a_new_generator_are_mended_by_the_others(self):
        all_of_them = [x for name, seed in (("a", 1), ("b", 2), ("c", 3))
                       for x in answers(3000, 0.0, 0.4, name, seed=seed)]
        for before, after in calibration.left_out(all_of_them).values():
            self.assertGreater(scoring.calibration_error(before), 0.1)
            self.assertLess(scoring.calibration_error(after), 0.03)
            self.assertLess(scoring.brier(after), scoring.brier(before))

    def test_two_maps_after_one_another_are_one(self):
        first, second = Map(0.3, 0.8), Map(-0.5, 1.4)
        for p in (0.05, 0.4, 0.9):
            self.assertAlmostEqual(second.after(first)(p), second(first(p)), places=12)

    def test_groups_are_calibrated_apart(self):
        maps = calibration.maps_of(answers(8000, 1.0, 1.0, group="more_is_missing") + answers(8000, 0.0, 1.0))
        self.assertAlmostEqual(maps["more_is_missing"].offset, 1.0, delta=0.1)
        self.assertAlmostEqual(maps["ended"].offset, 0.0, delta=0.1)

    def test_the_numbers_in_use_are_read_from_the_settings(self):
        text = "struct CalibrationSettings {\n  double ended_offset = -0.2;\n  double ended_slope = 0.9;\n" \
               "  double more_is_missing_offset = 0.1;\n  double more_is_missing_slope = 1.5;\n};\n"
        self.assertEqual(calibration.maps_in_use(text), {"ended": Map(-0.2, 0.9), "more_is_missing": Map(0.1, 1.5)})
        calibration.maps_in_use(calibration.SETTINGS.read_text())  # and they are there


if __name__ == "__main__":
    unittest.main()
