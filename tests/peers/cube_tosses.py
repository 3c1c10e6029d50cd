#!/usr/bin/env python3
"""The real cube tosses in MuJoCo, judged like `softdock lab cube-tosses`.

Recordings: ContactNets (Pfrommer, Halm and Posa 2020), 150 tosses at 148 Hz, as cube_tosses_000_149.csv.
Parameters are fitted on tosses 0-99 and judged on 100-149; errors are means over the samples of a toss, then over tosses:
distance of the centres in % of the cube's width, and the angle between the two attitudes in degrees.

    python cube_tosses.py --data DIR             the committed settings, seconds; prints the table (cube_tosses.md)
    python cube_tosses.py --data DIR --refit     fits them again first (CMA-ES, fixed seeds), half an hour

DIR holds contactnets_cube/. Needs mujoco (4.0 was used) and numpy.

Two treatments of the data, the same as in softdock:
  recorded   first sample's pose and velocities as they stand, 9.81 m/s2, table at z = 0
  corrected  state at the first sample from a least-squares fit to the free flight (parabola; constant angular velocity,
             the cube's moments are equal), gravity of the free flights and table height of the rests of tosses 0-99
"""
import argparse
import os
import sys

import mujoco
import numpy as np

WIDTH, MASS, MOMENT, RATE = 0.1048, 0.37, 8.1e-4, 148.0
SUBSTEPS = 8
FIT, JUDGE = range(0, 100), range(100, 150)
CLEAR = 0.010  # m above z = 0 of the lowest corner: free flight, tracking not yet touched by the impact
AFTER = 7      # samples (47 ms) that count as "just after" the first impact
SCALE = (11.5, 15.2)  # %, deg: weights of position and rotation in the objective

# name, cone, whether corners are balls, treatment; parameters: mu, time constant s, damping ratio, impratio, ball radius m
COMMITTED = [
    ("defaults", "pyramidal", "recorded", [0.15, 0.02, 1.0, 1.0, 0.0]),
    ("elliptic", "elliptic", "recorded", [0.15, 0.02, 1.0, 1.0, 0.0]),
    ("fitted by hand", "elliptic", "recorded", [0.18, 0.004, 1.0, 1.0, 0.0]),
    ("fitted mu, solref", "elliptic", "recorded", [0.1907, 0.0060877, 1.4094, 1.0, 0.0]),
    ("fitted mu, solref", "elliptic", "corrected", [0.1807, 0.0026105, 1.5016, 1.0, 0.0]),
    ("fitted mu, solref, impratio, corner radius", "elliptic", "recorded", [0.1791, 0.0049567, 3.088, 13.537, 0.0072948]),
    ("fitted mu, solref, impratio, corner radius", "elliptic", "corrected", [0.17637, 0.0027754, 1.3882, 8.1122, 0.0066849]),
]
FITS = [
    # name, treatment, which parameters are free (mu, tau, ratio, impratio, radius), start
    ("fitted mu, solref", "recorded", [1, 1, 1, 0, 0], [0.18, 0.004, 1.0, 1.0, 0.0]),
    ("fitted mu, solref", "corrected", [1, 1, 1, 0, 0], [0.18, 0.004, 1.0, 1.0, 0.0]),
    ("fitted mu, solref, impratio, corner radius", "recorded", [1, 1, 1, 1, 1], [0.18, 0.004, 1.0, 1.0, 0.002]),
    ("fitted mu, solref, impratio, corner radius", "corrected", [1, 1, 1, 1, 1], [0.18, 0.004, 1.0, 1.0, 0.002]),
]


def quat_mul(a, b):
    w, x, y, z = a
    return np.array([[w, -x, -y, -z], [x, w, -z, y], [y, z, w, -x], [z, -y, x, w]]) @ b


def quat_exp(v):
    angle = np.linalg.norm(v)
    half = 0.5 * np.sinc(0.5 * angle / np.pi) * v
    return np.array([np.cos(0.5 * angle), *half])


def quat_log(q):
    q = q if q[0] >= 0 else -q
    size = np.linalg.norm(q[1:])
    return 2.0 * q[1:] if size < 1e-12 else 2.0 * np.arctan2(size, q[0]) / size * q[1:]


def conj(q):
    return q * np.array([1, -1, -1, -1])


def rotations(q):
    w, x, y, z = q.T
    return np.stack([np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)], -1),
                     np.stack([2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)], -1),
                     np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], -1)], -2)


