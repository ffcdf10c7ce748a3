"""Dense boundary integrals, viscosity 1: a vesicle and a solid held in a stream in a box that is periodic both ways, and
a capsule in unbounded fluid by explicit steps."""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.special import exp1


def remainder(d, period, split):
    """What the images add to the free Stokeslet, times 4 pi, (..., 2, 2), for d (..., 2) within half a period: Ewald's
    sums of the flow without mean, split at the wave number `split`, which drops out."""
    one = np.eye(2)
    out = np.zeros((*d.shape[:-1], 2, 2))
    for p in range(-1, 2):
        for q in range(-1, 2):
            r = d + period * np.array([p, q])
            r2 = (r**2).sum(-1)[..., None, None]
            safe = np.where(r2 > 0, r2, 1)
            dyad = r[..., :, None] * r[..., None, :] / safe
            near = np.exp(-(split**2) * safe)
            near = (0.5 * exp1(split**2 * safe) - near) * one + dyad * near
            if p or q:
                out += near
                continue
            limit = (-0.5 * np.euler_gamma - np.log(split) - 1) * one
            out += np.where(r2 > 0, near - (-0.5 * np.log(safe) * one + dyad), limit)
    n = np.arange(-14, 15)
    kx, ky = (2 * np.pi / period * k.ravel() for k in np.meshgrid(n, n))
    kx, ky = kx[n.size**2 // 2 + 1 :], ky[n.size**2 // 2 + 1 :]  # one of each two that are opposite
    k2 = kx**2 + ky**2
    size = 8 * np.pi / period**2 * (1 + k2 / (4 * split**2)) * np.exp(-k2 / (4 * split**2)) / k2**2
    direction = size[:, None, None] * np.moveaxis(np.array([[ky * ky, -kx * ky], [-kx * ky, kx * kx]]), -1, 0)
    return out + np.tensordot(np.cos(d @ np.array([kx, ky])), direction, 1)


def derivative(n):
    """The matrix of d/dk of a trigonometric polynomial through n points, n odd."""
    k = np.subtract.outer(np.arange(n), np.arange(n))
    t = np.pi * np.where(k, k, 1) / n
    return np.where(k, np.pi / n * (-1.0) ** k / np.sin(t), 0)


def finer(X, n):
    """The trigonometric polynomials through the columns of X (m, ...), m odd, at n points, n odd."""
    m = len(X)
    c = np.zeros((n // 2 + 1, X.shape[1]), complex)
    c[: m // 2 + 1] = np.fft.rfft(X, axis=0)
    return np.fft.irfft(c, n, axis=0) * n / m


def kress(n):
    """Weights of ln(4 sin^2(t/2)) on n points, n odd, by index difference, over 2 pi/n."""
    t = 2 * np.pi * np.arange(n) / n
    return -2 * (np.cos(np.outer(t, np.arange(1, n // 2 + 1))) / np.arange(1, n // 2 + 1)).sum(1)


def own_part(curve):
    """(n, n, 2, 2), what Kress' quadrature of a closed curve has besides the free Stokeslet of other points."""
    n = len(curve)
    T, k = derivative(n) @ curve, np.subtract.outer(np.arange(n), np.arange(n)) % n
    sine = np.where(k, 2 * np.sin(np.pi * k / n), 1)
    S = -0.5 * (kress(n)[k] - np.where(k, np.log(sine**2), 0))[..., None, None] * np.eye(2)
    t2 = (T**2).sum(-1)[:, None, None]
    i = np.arange(n)
    S[i, i] += -0.5 * np.log(t2 * (n / (2 * np.pi)) ** 2) * np.eye(2) + T[:, :, None] * T[:, None, :] / t2
    return S


def single_layer(curves, period, times):
    """(2n, 2n) velocities at the points of closed curves, of `times` as many as are given, for the force that each stands
    for, x and y interlaced. What the images add is smooth, and is taken at the given points."""
    given, X = np.concatenate(curves), np.concatenate([finer(curve, times * len(curve)) for curve in curves])
    d = given[:, None] - given
    S = remainder(d - period * np.round(d / period), period, 8 / period)
    smooth = np.zeros((len(X), len(given)))
    at = 0
    for curve in curves:
        n = len(curve)
        smooth[times * at : times * (at + n), at : at + n] = finer(np.eye(n), times * n)
        at += n
    S = np.einsum("ai,ijcd,bj->abcd", smooth, S, smooth, optimize=True)
    d = X[:, None] - X
    d -= period * np.round(d / period)
    r2 = (d**2).sum(-1)[..., None, None]
    plain = np.where(r2 > 0, r2, 1)
    S += -0.5 * np.log(plain) * np.eye(2) + d[..., :, None] * d[..., None, :] / plain
    at = 0
    for curve in curves:
        n = times * len(curve)
        S[at : at + n, at : at + n] += own_part(X[at : at + n])
        at += n
    return S.transpose(0, 2, 1, 3).reshape(2 * len(X), 2 * len(X)) / (4 * np.pi)


def normals(solid):
    """The unit vector (2w,) of a solid's normals, a force that its pressure alone feels."""
    N = (derivative(len(solid)) @ solid @ np.array([[0, -1], [1, 0]])).ravel()
    return N / np.linalg.norm(N)


def driven(solid, velocity, rotation, period, times):
    """Force and torque, about the mean of its points, of the fluid on a solid that moves in fluid without mean flow,
    viscosity 1; solved at `times` as many points as are given, an odd number."""
    S = single_layer([solid], period, times)
    solid = finer(solid, times * len(solid))
    off = solid - solid.mean(0)
    N = normals(solid)
    U = np.add(velocity, rotation * off @ np.array([[0, 1], [-1, 0]])).ravel()
    f = -np.linalg.solve(S + np.outer(N, N) / 4, U).reshape(-1, 2)
    return f.sum(0), (off[:, 0] * f[:, 1] - off[:, 1] * f[:, 0]).sum()


def pressed(vesicle, solid, period, stream, times):
    """A vesicle without bending stiffness, which does not stretch, beside a solid at rest, given by odd numbers of
    points; the mean flow is `stream`, viscosity 1. Solved at `times` as many points. Returns the vesicle's velocity at
    the given points and the force of the fluid on the solid."""
    S = single_layer([vesicle, solid], period, times)
    vesicle, solid = finer(vesicle, times * len(vesicle)), finer(solid, times * len(solid))
    m, w = len(vesicle), len(solid)
    D = derivative(m)
    T = D @ vesicle
    stretch = np.zeros((m, 2 * m))
    stretch[:, 0::2], stretch[:, 1::2] = T[:, :1] * D, T[:, 1:] * D
    N = normals(solid)
    force = np.zeros((2 * (m + w), m + 2 * w))  # of the membrane's tension, and of the solid
    force[: 2 * m, :m] = -stretch.T
    force[2 * m :, m:] = np.eye(2 * w)
    flow = S @ force
    A = np.vstack([stretch @ flow[: 2 * m], flow[2 * m :]])
    A[m:, m:] += np.outer(N, N) / 4
    ambient = np.tile(stream, m + w)
    x = np.linalg.solve(A, -np.concatenate([stretch @ ambient[: 2 * m], ambient[2 * m :]]))
    velocity = (flow @ x + ambient)[: 2 * m].reshape(m, 2)
    return velocity[::times], -x[m:].reshape(w, 2).sum(0)


def capsule(circle, tension, rate, end):
    """A capsule that is a circle without tension at first, (n, 2), n odd, in unbounded shear (rate y, 0), viscosity 1, by
    an explicit Runge-Kutta method up to the time `end`. tension: of the stretch. Returns the points."""
    n = len(circle)
    D = derivative(n)
    rest = np.linalg.norm(D @ circle, axis=1)

    def velocity(t, x):
        X = x.reshape(n, 2)
        T = D @ X
        speed = np.linalg.norm(T, axis=1)
        force = D @ (T * (tension(speed / rest) / speed)[:, None])
        d = X[:, None] - X
        r2 = (d**2).sum(-1)[..., None, None]
        plain = np.where(r2 > 0, r2, 1)
        S = -0.5 * np.log(plain) * np.eye(2) + d[..., :, None] * d[..., None, :] / plain + own_part(X)
        return (np.einsum("ijcd,jd->ic", S, force) / (4 * np.pi) + rate * X[:, 1:] * [1, 0]).ravel()

    return solve_ivp(velocity, (0, end), circle.ravel(), rtol=1e-8, atol=1e-10).y[:, -1].reshape(n, 2)
