"""Checks of the generator point_cloud_probe against values worked out by hand. Run: python3 -m unittest -v FILE"""
import gzip
import pathlib
import struct
import sys
import tempfile
import unittest
from types import SimpleNamespace

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import point_cloud_probe as generator  # noqa: E402
from made_set import write  # noqa: E402
from point_cloud.bone import Field, draw_bone  # noqa: E402
from point_cloud.effects import EFFECTS  # noqa: E402
from point_cloud.hand import Motion  # noqa: E402
from point_cloud.physics import bending, contact, equilibrium  # noqa: E402


def paper_rig(points=1, factor=1.0):
    """The shank of Zoller2020: E = 195 GPa, L = 130 mm, r = 0.7 mm."""
    rig = SimpleNamespace(z=0.13 - 0.009 * np.arange(points), length=0.13, rest=np.zeros((points, 2)), factor=factor,
                          ball=None, sharp=0.0, elastic=[])
    probe = SimpleNamespace(youngs_modulus_Pa=1.95e11)
    rig.phi, rig.k = bending(rig, probe, 0.0007, 0.0007)
    return rig, probe


class Wall:
    """A field that grows linearly: g = -K (x - x0) along x, known by hand."""

    def sample(self, p):
        g, j = np.zeros(p.shape), np.zeros(p.shape + (3,))
        g[..., 0], j[..., 0, 0] = -2000.0 * (p[..., 0] - 0.001), -2000.0
        return g, j, np.ones(p.shape[:-1])


class FieldTest(unittest.TestCase):
    def test_a_linear_ramp_gives_its_slope_per_metre(self):
        # opacity (100 + 10 i)/1000 rises by 0.01 a voxel of 0.5 mm: 20 per metre; blurring keeps a ramp
        hu = np.broadcast_to(100.0 + 10 * np.arange(40)[:, None, None], (40, 30, 30))
        field = Field(hu, [0.1, 0.2, 0.3], [0.0005, 0.0006, 0.0007], [[0, 0], [1000, 1]])
        g, jacobian, opacity = field.sample(np.array([[0.1 + 20.3 * 0.0005, 0.209, 0.31]]))
        np.testing.assert_allclose(g, [[-20, 0, 0]], atol=1e-9)
        np.testing.assert_allclose(opacity, 0.1 + 0.01 * 20.3, atol=1e-12)
        np.testing.assert_allclose(jacobian, 0, atol=1e-6)

    def test_a_flat_wall_has_the_gradient_of_a_sampled_gaussian(self):
        # A step of opacity between voxels 9 and 10: a blurred voxel holds the sum of the taps that reach past it. At
        # voxel 9 the central difference is (w(0) + w(1)) / 2h, with w(k) = exp(-k^2/2)/2.506628 = 0.398942, 0.241971.
        hu = np.broadcast_to(np.where(np.arange(20) > 9, 1000.0, 0.0)[:, None, None], (20, 9, 9))
        field = Field(hu, [0, 0, 0], [0.001] * 3, [[0, 0], [1000, 1]])
        g = field.sample(np.array([[0.009, 0.004, 0.004]]))[0]
        np.testing.assert_allclose(g[0], [-(0.398942 + 0.241971) / 0.002, 0, 0], rtol=2e-6)

    def test_the_jacobian_is_the_derivative_of_the_field(self):
        bone = draw_bone(np.random.default_rng(1))
        p = bone.entry_m + np.random.default_rng(2).uniform(-2, 2, (20, 3)) * 1e-3 + 0.01 * bone.frame[:, 2]
        jacobian = bone.field.sample(p)[1]
        for axis, h in enumerate(np.eye(3) * 1e-7):
            slope = (bone.field.sample(p + h)[0] - bone.field.sample(p - h)[0]) / 2e-7
            np.testing.assert_allclose(jacobian[..., axis], slope, atol=1e-2 * abs(jacobian).max() / 100)