class Toss:
    """Positions, attitudes, where the free flight ends, where the first impact is, and both initial states."""

    def __init__(self, rows):
        self.q = rows[:, 2:6] / np.linalg.norm(rows[:, 2:6], axis=1)[:, None]
        self.p = rows[:, 6:9]
        corners = WIDTH / 2 * np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])
        low = (rotations(self.q) @ corners.T)[:, 2].min(1) + self.p[:, 2]
        self.free = int(np.argmax(low < CLEAR))
        self.impact = int(np.argmax(low < 0.0))
        self.recorded = (self.p[0], self.q[0], rows[0, 12:15], rows[0, 9:12])

    def fit_flight(self, gravity):
        """Centre's and attitude's state at t = 0; angular velocity in body axes as MuJoCo takes it."""
        n = self.free
        if n < 4:
            return self.recorded
        t = np.arange(n) / RATE
        a = np.c_[np.ones(n), t]
        target = self.p[:n] + 0.5 * t[:, None] ** 2 * np.array([0, 0, gravity])
        p0, v0 = np.linalg.lstsq(a, target, rcond=None)[0]
        # Gauss-Newton: R(t) = exp(w t) R0 in W axes, residuals as rotation vectors.
        q0, w = self.q[0], rotations(self.q[:1])[0] @ self.recorded[3]
        for _ in range(20):
            r = np.array([quat_log(quat_mul(self.q[k], conj(quat_mul(quat_exp(w * t[k]), q0)))) for k in range(n)])
            d0, dw = np.linalg.lstsq(a, r, rcond=None)[0]
            q0, w = quat_mul(quat_exp(d0), q0), w + dw
        return p0, q0, v0, rotations(q0[None])[0].T @ w


def calc_gravity(tosses):
    """Mean second difference of the height in free flight: second-order fits, weighted by how well they tell it."""
    total = weight = 0.0
    for toss in tosses:
        n = toss.free
        if n >= 6:
            t = np.arange(n) / RATE
            g = -2.0 * np.polyfit(t, toss.p[:n, 2], 2)[0]
            total, weight = total + g * n ** 5, weight + n ** 5
    return total / weight


def calc_table(tosses):
    return float(np.mean([toss.p[-1, 2] for toss in tosses]) - WIDTH / 2)


def model(params, cone, gravity, table):
    mu, tau, ratio, impratio, radius = params
    law = f'friction="{mu} 0 0" solref="{tau} {ratio}" condim="3"'
    at = WIDTH / 2 - radius
    if radius > 0:
        places = [(i, j, k) for i in (-at, at) for j in (-at, at) for k in (-at, at)]
        shape = "".join(f'<geom type="sphere" size="{radius}" pos="{x} {y} {z}" {law}/>' for x, y, z in places)
    else:
        shape = f'<geom type="box" size="{at} {at} {at}" {law}/>'
    return mujoco.MjModel.from_xml_string(f"""<mujoco>
<option timestep="{1 / RATE / SUBSTEPS}" gravity="0 0 {-gravity}" cone="{cone}" impratio="{impratio}"/>
<worldbody><geom type="plane" size="5 5 1" pos="0 0 {table}" {law}/><body><freejoint/>
<inertial pos="0 0 0" mass="{MASS}" diaginertia="{MOMENT} {MOMENT} {MOMENT}"/>{shape}</body></worldbody></mujoco>""")


def simulate(m, d, toss, start):
    mujoco.mj_resetData(m, d)
    d.qpos[:3], d.qpos[3:], d.qvel[:3], d.qvel[3:] = start
    out = np.empty((len(toss.p), 7))
    out[0] = d.qpos
    for k in range(1, len(out)):
        mujoco.mj_step(m, d, SUBSTEPS)
        out[k] = d.qpos
    position = np.linalg.norm(out[:, :3] - toss.p, axis=1) / WIDTH * 100
    rotation = np.degrees(2 * np.arccos(np.clip(np.abs(np.sum(out[:, 3:] * toss.q, axis=1)), 0, 1)))
    return position, rotation


class Bench:
    """Tosses, and what each treatment of the data starts from."""

    def __init__(self, path):
        rows = np.genfromtxt(path, delimiter=",", skip_header=1)
        self.tosses = [Toss(rows[rows[:, 0] == k]) for k in range(150)]
        train = [self.tosses[k] for k in FIT]
        self.gravity, self.table = calc_gravity(train), calc_table(train)
        self.fitted = [toss.fit_flight(self.gravity) for toss in self.tosses]

    def errors(self, params, cone, treatment, which):
        """Rows: mean position %, mean rotation deg over the toss; until just after the first impact; at the end."""
        corrected = treatment == "corrected"
        m = model(params, cone, self.gravity if corrected else 9.81, self.table if corrected else 0.0)
        d = mujoco.MjData(m)
        rows = []
        for k in which:
            toss = self.tosses[k]
            p, r = simulate(m, d, toss, self.fitted[k] if corrected else toss.recorded)
            early = slice(0, toss.impact + AFTER + 1)
            rows.append([p.mean(), r.mean(), p[early].mean(), r[early].mean(), p[-1], r[-1]])
        return np.array(rows)


