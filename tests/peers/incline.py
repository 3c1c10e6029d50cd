"""A block of 1 kg (mu 0.4) on a slope: creep below the friction angle of 21.8 deg, acceleration above, as `softdock lab incline`.

Exact: no motion below; g (sin a - mu cos a) above.
"""
import math

import mujoco

from variants import VARIANTS, build, show

XML = """
<mujoco>
  <option timestep="0.001" integrator="implicitfast" gravity="{x} 0 {z}"/>
  <default><geom friction="0.4 0.005 0.0001"/></default>
  <worldbody>
    <geom type="plane" size="0 0 1"/>
    <body name="block" pos="0 0 0.05"><freejoint/><geom type="box" size="0.1 0.1 0.05" mass="1"/></body>
  </worldbody>
</mujoco>
"""


def field(angle_deg):
    angle = math.radians(angle_deg)
    return XML.format(x=9.81 * math.sin(angle), z=-9.81 * math.cos(angle))


def creep(angle_deg, changes):
    """Mean speed from 5 s to 15 s, m/s."""
    model, data = build(field(angle_deg), changes)
    start = 0.0
    for step in range(15_000):
        mujoco.mj_step(model, data)
        if step == 4_999:
            start = data.qpos[0]
    return (data.qpos[0] - start) / 10.0


def acceleration(angle_deg, changes):
    """Gain of speed over the second second, m/s2."""
    model, data = build(field(angle_deg), changes)
    start = 0.0
    for step in range(2_000):
        mujoco.mj_step(model, data)
        if step == 999:
            start = data.qvel[0]
    return data.qvel[0] - start


def main():
    rows = []
    for name, changes in VARIANTS.items():
        creeps = [f"{creep(angle, changes):.2e}" for angle in (10, 18)]
        slides = [f"{acceleration(angle, changes):.4f}" for angle in (24, 30)]
        rows.append([name, *creeps, *slides])
    exact = [9.81 * (math.sin(math.radians(a)) - 0.4 * math.cos(math.radians(a))) for a in (24, 30)]
    rows.append(["exact", "0", "0", *(f"{a:.4f}" for a in exact)])
    header = ["MuJoCo", "creep at 10 deg, m/s", "at 18 deg", "acceleration at 24 deg, m/s2", "at 30 deg"]
    show("Block on a slope, mu 0.4", header, rows)


if __name__ == "__main__":
    main()
