"""The palpation law, slow and plain: an oracle for Tractus, written from the equations and sharing no code with it.

Source: Zoller et al., Int. J. CARS 15 (2020), equations (1) to (4), and the project's page "The palpation law, made
precise", which fixes what the paper leaves open. SI throughout. Frames: V is the volume's (LPS), H the handle's.

What is numerically different from the product: double precision throughout; the field as three stored arrays of
vectors; Jacobians by finite differences; the equilibrium by pseudo-transient continuation; splines by a dense solve.
"""
import numpy as np

TAPS = np.arange(-7, 8)
KERNEL = np.exp(-TAPS**2 / 2.0)
KERNEL /= KERNEL.sum()


def blurred(alpha):
    """15 taps per axis, sigma one voxel; edge voxels repeat outward."""
    for axis in range(3):
        pad = [(7, 7) if a == axis else (0, 0) for a in range(3)]
        wide = np.pad(alpha, pad, mode="edge")
        n = alpha.shape[axis]
        alpha = sum(w * np.take(wide, range(k, k + n), axis=axis) for k, w in enumerate(KERNEL))
    return alpha


def catmull_rom(f):
    """Weights of the points -1, 0, 1, 2 at 0 <= f < 1, shape (..., 4)."""
    return 0.5 * np.stack([-f + 2 * f**2 - f**3, 2 - 5 * f**2 + 3 * f**3, f + 4 * f**2 - 3 * f**3, -f**2 + f**3], -1)


def catmull_rom_slope(f):
    return 0.5 * np.stack([-1 + 4 * f - 3 * f**2, -10 * f + 9 * f**2, 1 + 8 * f - 9 * f**2, -2 * f + 3 * f**2], -1)


class Field:
    """g = -grad(omega * alpha), equation (1). values: CT values indexed [i, j, k]; directions: columns are the voxel
    axes in V. kind "paper": central differences at the voxels, each component interpolated by Catmull-Rom; "potential":
    the gradient of the Catmull-Rom interpolant of omega * alpha. Beyond the volume omega * alpha goes on as at its edge.
    """

    def __init__(self, values, spacing, origin, directions, transfer, kind="paper"):
        self.spacing, self.origin, self.directions = map(np.asarray, (spacing, origin, directions))
        at, opacity = zip(*transfer)
        b = blurred(np.interp(values, at, opacity))
        self.kind = kind
        # One voxel more on each side: further out nothing changes any more along that axis.
        wide = np.pad(b, 2, mode="edge")
        self.scalar = wide[1:-1, 1:-1, 1:-1]
        middle = slice(1, -1)
        slopes = []
        for axis in range(3):
            ahead = tuple(slice(2, None) if a == axis else middle for a in range(3))
            behind = tuple(slice(0, -2) if a == axis else middle for a in range(3))
            slopes.append((wide[ahead] - wide[behind]) / (2 * self.spacing[axis]))
        self.vectors = -np.stack(slopes, -1)  # along the voxel axes

    def g(self, p):
        """At points p (..., 3) of V, 1/m, in V."""
        u = (p.reshape(-1, 3) - self.origin) @ self.directions / self.spacing + 1.0  # +1: the padding
        cell = np.floor(u).astype(int)
        f = u - cell
        i, j, k = (np.clip(cell[:, a, None] + np.arange(-1, 3), 0, self.scalar.shape[a] - 1) for a in range(3))
        _, nj, nk = self.scalar.shape
        at = ((i[:, :, None, None] * nj + j[:, None, :, None]) * nk + k[:, None, None, :]).reshape(len(u), 64)
        w = [catmull_rom(f[:, a]) for a in range(3)]
        if self.kind == "paper":
            local = np.einsum("nk,nkc->nc", products(*w), self.vectors.reshape(-1, 3)[at])
        else:
            values = self.scalar.reshape(-1)[at]
            slopes = [products(*[catmull_rom_slope(f[:, b]) if b == a else w[b] for b in range(3)]) for a in range(3)]
            local = -np.stack([(s * values).sum(1) for s in slopes], -1) / self.spacing
        return (local @ self.directions.T).reshape(p.shape)


def products(x, y, z):
    """The 64 weights of each point from its four along each axis."""
    return (x[:, :, None, None] * y[:, None, :, None] * z[:, None, None, :]).reshape(len(x), 64)