def fit(bench, treatment, free, start, seed=1, generations=40, population=12):
    """CMA-ES (Hansen and Ostermeier 2001) over the logarithms of the free parameters."""
    free, x0 = np.flatnonzero(free), np.array(start)

    def params(z):
        x = x0.copy()
        x[free] = x0[free] * np.exp(z)
        x[1] = max(x[1], 2.0 / RATE / SUBSTEPS)  # MuJoCo's own bound on the time constant
        return x

    def cost(z):
        x = params(z)
        if x[4] > 0.4 * WIDTH:
            return 1e3
        e = bench.errors(x, "elliptic", treatment, FIT).mean(0)
        return 0.5 * (e[0] / SCALE[0] + e[1] / SCALE[1])

    rng, n = np.random.default_rng(seed), len(free)
    mu = population // 2
    w = np.log(mu + 0.5) - np.log(np.arange(1, mu + 1))
    w /= w.sum()
    mueff = 1 / (w ** 2).sum()
    cc, cs = (4 + mueff / n) / (n + 4 + 2 * mueff / n), (mueff + 2) / (n + mueff + 5)
    c1 = 2 / ((n + 1.3) ** 2 + mueff)
    cmu = min(1 - c1, 2 * (mueff - 2 + 1 / mueff) / ((n + 2) ** 2 + mueff))
    damps, chi = 1 + cs + 2 * max(0, np.sqrt((mueff - 1) / (n + 1)) - 1), np.sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n * n))
    mean, sigma, cov, pc, ps = np.zeros(n), 0.3, np.eye(n), np.zeros(n), np.zeros(n)
    best = (np.inf, mean)
    for g in range(generations):
        values, axes = np.linalg.eigh(cov)
        root = np.sqrt(np.maximum(values, 1e-20))
        ys = [axes @ (root * rng.standard_normal(n)) for _ in range(population)]
        scored = sorted(((cost(mean + sigma * y), i) for i, y in enumerate(ys)))
        if scored[0][0] < best[0]:
            best = (scored[0][0], mean + sigma * ys[scored[0][1]])
        chosen = np.array([ys[i] for _, i in scored[:mu]])
        y = w @ chosen
        mean = mean + sigma * y
        ps = (1 - cs) * ps + np.sqrt(cs * (2 - cs) * mueff) * (axes @ ((axes.T @ y) / root))
        hs = np.linalg.norm(ps) / np.sqrt(1 - (1 - cs) ** (2 * (g + 1))) < (1.4 + 2 / (n + 1)) * chi
        pc = (1 - cc) * pc + hs * np.sqrt(cc * (2 - cc) * mueff) * y
        cov = ((1 - c1 - cmu) * cov + c1 * (np.outer(pc, pc) + (1 - hs) * cc * (2 - cc) * cov)
               + cmu * (chosen.T * w) @ chosen)
        sigma *= np.exp(cs / damps * (np.linalg.norm(ps) / chi - 1))
        print(f"  {g:3d} {best[0]:.4f} {np.round(params(best[1]), 6).tolist()}", file=sys.stderr, flush=True)
    # The centre of the last generation is less lucky than its best member: the better of the two stays.
    final = mean if cost(mean) < best[0] else best[1]
    return [float(f"{x:.5g}") for x in params(final)]


def show(bench, settings):
    print(f"MuJoCo {mujoco.__version__}, step {1e3 / RATE / SUBSTEPS:.3f} ms; gravity of the free flights "
          f"{bench.gravity:.3f} m/s2, table at {1e3 * bench.table:.2f} mm\n")
    print("| settings | data | mu | solref | impratio | corner radius mm | tosses | position % | rotation deg "
          "| until just after impact % | deg | at the end % | deg |")
    print("| --- " * 13 + "|")
    for name, cone, treatment, x in settings:
        for label, which in (("0-99", FIT), ("100-149", JUDGE)):
            e = bench.errors(x, cone, treatment, which).mean(0)
            print(f"| {name} ({cone}) | {treatment} | {x[0]:.3g} | {x[1]:.3g} {x[2]:.3g} | {x[3]:.3g} | {1e3 * x[4]:.3g} "
                  f"| {label} | " + " | ".join(f"{v:.2f}" for v in e) + " |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", default=os.environ.get("SOFTDOCK_RECORDINGS"), help="folder that holds contactnets_cube")
    parser.add_argument("--refit", action="store_true")
    parser.add_argument("--only", type=int, help="with --refit: only this one of the fits, 0 to 3")
    args = parser.parse_args()
    if not args.data:
        parser.error("no recordings: give --data DIR or set SOFTDOCK_RECORDINGS")
    bench = Bench(os.path.join(args.data, "contactnets_cube", "cube_tosses_000_149.csv"))
    settings = list(COMMITTED)
    if args.refit:
        settings = settings[:3]
        for name, treatment, free, start in FITS if args.only is None else [FITS[args.only]]:
            settings.append((name, "elliptic", treatment, fit(bench, treatment, free, start)))
            print(settings[-1], file=sys.stderr)
    show(bench, settings)


if __name__ == "__main__":
    main()
