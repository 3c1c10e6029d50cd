"""A block of 1 kg on a floor (mu 0.4): creep at half the friction limit, and pulled by a spring (100 N/m at 0.01 m/s).

Exact for one level of Coulomb friction: no motion below the limit; the pull breaks it away at mu m g/(k v) = 3.924 s; from then on
the block swings about the moving balance, x' = v (1 - cos(w t)) with w = sqrt(k/m): half of v is passed a sixth of a period later,
at 4.029 s, and the spring force peaks at mu m g + sqrt(k m) v = 4.024 N.
"""
import mujoco

from variants import VARIANTS, build, show

XML = """
<mujoco>
  <option timestep="0.001" integrator="implicitfast" gravity="0 0 -9.81"/>
  <default><geom friction="0.4 0.005 0.0001"/></default>
  <worldbody>
    <geom type="plane" size="0 0 1"/>
    <body name="block" pos="0 0 0.05"><freejoint/><geom type="box" size="0.1 0.1 0.05" mass="1"/></body>
  </worldbody>
</mujoco>
"""
STEP_S = 0.001
LIMIT_N = 0.4 * 9.81
SPRING, SPEED = 100.0, 0.01


def settled(changes):
    model, data = build(XML, changes)
    for _ in range(2000):
        mujoco.mj_step(model, data)
    return model, data


def creep(changes):
    """Mean speed under half the limit from 2 s to 10 s, m/s."""
    model, data = settled(changes)
    places = []
    for _ in range(10_000):
        data.qfrc_applied[0] = 0.5 * LIMIT_N
        mujoco.mj_step(model, data)
        places.append(data.qpos[0])
    return (places[-1] - places[2000]) / ((len(places) - 1 - 2000) * STEP_S)


def pull(changes):
    """Motion before break-away (m, at 90 % of its time), break-away (speed passes half the pull's, s), peak force (N)."""
    model, data = settled(changes)
    start, before, broke, peak = data.qpos[0], 0.0, None, 0.0
    for step in range(10_000):
        force = SPRING * (SPEED * step * STEP_S - (data.qpos[0] - start))
        data.qfrc_applied[0] = force
        mujoco.mj_step(model, data)
        peak = max(peak, force)
        if step == round(0.9 * LIMIT_N / (SPRING * SPEED) / STEP_S):
            before = data.qpos[0] - start
        if broke is None and data.qvel[0] > 0.5 * SPEED:
            broke = step * STEP_S
    return before, broke, peak


def main():
    rows = []
    for name, changes in VARIANTS.items():
        before, broke, peak = pull(changes)
        rows.append([name, f"{creep(changes):.2e}", f"{before:.2e}", f"{broke:.3f}", f"{peak:.3f}"])
    rows.append(["exact Coulomb", "0", "0", "4.029", "4.024"])
    header = ["MuJoCo", "creep at 50 %, m/s", "moved before break-away, m", "speed > v/2 at, s", "peak force, N"]
    show("Block of 1 kg, mu 0.4: creep at half the limit; pulled by 100 N/m at 0.01 m/s", header, rows)


if __name__ == "__main__":
    main()