class ShankTest(unittest.TestCase):
    def test_the_uniform_shank_is_the_cantilever_of_the_paper(self):
        rig, _ = paper_rig(3)
        # 3 E I/L^3 with I = pi r^4/4 = 1.88574e-13 m^4: 50.2117 N/m
        self.assertAlmostEqual(rig.k, 3 * 1.95e11 * 1.8857410e-13 / 0.13 ** 3, delta=1e-4)
        np.testing.assert_allclose(rig.phi, rig.z ** 2 * (0.39 - rig.z) / (2 * 0.13 ** 3), atol=1e-6)

    def test_the_tapered_shank_has_its_closed_form(self):
        rig, probe = paper_rig()
        # tip compliance 4 L^3/(3 pi E r_tip r_handle^3), the integral of (L - z)^2/(E I)
        k = bending(rig, probe, 0.001, 0.0004)[1]
        self.assertAlmostEqual(1 / k, 4 * 0.13 ** 3 / (3 * np.pi * 1.95e11 * 0.0004 * 0.001 ** 3), delta=1e-6 / k)

    def test_equilibrium_with_a_linear_wall(self):
        # one point at the tip: k d = -K (d - 1 mm) gives d = K/(k + K) 1 mm, and a sideways push of 0.02 N adds 0.02/k
        rig, _ = paper_rig()
        extra = np.array([[[0, 0.02, 0.5]]])
        d = equilibrium(rig, Wall(), np.zeros((1, 3)), np.eye(3)[None], np.zeros((1, 2)), extra)
        np.testing.assert_allclose(d, [[2000 * 0.001 / (2000 + rig.k), 0.02 / rig.k]], rtol=1e-6)

    def test_the_ball_rule_is_exact_for_squares(self):
        rig, probe = paper_rig()
        EFFECTS["tip_ball"].law(rig, probe, {"radius_m": 2.0})
        nodes, weights = rig.ball
        self.assertAlmostEqual(weights.sum(), 1)
        np.testing.assert_allclose(weights @ nodes ** 2, 4 / 5)  # the mean of x^2 over a ball is R^2/5
        np.testing.assert_allclose(weights @ (nodes[:, 0] ** 4), 16 * 3 / 35)


