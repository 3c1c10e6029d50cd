"""The pinch hold of google-deepmind/mujoco issue 3328, as `softdock lab pinch-hold` builds it, in MuJoCo.

A horizontal capsule (45 g, radius 4 mm) between a fixed pad and one that a constant force presses on along x; friction
0.7, gravity along -z. The slip is the fall of the capsule after the first second. The issue's own figures: 155 um/s
(elliptic, impratio 10), 1,500 to 2,300 um/s (impratio 1), 1.4 um/s (impratio 10, noslip 10); its pads are position servos.
"""
import mujoco

from variants import VARIANTS, build, show

XML = """
<mujoco>
  <option timestep="0.001" integrator="implicitfast" gravity="0 0 -9.81"/>
  <default><geom friction="0.7 0.005 0.0001"/></default>
  <worldbody>
    <body name="left" pos="-0.014 0 0"><geom type="box" size="0.01 0.02 0.02" mass="0.1"/></body>
    <body name="right" pos="0.014 0 0"><joint name="close" type="slide" axis="-1 0 0" damping="50"/>
      <geom type="box" size="0.01 0.02 0.02" mass="0.1"/></body>
    <body name="capsule"><freejoint/><geom type="capsule" size="0.004 0.015" mass="0.045" euler="90 0 0"/></body>
  </worldbody>
  <contact><exclude body1="left" body2="right"/></contact>
  <actuator><motor joint="close"/></actuator>
</mujoco>
"""
STEP_S = 0.001
HOLD_S = 60.0
PAD_HALF_M = 0.02


def hold(grip_n, changes):
    """Mean fall speed after the first second, m/s, and how long it was watched, s: until the capsule leaves the pads."""
    model, data = build(XML, changes)
    data.ctrl[:] = grip_n
    capsule = data.body("capsule")
    start = None
    for step in range(round((1.0 + HOLD_S) / STEP_S)):
        mujoco.mj_step(model, data)
        if step == round(1.0 / STEP_S):
            start = capsule.xpos[2]
        if capsule.xpos[2] < -0.8 * PAD_HALF_M:
            break
    if start is None:
        return float("nan"), data.time
    return (start - capsule.xpos[2]) / (data.time - 1.0), data.time - 1.0


def main():
    rows = []
    for name, changes in VARIANTS.items():
        cells = []
        for grip in (12, 60):
            speed, watched = hold(grip, changes)
            lost = watched <= 0.0 or speed != speed
            cells += ["pressed out in 1 s" if lost else f"{speed * 1e6:.3g}", "-" if lost else f"{watched:.0f}"]
        rows.append([name, *cells])
    header = ["MuJoCo", "slip at 12 N, um/s", "over, s", "slip at 60 N, um/s", "over, s"]
    show("Pinch hold: 45 g capsule, mu 0.7, gravity; mean slip after the first second", header, rows)


if __name__ == "__main__":
    main()