class Probe:
    """Numbers of the model file's /base, by the same names."""

    def __init__(self, force_factor_Nm=0.005, force_scale=0.3, torque_scale=0.3, points=3, point_spacing_m=0.009,
                 youngs_modulus_Pa=1.95e11, length_m=0.13, radius_m=0.0007):
        L = length_m
        self.c_f, self.s_f, self.s_t = force_factor_Nm, force_scale, torque_scale
        self.k = 3 * youngs_modulus_Pa * (np.pi / 4 * radius_m**4) / L**3
        self.z = L - point_spacing_m * np.arange(points)
        self.phi = self.z**2 * (3 * L - self.z) / (2 * L**3)  # equation (4), 1 at the tip

    def forces(self, field, p, R, delta):
        """Points (N, n, 3) and c_f g there, equation (2), both in H."""
        p_H = np.concatenate([self.phi[:, None] * delta[:, None, :],
                              np.broadcast_to(self.z[:, None], (len(delta), len(self.z), 1))], -1)
        p_V = p[:, None, :] + np.einsum("nab,nib->nia", R, p_H)
        return p_H, self.c_f * np.einsum("nba,nib->nia", R, field.g(p_V))

    def residual(self, field, p, R, delta):
        """k delta - sum phi F, N: zero at rest."""
        _, F = self.forces(field, p, R, delta)
        return self.k * delta - np.einsum("i,nia->na", self.phi, F[..., :2])

    def jacobian(self, field, p, R, delta, h=2e-8):
        """By central differences over 2h, N/m."""
        moves = h * np.array([[1, 0], [-1, 0], [0, 1], [0, -1]])
        many = (delta + moves[:, None, :]).reshape(-1, 2)
        r = self.residual(field, np.tile(p, (4, 1)), np.tile(R, (4, 1, 1)), many).reshape(4, -1, 2)
        return np.stack([r[0] - r[1], r[2] - r[3]], -1) / (2 * h)

    def wrench(self, field, p, R, delta):
        """Force and torque on the handle, equation (3), in H, (N, 6)."""
        p_H, F = self.forces(field, p, R, delta)
        return np.concatenate([self.s_f * F.sum(1), self.s_t * np.cross(p_H, F).sum(1)], -1)

    def rest(self, field, p, R, start, step_m=1e-4, tolerance_N=1e-10, rounds=60):
        """delta at rest, near `start`, for N poses at once: the overdamped shank's motion delta' = -r, by implicit
        steps that lengthen as it comes to rest (pseudo-transient continuation). Returns delta and |r|.

        The pseudo-time of the first step moves a shank under 1 N by `step_m`."""
        delta, inverse_time = start.copy(), np.full(len(start), 1.0 / step_m)
        tolerance_N = np.broadcast_to(tolerance_N, len(start))
        r = self.residual(field, p, R, delta)
        norm = np.linalg.norm(r, axis=-1)
        open_ = np.flatnonzero(norm > tolerance_N)
        for _ in range(rounds):
            if len(open_) == 0:
                break
            at = (field, p[open_], R[open_])
            J = self.jacobian(*at, delta[open_])
            step = np.linalg.solve(J + inverse_time[open_, None, None] * np.eye(2), -r[open_, :, None])[..., 0]
            length = np.linalg.norm(step, axis=-1, keepdims=True)
            step *= np.minimum(1.0, 1e-4 / np.maximum(length, 1e-300))  # never over 0.1 mm at once
            new = self.residual(*at, delta[open_] + step)
            new_norm = np.linalg.norm(new, axis=-1)
            good = new_norm < 2.0 * norm[open_]
            inverse_time[open_] *= np.where(new_norm < norm[open_], 0.1, np.where(good, 1.0, 8.0))
            taken = open_[good]
            delta[taken] += step[good]
            r[taken], norm[taken] = new[good], new_norm[good]
            open_ = open_[norm[open_] > tolerance_N[open_]]
        return delta, norm


def natural_spline(t, y, at):
    """Natural cubic splines through the rows of y (n, c), by a dense solve for the second derivatives."""
    n, h = len(t), np.diff(t)
    A, b = np.eye(n), np.zeros((n, y.shape[1]))
    for k in range(1, n - 1):
        A[k, k - 1:k + 2] = h[k - 1], 2 * (h[k - 1] + h[k]), h[k]
        b[k] = 6 * ((y[k + 1] - y[k]) / h[k] - (y[k] - y[k - 1]) / h[k - 1])
    m = np.linalg.solve(A, b)
    k = np.clip(np.searchsorted(t, at, side="right") - 1, 0, n - 2)
    s, H = (at - t[k])[:, None], h[k][:, None]
    slope = (y[k + 1] - y[k]) / H - H * (2 * m[k] + m[k + 1]) / 6
    return y[k] + s * (slope + s * (m[k] / 2 + s * (m[k + 1] - m[k]) / (6 * H)))


def matrices(q):
    """Rotation matrices of unit quaternions (..., 4), w x y z."""
    w, x, y, z = np.moveaxis(q, -1, 0)
    return np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
                     2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                     2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], -1).reshape(*q.shape[:-1], 3, 3)


def motion(t, p, q, rate_Hz=4000.0):
    """Poses at 4 kHz: every recorded time and equal steps of at most 1 / rate_Hz between. Returns positions, rotation
    matrices and which of the steps are recorded times."""
    q = q / np.linalg.norm(q, axis=1, keepdims=True)
    for k in range(1, len(q)):
        if q[k] @ q[k - 1] < 0:
            q[k] = -q[k]
    times, recorded = [t[0]], [0]
    for a, b in zip(t, t[1:]):
        n = max(1, int(np.ceil((b - a) * rate_Hz - 1e-3)))
        times += [a + (b - a) * s / n for s in range(1, n)] + [b]
        recorded.append(len(times) - 1)
    y = np.hstack([p, q])
    dense = y if len(times) == len(t) else natural_spline(t, y, np.array(times))
    Q = dense[:, 3:] / np.linalg.norm(dense[:, 3:], axis=1, keepdims=True)
    return dense[:, :3], matrices(Q), np.array(recorded)
