//! The torque-free rigid body in closed form: Jacobi elliptic functions, and the attitude from them.
//!
//! Principal moments I₁ < I₂ < I₃, L² > 2 E I₂ (motion about axis 3; otherwise axes 1 and 3 change roles):
//!
//!   ω₁ = a₁ cn u,  ω₂ = a₂ sn u,  ω₃ = a₃ dn u,      u = n t + u₀
//!   n² = (I₃ − I₂)(L² − 2 E I₁)/(I₁ I₂ I₃),   m = k² = (I₂ − I₁)(2 E I₃ − L²)/((I₃ − I₂)(L² − 2 E I₁))
//!
//! (Landau and Lifshitz, Mechanics, § 37.) The attitude takes l = I ω/L to the fixed direction of L, and turns about it by
//!
//!   φ̇ = L (I₁ ω₁² + I₂ ω₂²)/(I₁² ω₁² + I₂² ω₂²)                              (Euler angles z-x-z about L)
//!
//! an analytic function of time, integrated here by Gauss–Legendre panels to round-off.

use spatial::{Mat3, Vec3};
use std::f64::consts::FRAC_PI_2;

/// sn, cn, dn by the descending Landen transformation (arithmetic–geometric mean; Abramowitz and Stegun 16.4).
pub(crate) fn jacobi(u: f64, m: f64) -> (f64, f64, f64) {
    let (mut a, mut b, mut c) = (vec![1.0_f64], (1.0 - m).sqrt(), vec![m.sqrt()]);
    while *c.last().unwrap() > 1e-16 {
        let last = *a.last().unwrap();
        c.push(0.5 * (last - b));
        a.push(0.5 * (last + b));
        b = (last * b).sqrt();
        if a.len() > 30 {
            break;
        }
    }
    let levels = a.len() - 1;
    let period = 4.0 * FRAC_PI_2 / a[levels];
    let mut phi = f64::from(1 << levels) * a[levels] * (u - period * (u / period).round());
    for i in (1..=levels).rev() {
        phi = 0.5 * (phi + (c[i] * phi.sin() / a[i]).asin());
    }
    let (sn, cn) = phi.sin_cos();
    (sn, cn, (1.0 - m * sn * sn).sqrt())
}

/// One torque-free motion, in principal axes.
pub(crate) struct TorqueFree {
    moments: Vec3,
    amplitude: Vec3,
    rate: f64,
    modulus: f64,
    phase: f64,
    /// Whether axes 1 and 3 changed roles.
    swapped: bool,
}

impl TorqueFree {
    /// Ascending principal moments (kg·m²); the momentum's direction crosses the plane of axes 1 and 3 at `angle` (rad)
    /// from axis 3, at the phase u = 0; `spin` is the angular speed there, rad/s; the motion starts at `phase`.
    pub(crate) fn new(moments: Vec3, angle: f64, spin: f64, phase: f64) -> Self {
        let direction = Vec3::new(angle.sin(), 0.0, angle.cos());
        let omega = direction.component_div(&moments);
        let omega = omega * (spin / omega.norm());
        let (l_sq, e2) = (omega.component_mul(&moments).norm_squared(), omega.dot(&omega.component_mul(&moments)));
        let swapped = l_sq < e2 * moments.y;
        let [i1, i2, i3] = if swapped { [moments.z, moments.y, moments.x] } else { moments.into() };
        let (low, high) = (e2 * i3 - l_sq, l_sq - e2 * i1);
        let amplitude = Vec3::new(
            (low / (i1 * (i3 - i1))).sqrt(),
            (low / (i2 * (i3 - i2))).sqrt(),
            (high / (i3 * (i3 - i1))).sqrt(),
        );
        let rate = ((i3 - i2) * high / (i1 * i2 * i3)).sqrt();
        let modulus = (i2 - i1) * low / ((i3 - i2) * high);
        Self { moments, amplitude, rate, modulus, phase, swapped }
    }

