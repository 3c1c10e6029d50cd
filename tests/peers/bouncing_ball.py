"""A ball of 1 kg, radius 0.1 m, that meets a plane at 0.5 m/s without gravity, in MuJoCo: what comes back, how long, how hard.

MuJoCo's contact is a critically damped constraint unless told otherwise: solref (time constant, damping ratio), or in direct form
(-stiffness, -damping) per unit of effective mass. With (-k/m, 0) it is a linear spring; neither Hertz' law nor Hunt and Crossley's
can be said. A linear spring gives e = 1, pi sqrt(m/k) and v sqrt(k m); k is the one whose contact lasts as long as the softer impact
of `softdock lab bouncing-sphere` (24 ms): 17,000 N/m.
"""
import math

import mujoco

from variants import build, show

XML = """
<mujoco>
  <option timestep="{step}" integrator="{integrator}" gravity="0 0 0"/>
  <worldbody>
    <geom type="plane" size="0 0 1" solref="{solref}" solimp="1 1 0.001"/>
    <body name="ball" pos="0 0 0.1"><freejoint/><geom type="sphere" size="0.1" mass="1" solref="{solref}" solimp="{solimp}"/></body>
  </worldbody>
</mujoco>
"""
STIFFNESS = 17_000.0
SPEED = 0.5
PHASES = 8


def impact(step, solref, solimp, integrator):
    """Mean restitution and peak force over phases of touch-down within a step."""
    back, peak = 0.0, 0.0
    for phase in range(PHASES):
        text = XML.format(step=step, solref=solref, solimp=solimp, integrator=integrator)
        model, data = build(text, {})
        data.qpos[2] = 0.1 + SPEED * step * (phase + 0.5) / PHASES
        data.qvel[2] = -SPEED
        highest = 0.0
        for _ in range(round(0.2 / step)):
            before = data.qvel[2]
            mujoco.mj_step(model, data)
            highest = max(highest, (data.qvel[2] - before) / step)
        back += data.qvel[2] / SPEED / PHASES
        peak += highest / PHASES
    return back, peak


def main():
    rows = []
    soft, hard = "0.9 0.95 0.001", "0.9999 0.9999 0.001"
    cases = [
        ("default (solref 0.02 1)", 1e-3, "0.02 1", soft, "implicitfast"),
        ("spring (solref -k/m 0), implicitfast, 1 ms", 1e-3, f"{-STIFFNESS} 0", hard, "implicitfast"),
        ("spring, RK4, 1 ms", 1e-3, f"{-STIFFNESS} 0", hard, "RK4"),
        ("spring, implicitfast, 0.1 ms", 1e-4, f"{-STIFFNESS} 0", hard, "implicitfast"),
    ]
    for name, step, solref, solimp, integrator in cases:
        back, peak = impact(step, solref, solimp, integrator)
        rows.append([name, f"{back:.4f}", f"{peak:.2f}"])
    rows.append(["linear spring, exact", "1.0000", f"{SPEED * math.sqrt(STIFFNESS):.2f}"])
    show("Ball of 1 kg at 0.5 m/s against a plane", ["MuJoCo", "restitution", "peak force, N"], rows)


if __name__ == "__main__":
    main()