class EffectTest(unittest.TestCase):
    def setUp(self):
        rng = np.random.default_rng(4)
        self.c = SimpleNamespace(force=rng.normal(size=(2, 300, 3, 3)), v=0.01 * rng.normal(size=(2, 300, 3, 3)),
                                 dt=0.005, opacity=rng.uniform(size=(2, 300, 3)), factor=0.005)

    def test_friction_takes_power_and_stays_in_its_cone(self):
        f = EFFECTS["contact_friction"].law(self.c, {"coefficient": 0.3})
        self.assertTrue(((f * self.c.v).sum(-1) <= 0).all())
        self.assertTrue((np.linalg.norm(f, axis=-1) <= 0.3 * np.linalg.norm(self.c.force, axis=-1) + 1e-12).all())
        np.testing.assert_allclose((f * self.c.force).sum(-1), 0, atol=1e-12)

    def test_presliding_builds_up_over_its_displacement(self):
        c = self.c
        c.force, c.v = np.zeros((1, 400, 1, 3)), np.zeros((1, 400, 1, 3))
        c.force[..., 0], c.v[..., 1] = 2.0, 0.002  # slides 2 mm/s across a push of 2 N
        f = EFFECTS["presliding_memory"].law(c, {"coefficient": 0.25, "yield_displacement_m": 0.001})
        self.assertAlmostEqual(f[0, 99, 0, 1], -0.5 * (1 - np.exp(-1.0)))  # after 1 mm
        self.assertAlmostEqual(f[0, -1, 0, 1], -0.5, delta=0.01)

    def test_creep_relaxes_to_its_share(self):
        c = SimpleNamespace(force=np.ones((1, 4000, 1, 3)), dt=0.005)
        f = EFFECTS["wall_creep"].law(c, {"share": 0.2, "fast_s": 0.2, "slow_s": 2.0})
        self.assertAlmostEqual(f[0, 399, 0, 0], -0.1 * (2 - np.exp(-2 / 0.2) - np.exp(-2 / 2.0)))

    def test_the_slope_of_an_elastic_effect_is_its_derivative(self):
        bone = draw_bone(np.random.default_rng(1))
        rig = paper_rig(3, 0.01)[0]
        effect = EFFECTS["contact_nonlinearity"]
        rig.elastic = [(effect.law, {"exponent": 1.4, "reference_gradient_per_m": 200, "_factor": 0.01})]
        r = np.roll(np.eye(3), 1, 0)[None]  # any rotation
        o = (bone.entry_m + 0.01 * bone.frame[:, 2] + 0.0024 * bone.frame[:, 0] - 0.13 * r[0, :, 2])[None]
        force, slope = contact(rig, bone.field, o, r, np.zeros((1, 2)))[1:3]
        self.assertGreater(np.linalg.norm(force[0, 0]), 0.5)
        for axis, h in enumerate(np.eye(3) * 1e-7):
            ends = [contact(rig, bone.field, o + s * h, r, np.zeros((1, 2)))[1] for s in (-1, 1)]
            by_difference = (ends[1] - ends[0])[0, 0] / 2e-7
            np.testing.assert_allclose(slope[0, 0, :, axis], by_difference, atol=1e-3 * abs(slope).max())

    def test_hysteresis_loses_only_on_the_way_out(self):
        f = EFFECTS["contact_hysteresis"].law(self.c, {"loss": 0.4})
        power = (self.c.v * self.c.force).sum(-1) / np.linalg.norm(self.c.force, axis=-1)
        np.testing.assert_allclose(f[power < -0.002], 0, atol=1e-6)
        np.testing.assert_allclose(f[power > 0.002], -0.4 * self.c.force[power > 0.002], atol=1e-6)

    def test_weight_and_inertia_by_hand(self):
        bone = SimpleNamespace(entry_m=np.zeros(3), frame=np.eye(3))
        t = np.arange(200) * 0.005
        control = np.zeros((1, 200, 6))
        control[0, :, 2] = 0.5 * 2.0 * t ** 2 - 0.2  # the probe moves along z of V with 2 m/s^2
        motion = Motion(bone, 0.1, control, np.zeros((1, 200, 2)))
        times = np.array([[0.3, 0.5]])
        o, r = motion.pose(times)
        c = SimpleNamespace(motion=motion, t=times, o=o, r=r)
        q = {"mass_kg": 0.05, "centre_m": 0.04}
        np.testing.assert_allclose(EFFECTS["probe_inertia"].law(c, q)[0], 2 * [[0, 0, -0.1, 0, 0, 0]], atol=1e-6)
        # down is -y of V, which is -y of H here: f = (0, -0.4903, 0), torque = 40 mm z x f = (+0.0196, 0, 0)
        weight = 0.05 * 9.80665
        np.testing.assert_allclose(EFFECTS["probe_weight"].law(c, q)[0], 2 * [[0, -weight, 0, 0.04 * weight, 0, 0]],
                                   atol=1e-9)


class RefitTest(unittest.TestCase):
    def setUp(self):
        self.world = generator.World.__new__(generator.World)
        self.world.t_s = np.stack([np.linspace(0, 8, 801), np.linspace(0, 7, 801)])
        self.world.base = np.zeros((2, 801, 6))
        self.world._columns = [np.tile(np.sin(40 * self.world.t_s)[..., None], 3).ravel()]
        self.rng = np.random.default_rng(3)

    def test_what_the_base_takes_up_is_not_left(self):
        fast = np.tile(np.cos(40 * self.world.t_s)[..., None], 3)
        mixed = 3 * self.world._columns[0].reshape(2, 801, 3) + 4 * fast  # 3, 4, 5: four fifths are left
        self.assertAlmostEqual(self.world.left_share(mixed), 0.8, delta=0.002)
        self.assertAlmostEqual(self.world.left_share(mixed, "tip_ball", fast), 0, delta=1e-9)

    def test_a_drift_takes_up_any_of_its_courses_in_each_trial_and_axis(self):
        share = self.world.t_s / self.world.t_s[:, -1:]
        waves = np.cos(np.pi * share[..., None] * [0, 1, 2, 3])
        course = np.einsum("jmk,jka->jma", waves, self.rng.normal(size=(2, 4, 3)))
        self.assertGreater(self.world.left_share(course), 0.99)
        self.assertAlmostEqual(self.world.left_share(course, "sensor_drift", course), 0, delta=1e-9)
        fast = np.tile(np.cos(60 * self.world.t_s)[..., None], 3)
        self.assertGreater(self.world.left_share(fast, "sensor_drift", course), 0.98)


