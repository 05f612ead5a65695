"""CT volumes of a drilled pedicle from analytic shapes, and the field that the palpation law takes from them."""
import gzip
import struct
from types import SimpleNamespace

import numpy as np

MM = 1e-3


def unit(vector):
    return vector / np.linalg.norm(vector, axis=-1, keepdims=True)


class Field:
    """-grad of the blurred opacity (Zoller2020, eq. (1)) as vectors at voxels, interpolated by Catmull-Rom."""

    def __init__(self, hu, origin_m, spacing_m, transfer):
        self.origin_m, self.spacing_m, self.size = np.asarray(origin_m), np.asarray(spacing_m), np.array(hu.shape)
        opacity = np.interp(hu, *np.array(transfer, float).T)
        taps = np.exp(-np.arange(-7, 8) ** 2 / 2)

        def shifted(grid, axis, by):  # edge voxels repeat outward
            return np.take(grid, np.clip(np.arange(grid.shape[axis]) + by, 0, grid.shape[axis] - 1), axis)

        for axis in range(3):
            opacity = sum(w * shifted(opacity, axis, k - 7) for k, w in enumerate(taps / taps.sum()))
        g = [(shifted(opacity, a, -1) - shifted(opacity, a, 1)) / (2 * spacing_m[a]) for a in range(3)]
        self.table = np.stack([*g, opacity], -1).reshape(-1, 4)

    def sample(self, p_m):
        """Field (1/m), its Jacobian J[i, j] = dg_i/dp_j (1/m^2) and the blurred opacity, at positions (..., 3)."""
        flat = p_m.reshape(-1, 3)
        out = np.concatenate([self._sample(flat[i:i + 4096]) for i in range(0, len(flat), 4096)])
        out = out.reshape(p_m.shape[:-1] + (4, 4))
        jacobian = np.swapaxes(out[..., 1:, :3] / self.spacing_m[:, None], -1, -2)
        return out[..., 0, :3], jacobian, out[..., 0, 3]

    def _sample(self, p_m):
        x = (p_m - self.origin_m) / self.spacing_m
        cell = np.floor(x)
        f = x - cell
        # the kernel of Catmull and Rom (1974) and its derivative, at the four neighbours along each axis
        w = np.stack([f * (-.5 + f * (1 - .5 * f)), 1 + f * f * (-2.5 + 1.5 * f),
                      f * (.5 + f * (2 - 1.5 * f)), f * f * (-.5 + .5 * f)], -1)
        d = np.stack([-.5 + f * (2 - 1.5 * f), f * (-5 + 4.5 * f), .5 + f * (4 - 4.5 * f), f * (-1 + 1.5 * f)], -1)
        i = np.clip(cell.astype(int)[:, :, None] + np.arange(-1, 3), 0, (self.size - 1)[:, None])
        index = (i[:, 0, :, None, None] * self.size[1] + i[:, 1, None, :, None]) * self.size[2] + i[:, 2, None, None]
        yz = w[:, 1, :, None] * w[:, 2, None, :]
        sets = [(w, yz), (d, yz), (w, d[:, 1, :, None] * w[:, 2, None, :]), (w, w[:, 1, :, None] * d[:, 2, None, :])]
        weights = np.stack([(a[:, 0, :, None, None] * b[:, None]).reshape(-1, 64) for a, b in sets], 1)
        return weights @ self.table[index.reshape(-1, 64)]


