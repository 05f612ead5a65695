"""The drilling law, slow and plain: an oracle for Tractus, written from the law's words and sharing no code with it.

    law.py FOLDER

FOLDER holds what a recorded drilling and its bone are, written by whoever asks:
    setup.json   {"dims", "spacing_m", "origin_m", "directions" (rows), "slope", "intercept", "length_m",
                  "transfer" [[value, opacity], ...], "burr" {...}}
    bone.u16     counts [k][j][i], 16 bits, little-endian
    drilled.u16  the product's own answer, likewise
    samples.csv  t_s, p (m), q (w x y z), deflection (m), force (N), pressed, stale: a row a tick
Prints JSON: removed_m3 and how far the product's voxels are off.

Source: the voxel removal and the push per opacity as shared/drilling/burr.hpp and erosion.hpp word them,
    dm/dt = -rho(F / mean opacity) (1 - d^2 / r^2)   within the ball,   c = c0 - round(m (c0 - c_empty)).
What is numerically different from the product: double precision; each tick's sweep integrated in closed form along its
straight line, where the product adds up balls; every tick wears by itself, where the product gathers those that lie close.
"""
import csv
import json
import sys

import numpy as np

LONGEST_S, FARTHEST_M = 0.020, 0.020  # a stall or a jump: the ball only starts there


def turned(q, v):
    """v rotated by the unit quaternion q = (w, x, y, z)."""
    w, u = q[0], np.asarray(q[1:])
    return v + 2.0 * np.cross(u, np.cross(u, v) + w * v)


def swept(rel, along, r):
    """Integral over s in [0, 1] of max(0, 1 - |rel - s along|^2 / r^2), for each row of rel (..., 3)."""
    a = float(along @ along)
    b = rel @ along
    c = np.einsum("...k,...k", rel, rel)
    if a < 1e-20:
        return np.clip(1.0 - c / r**2, 0.0, None)
    root = b * b - a * (c - r * r)  # where the line is within the ball
    inside = root > 0.0
    half = np.sqrt(np.where(inside, root, 0.0))
    low, high = (np.clip((b + sign * half) / a, 0.0, 1.0) for sign in (-1.0, 1.0))
    integral = lambda s: s - (c * s - b * s**2 + a * s**3 / 3.0) / r**2
    return np.where(inside, np.clip(integral(high) - integral(low), 0.0, None), 0.0)


class Bone:
    def __init__(self, folder):
        setup = json.load(open(f"{folder}/setup.json"))
        self.burr, self.length = setup["burr"], setup["length_m"]
        dims = tuple(setup["dims"])
        read = lambda name: np.fromfile(f"{folder}/{name}", "<u2").reshape(dims[::-1])
        self.whole, self.theirs = read("bone.u16").astype(np.int64), read("drilled.u16").astype(np.int64)
        self.now = self.whole.copy()
        self.lost = np.zeros(self.whole.shape)
        at, opacity = zip(*setup["transfer"])
        self.opacity = np.interp(setup["intercept"] + setup["slope"] * np.arange(1 << 16), at, opacity)
        emptied = 0.0 if np.interp(0.0, at, opacity) == 0.0 else at[0]  # water, blood
        self.empty = round((emptied - setup["intercept"]) / setup["slope"])
        self.spacing, self.origin = np.array(setup["spacing_m"]), np.array(setup["origin_m"])
        self.directions = np.array(setup["directions"])
        self.dims, self.r = np.array(dims), self.burr["radius_m"]

    def place(self, p):
        """A point in metres along the voxel axes from the first voxel's centre."""
        return self.directions.T @ (p - self.origin)

    def near(self, *points):
        """Slices (k, j, i) of a box about the balls at these points, and the places of its voxels."""
        low = np.maximum(np.floor((np.min(points, 0) - self.r) / self.spacing), 0).astype(int)
        high = np.minimum(np.ceil((np.max(points, 0) + self.r) / self.spacing) + 1, self.dims).astype(int)
        if (low >= high).any():
            return None, None
        i, j, k = (np.arange(l, h) * s for l, h, s in zip(low, high, self.spacing))
        where = np.stack(np.broadcast_arrays(i[None, None, :], j[None, :, None], k[:, None, None]), -1)
        return tuple(slice(l, h) for l, h in zip(low[::-1], high[::-1])), where

    def mean_opacity(self, at):
        box, where = self.near(at)
        if box is None:
            return 0.0
        weight = np.clip(1.0 - ((where - at) ** 2).sum(-1) / self.r**2, 0.0, None)
        total = weight.sum()
        return float((weight * self.opacity[self.now[box]]).sum() / total) if total > 0.0 else 0.0

    def rate(self, force, at):
        b, opacity = self.burr, self.mean_opacity(at)
        if opacity == 0.0:
            return b["rate_per_s"]
        share = (force / opacity - b["threshold_N"]) / (b["full_N"] - b["threshold_N"])
        return b["rate_per_s"] * min(max(share, 0.0), 1.0)

    def wear(self, start, end, dose):
        box, where = self.near(start, end)
        if box is None:
            return
        self.lost[box] = np.minimum(1.0, self.lost[box] + dose * swept(where - start, end - start, self.r))
        drop = np.maximum(self.whole[box] - self.empty, 0)
        self.now[box] = self.whole[box] - np.rint(self.lost[box] * drop).astype(np.int64)

    def drill(self, rows):
        last = None
        for t, px, py, pz, qw, qx, qy, qz, ux, uy, fx, fy, fz, pressed, stale in rows:
            if stale:
                last = None
                continue
            q = (qw, qx, qy, qz)
            ahead = self.length - self.burr["nose_m"]
            at = self.place(np.array([px, py, pz]) + turned(q, np.array([ux, uy, ahead])))
            if last is not None and pressed:
                dt = t - last[0]
                if 0.0 < dt <= LONGEST_S and np.linalg.norm(at - last[1]) <= FARTHEST_M:
                    rate = self.rate((fx * fx + fy * fy + fz * fz) ** 0.5, at)
                    if rate > 0.0:
                        self.wear(last[1], at, rate * dt)
            last = (t, at)

    def answer(self):
        seen = (self.whole > self.empty) & (self.opacity[self.whole] > 0.0)
        drop = (self.whole - self.empty)[seen]
        off = (self.now - self.theirs)[seen] / drop
        touched = (self.lost[seen] > 0.0) | (self.theirs != self.whole)[seen]
        return {"removed_m3": float(self.lost[seen].sum() * self.spacing.prod()), "touched": int(touched.sum()),
                "share_rms": float(np.sqrt(np.mean(off[touched] ** 2))), "share_worst": float(np.abs(off).max())}


def main(folder):
    bone = Bone(folder)
    with open(f"{folder}/samples.csv", newline="") as file:
        bone.drill([[float(x) for x in row] for row in csv.reader(file)])
    print(json.dumps(bone.answer()))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
