"""The pinch hold of google-deepmind/mujoco issue 3328, as `softdock lab pinch-hold` builds it, in MuJoCo.

A horizontal capsule (45 g, radius 4 mm) between two pads on slides along x, closed 2 mm past first contact by position
servos whose stiffness gives the grip force; friction 0.7, gravity along -z. The slip is the fall of the capsule from
the end of the first second to the end of the run. The issue's own figures: 155 um/s (elliptic, impratio 10), 1,500 to
2,300 um/s (impratio 1), 1.4 um/s (noslip 10); the servo's gain and the pads' size are not those of the issue, which
does not matter: the creep depends on the load and on the grip force.
"""
import mujoco

from variants import VARIANTS, build, show

XML = """
<mujoco>
  <option timestep="0.001" integrator="implicitfast" gravity="0 0 -9.81"/>
  <default><geom friction="0.7 0.005 0.0001" condim="{condim}"/></default>
  <worldbody>
    <body name="left" pos="-0.014 0 0"><joint name="left" type="slide" axis="1 0 0" damping="{damping}"/>
      <geom type="box" size="0.01 0.02 0.02" mass="0.1"/></body>
    <body name="right" pos="0.014 0 0"><joint name="right" type="slide" axis="-1 0 0" damping="{damping}"/>
      <geom type="box" size="0.01 0.02 0.02" mass="0.1"/></body>
    <body name="capsule"><freejoint/><geom type="capsule" size="0.004 0.015" mass="0.045" euler="90 0 0"/></body>
  </worldbody>
  <contact><exclude body1="left" body2="right"/></contact>
  <actuator><position joint="left" kp="{kp}"/><position joint="right" kp="{kp}"/></actuator>
</mujoco>
"""
CLOSED_M = 0.002
RUN_S = 11.0


def hold(grip_n, changes, condim=3):
    """Slip rate in um/s after the first second, and the grip force in N."""
    kp = grip_n / CLOSED_M
    model, data = build(XML.format(kp=kp, damping=0.2 * (kp * 0.1) ** 0.5 * 10, condim=condim), changes)
    data.ctrl[:] = CLOSED_M
    height = {}
    for step in range(round(RUN_S / 0.001) + 1):
        if step in (1000, round(RUN_S / 0.001)):
            height[step] = data.body("capsule").xpos[2]
        mujoco.mj_step(model, data)
        if data.body("capsule").xpos[2] < -0.02:
            return float("inf"), 0.0
    first, last = height[1000], height[round(RUN_S / 0.001)]
    return (first - last) / (RUN_S - 1.0) * 1e6, -data.actuator_force[0] if data.actuator_force[0] < 0 else data.actuator_force[0]


def main():
    rows = []
    for name, changes in VARIANTS.items():
        cells = []
        for grip in (12, 60):
            slip, force = hold(grip, changes)
            cells += ["out of the pads" if slip == float("inf") else f"{slip:.3g}", f"{force:.1f}"]
        rows.append([name, *cells])
    header = ["variant", "slip at 12 N, um/s", "grip, N", "slip at 60 N, um/s", "grip, N"]
    show("Pinch hold: 45 g capsule, mu 0.7, gravity; slip from 1 s to 11 s", header, rows)


if __name__ == "__main__":
    main()