    /// Angle from axis 3 at which the separatrix crosses the plane of axes 1 and 3, rad.
    pub(crate) fn separatrix(i: &Vec3) -> f64 {
        ((1.0 / i.y - 1.0 / i.z) / (1.0 / i.x - 1.0 / i.y)).sqrt().atan()
    }

    /// Angular velocity in principal axes at `t`, rad/s.
    pub(crate) fn omega(&self, t: f64) -> Vec3 {
        let (sn, cn, dn) = jacobi(self.rate * t + self.phase, self.modulus);
        let w = self.amplitude.component_mul(&Vec3::new(cn, sn, dn));
        if self.swapped { w.zyx() } else { w }
    }

    fn momentum(&self, t: f64) -> Vec3 {
        self.omega(t).component_mul(&self.moments)
    }

    /// Rate of the precession angle about L, rad/s; the nutation axis is the one that the motion goes around.
    fn precession(&self, t: f64) -> f64 {
        let (w, l) = (self.omega(t), self.momentum(t));
        let (i, j) = if self.swapped { (1, 2) } else { (0, 1) };
        l.norm() * (l[i] * w[i] + l[j] * w[j]) / (l[i] * l[i] + l[j] * l[j])
    }

    /// Precession angle between two times, rad.
    pub(crate) fn turn(&self, from: f64, to: f64) -> f64 {
        // Five points per panel of about 0.05 in u: exact to h¹⁰.
        const NODES: [(f64, f64); 5] = [
            (0.0, 0.568_888_888_888_888_9),
            (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
            (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
            (0.906_179_845_938_664, 0.236_926_885_056_189_08),
            (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
        ];
        let panels = ((to - from) * self.rate / 0.05).ceil().max(1.0) as usize;
        let half = 0.5 * (to - from) / panels as f64;
        let panel = |p: usize| {
            let mid = from + (2 * p + 1) as f64 * half;
            half * NODES.iter().map(|(x, w)| w * self.precession(mid + half * x)).sum::<f64>()
        };
        (0..panels).map(panel).sum()
    }

    /// Rotation from principal axes to axes whose third is L's direction, at `t`; `turn` is the precession so far.
    pub(crate) fn attitude(&self, t: f64, turn: f64) -> Mat3 {
        let l = self.momentum(t).normalize();
        let axis = if self.swapped { Vec3::x() } else { Vec3::z() };
        // The node line: normal to L and to the nutation axis, in body axes; it turns about L at φ̇.
        let node = l.cross(&axis).normalize();
        let third = l;
        let second = third.cross(&node);
        let (sin, cos) = turn.sin_cos();
        let from_body = Mat3::from_rows(&[node.transpose(), second.transpose(), third.transpose()]);
        Mat3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0) * from_body
    }
}

#[test]
fn jacobi_functions_meet_their_identities_and_limits() {
    // Abramowitz and Stegun table-free checks: m → 0 is circular, m → 1 hyperbolic; derivative sn' = cn dn.
    for u in [-7.3, 0.2, 1.9, 40.0] {
        let (sn, cn, dn) = jacobi(u, 0.0);
        assert!((sn - u.sin()).abs() < 1e-14 && (cn - u.cos()).abs() < 1e-14 && (dn - 1.0).abs() < 1e-15);
        for m in [0.1, 0.5, 0.99] {
            let (sn, cn, dn) = jacobi(u, m);
            assert!((sn * sn + cn * cn - 1.0).abs() < 1e-14 && (dn * dn + m * sn * sn - 1.0).abs() < 1e-14);
            let d = 1e-5;
            let slope = (jacobi(u + d, m).0 - jacobi(u - d, m).0) / (2.0 * d);
            // Central difference: d² plus round-off over d.
            assert!((slope - cn * dn).abs() < 1e-9, "u {u} m {m}");
        }
    }
    let (sn, cn, dn) = jacobi(0.7, 1.0 - 1e-12);
    assert!((sn - 0.7_f64.tanh()).abs() < 1e-11 && (cn - dn).abs() < 1e-11);
}