class SetTest(unittest.TestCase):
    def assert_alike(self, one, other):
        """Equal but for the last digits of numbers: sums over a matrix library's threads differ there."""
        if isinstance(one, dict):
            self.assertEqual(one.keys(), other.keys())
            for key in one:
                self.assert_alike(one[key], other[key])
        elif isinstance(one, list):
            self.assertEqual(len(one), len(other))
            for a, b in zip(one, other):
                self.assert_alike(a, b)
        elif isinstance(one, float):
            np.testing.assert_allclose(one, other, rtol=1e-4, atol=1e-9)
        else:
            self.assertEqual(one, other)

    def test_a_set_keeps_the_contract(self):
        self.assertEqual(set(generator.CATALOGUE) | set(generator.OUTSIDE), set(EFFECTS))
        made, again = (generator.make(101, ["time_delay"]) for _ in range(2))
        self.assert_alike(made.truth, again.truth)
        for (name, columns), (_, other) in zip(made.trials, again.trials):
            self.assertEqual(",".join(columns), "t_s,px_m,py_m,pz_m,qw,qx,qy,qz,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm")
            for key in columns:
                np.testing.assert_allclose(columns[key], other[key], rtol=1e-5, atol=1e-9)
            self.assertTrue((np.diff(columns["t_s"]) > 0).all())
        share = made.truth["hidden"][0]["share_of_force_rms"]
        self.assertTrue(0.036 < share < 0.11 and made.truth["accepted"] and 1 < made.truth["force_peak_N"] < 8)
        self.assertEqual(made.extra_files, again.extra_files)
        with tempfile.TemporaryDirectory() as folder:
            write(made, folder)
            files = [p for p in pathlib.Path(folder).rglob("*") if p.is_file()]
            self.assertLess(sum(p.stat().st_size for p in files), 3e6)
            first = (pathlib.Path(folder) / "measurements" / "palpation01.csv").read_text().splitlines()[5]
            self.assertNotIn("e", first)
            self.assertEqual(len(first.split(",")), 14)

    def test_both_volume_files_hold_the_same_voxels_at_the_same_place(self):
        bone = draw_bone(np.random.default_rng(6))
        text, packed = generator.volume_file(bone, False)[1].split(b"\n\n", 1)
        self.assertEqual(gzip.decompress(packed), bone.hu.tobytes("F"))
        nifti = gzip.decompress(generator.volume_file(bone, True)[1])
        self.assertEqual(struct.unpack("<4h", nifti[40:48]), (3, *bone.hu.shape))
        rows = np.frombuffer(nifti[280:328], "<f4").reshape(3, 4)
        voxels = np.frombuffer(nifti[352:], "<i2").reshape(bone.hu.shape, order="F")
        index = np.array([3, 5, 7])
        ras_mm = rows[:, :3] @ index + rows[:, 3]
        at = np.rint((ras_mm * [-1, -1, 1] * 1e-3 - bone.origin_m) / bone.spacing_m).astype(int)
        self.assertEqual(voxels[tuple(index)], bone.hu[tuple(at)])

    def test_the_hand_rests_where_the_shank_is_in_equilibrium(self):
        bone = draw_bone(np.random.default_rng([7, 0]))
        world = generator.World(7, 0, bone)
        o, r = world.motion.pose(world.t_s)
        rig = generator.rig_of(world.probe, [])
        f = contact(rig, bone.field, o[:, 300], r[:, 300], world.bend[:, 300])[1]
        bent = np.einsum("i,nia,nak->nk", rig.phi, f, r[:, 300][..., :2])
        np.testing.assert_allclose(rig.k * world.bend[:, 300], bent, atol=1e-6)


if __name__ == "__main__":
    unittest.main()