def draw_bone(rng):
    """CT of a drilled pedicle: int16 HU [x][y][z] in LPS order, its place, and the tract's analytic geometry."""
    in_plane = rng.uniform(0.4, 0.62)
    h = np.round([in_plane, in_plane, rng.uniform(in_plane, 0.8)], 2)  # mm
    tilt = np.radians([rng.choice([-1, 1]) * rng.uniform(5, 20), rng.uniform(-10, 10)])
    axis = unit(np.array([np.tan(tilt[0]), -1.0, np.tan(tilt[1])]))
    side, turn = unit(np.cross(axis, [0, 0, 1])), rng.uniform(0, np.pi)
    side = np.cos(turn) * side + np.sin(turn) * np.cross(axis, side)
    length, radii = rng.uniform(26, 33), rng.uniform(2.0, 3.2, 2)
    half = np.array([9 + 15 * abs(np.tan(tilt[0])), (length + 17) / 2, 9 + 15 * abs(np.tan(tilt[1]))])
    entry = rng.uniform([-40, 60, -300], [40, 140, 300])
    size = np.ceil(2 * half / h).astype(int)
    origin = np.round(entry + axis * (length / 2) - half, 2)
    at = np.stack(np.meshgrid(*[origin[k] + h[k] * np.arange(size[k]) for k in range(3)], indexing="ij"), -1) - entry
    frame = np.stack([side, np.cross(axis, side), axis], 1)  # columns: u, w, along the tract
    u, w, s = np.moveaxis(at @ frame, -1, 0)
    angle = np.arctan2(w, u)
    lateral = (np.hypot(u / radii[0], w / radii[1]) - 1) * np.sqrt(radii.prod())
    shell = rng.uniform(5.8, 7.0) + 0.8 * np.maximum(0, s - 0.6 * length) - np.hypot(u, w)
    depth = np.minimum(np.minimum(np.maximum(lateral, s - length), s), shell)  # mm into bone, from any surface
    share = 1 / (1 + np.exp(-np.clip(depth / rng.uniform(0.15, 0.35), -30, 30)))
    breach = {"angle_rad": rng.uniform(-np.pi, np.pi), "depth": rng.uniform(0.35, 0.8) * length,
              "size": rng.uniform(0.8, 1.4)}
    arc = np.angle(np.exp(1j * (angle - breach["angle_rad"]))) * 3.5
    share *= 1 - 0.95 * np.exp(-(arc ** 2 + (s - breach["depth"]) ** 2) / (2 * breach["size"] ** 2)) * (lateral > -2)
    soft, inner, marrow = rng.uniform(10, 60), rng.uniform(900, 1300), rng.uniform(350, 550)
    grade = 1 + 0.15 * np.cos(angle - rng.uniform(-np.pi, np.pi)) + rng.uniform(-0.1, 0.1) * s / length
    density = marrow + (inner * grade - marrow) * np.exp(-np.maximum(depth, 0) / rng.uniform(1.0, 2.5))
    correlation = rng.uniform(1.0, 3.0)  # mm; the autocorrelation of the noise is exp(-(r/correlation)^2)
    k2 = sum(np.meshgrid(*[(np.fft.fftfreq(size[k], h[k])) ** 2 for k in range(3)], indexing="ij"))
    noise = np.fft.ifftn(np.fft.fftn(rng.standard_normal(size)) * np.exp(-np.pi ** 2 * correlation ** 2 * k2 / 2)).real
    noise *= rng.uniform(60, 140) / noise.std()
    hu = soft + share * (density - soft + noise) + rng.uniform(4, 12) * rng.standard_normal(size)
    hu = np.clip(np.rint(hu), -1024, 3071).astype(np.int16)
    low, high = rng.uniform(150, 260), rng.uniform(650, 950)
    transfer = [[round(low), 0], [round(high), 1]]
    if rng.random() < 0.4:
        transfer.insert(1, [round((low + high) / 2), round(rng.uniform(0.35, 0.65), 2)])
    bone = SimpleNamespace(hu=hu, origin_m=origin * MM, spacing_m=h * MM, transfer=transfer, entry_m=entry * MM,
                           frame=frame, length_m=length * MM, radii_m=radii * MM, breach=breach,
                           facts={"trabecular_correlation_m": correlation * MM, "voxel_m": list(h * MM),
                                  "tract_radii_m": list(radii * MM), "tract_length_m": length * MM,
                                  "breach_depth_m": breach["depth"] * MM, "breach_angle_rad": breach["angle_rad"]})
    bone.field = Field(hu, bone.origin_m, bone.spacing_m, transfer)
    bone.axial_m = length * MM + np.arange(-4, 2, 0.02) * MM  # the end wall's push along the tract's axis
    push = -(bone.field.sample(bone.entry_m + bone.axial_m[:, None] * frame[:, 2])[0] @ frame[:, 2])
    bone.end_push_per_m, bone.axial_m = push[:push.argmax() + 1], bone.axial_m[:push.argmax() + 1]
    return bone


def volume_file(bone, nifti):
    """The volume as (file name, bytes): NIfTI-1 with axes R, A, S, or NRRD with axes L, P, S; both in mm."""
    h, origin, n = bone.spacing_m / MM, bone.origin_m / MM, bone.hu.shape
    if not nifti:
        head = ("NRRD0004\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: %d %d %d\n" % n
                + "space directions: (%g,0,0) (0,%g,0) (0,0,%g)\nkinds: domain domain domain\n" % tuple(h)
                + "endian: little\nencoding: gzip\nspace origin: (%.6g,%.6g,%.6g)\n\n" % tuple(origin))
        return "volume.nrrd", head.encode() + gzip.compress(bone.hu.tobytes("F"), 9, mtime=0)
    last = origin + h * (np.array(n) - 1)  # index 0 is leftmost and most posterior, where R and A are least
    rows = np.zeros((3, 4))
    rows[[0, 1, 2], [0, 1, 2]] = h
    rows[:, 3] = -last[0], -last[1], origin[2]
    head = (struct.pack("<i35xB8h", 348, 0, 3, *n, 1, 1, 1, 1) + struct.pack("<14x2h2x8f", 4, 16, 1, *h, 1, 1, 1, 1)
            + struct.pack("<3f", 352, 1, 0) + bytes([0, 0, 0, 2]) + bytes(252 - 124) + struct.pack("<2h", 0, 1)
            + bytes(24) + rows.astype("<f4").tobytes() + bytes(16) + b"n+1\0" + bytes(4))
    assert len(head) == 352
    return "volume.nii.gz", gzip.compress(head + bone.hu[::-1, ::-1].tobytes("F"), 9, mtime=0)
