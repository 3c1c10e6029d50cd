//! A peg in a bore, in the plane: where it touches twice, and which push jams it.
//!
//! The peg (half-width r) leans by θ in a bore of half-width R > r; its tip's left corner touches the left wall and the
//! bore's right mouth edge touches its right flank, a depth l below and at the mouth:
//!
//!   (2R − r cos θ) cos θ − l sin θ = r
//!
//! A force (Fₓ, −P) that acts at an offset e across the peg holds two contact forces, each in its friction cone. On the
//! verge of sliding in, both frictions point up the walls at μ N; balance of forces gives N₁ and N₂, balance of moments the
//! offset e* beyond which the peg jams. For θ → 0 and a pure push that is
//!
//!   e* = l/(2 μ) = λ r,   λ = l/(2 r μ)                                   (Simunovic 1975; Whitney 1982)
//!
//! and with a lateral force it is an edge of Whitney's parallelogram, moments about the tip: M/(r P) = λ + μ (1 + λ) Fₓ/P.
//! λ < 1, where each contact point lies in the friction cone of the other, is where a peg can wedge: it keeps an inner force
//! when the push is gone.

/// A peg in two-point contact.
#[derive(Clone, Copy, Debug)]
pub struct Peg {
    /// Half the peg's width, m.
    pub half_width: f64,
    /// Half the bore's width, m.
    pub bore_half_width: f64,
    /// Depth of the tip's centre below the mouth, m.
    pub depth: f64,
    /// Coefficient of friction.
    pub mu: f64,
}

/// A vector of the plane: (x across, z up).
type Planar = [f64; 2];

impl Peg {
    /// λ = l/(2 r μ).
    pub fn calc_lambda(&self) -> f64 {
        self.depth / (2.0 * self.half_width * self.mu)
    }

    /// Lean of the peg in two-point contact, rad; positive: its upper end to the right.
    pub fn calc_tilt(&self) -> f64 {
        let (r, bore, l) = (self.half_width, 2.0 * self.bore_half_width, self.depth);
        let off = |tilt: f64| (bore - r * tilt.cos()) * tilt.cos() - l * tilt.sin() - r;
        let (mut low, mut high) = (0.0, 0.5);
        for _ in 0..80 {
            let mid = 0.5 * (low + high);
            if off(mid) > 0.0 { low = mid } else { high = mid }
        }
        0.5 * (low + high)
    }

    /// Centre of the tip, m, the middle of the mouth at the origin.
    pub fn calc_tip(&self) -> Planar {
        [self.half_width * self.calc_tilt().cos() - self.bore_half_width, -self.depth]
    }

    /// Offset e* at which a peg under the push (`lateral`, −1) N is about to slide in, m: measured across the peg from its
    /// axis, at the distance `height` up the axis from the tip. Beyond it the peg jams.
    pub fn calc_jamming_offset(&self, lateral: f64, height: f64) -> f64 {
        let (sin, cos) = self.calc_tilt().sin_cos();
        let tip = self.calc_tip();
        let corner = [tip[0] - self.half_width * cos, tip[1] + self.half_width * sin];
        let mouth = [self.bore_half_width, 0.0];
        // Directions of the total contact forces, normal plus friction up the wall and up the peg.
        let at_corner = [1.0, self.mu];
        let at_mouth = [self.mu * sin - cos, sin + self.mu * cos];
        let (n1, n2) = solve(at_corner, at_mouth, [-lateral, 1.0]);
        let held = n1 * moment(corner, at_corner) + n2 * moment(mouth, at_mouth);
        let on_axis = [tip[0] + height * sin, tip[1] + height * cos];
        // The push at `on_axis` + e (cos, −sin) has to undo it.
        let (of_axis, per_offset) = (moment(on_axis, [lateral, -1.0]), moment([cos, -sin], [lateral, -1.0]));
        -(held + of_axis) / per_offset
    }
}

/// Moment x F_z − z Fₓ of a force.
fn moment(at: Planar, force: Planar) -> f64 {
    at[0] * force[1] - at[1] * force[0]
}

/// Solves a n₁ + b n₂ = c.
fn solve(a: Planar, b: Planar, c: Planar) -> (f64, f64) {
    let det = a[0] * b[1] - a[1] * b[0];
    ((c[0] * b[1] - c[1] * b[0]) / det, (a[0] * c[1] - a[1] * c[0]) / det)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn peg(clearance: f64, depth: f64, mu: f64) -> Peg {
        Peg { half_width: 0.02, bore_half_width: 0.02 + 0.5 * clearance, depth, mu }
    }

    #[test]
    fn without_clearance_the_edge_is_whitneys() {
        for (depth, mu) in [(0.03, 0.2), (0.02, 0.3), (0.05, 0.1)] {
            let peg = peg(1e-9, depth, mu);
            let lambda = peg.calc_lambda();
            for lateral in [-0.5, 0.0, 0.5] {
                let e = peg.calc_jamming_offset(lateral, 0.0);
                let edge = lambda + mu * (1.0 + lambda) * lateral;
                assert!((e / peg.half_width - edge).abs() < 1e-5, "{e} {edge}");
            }
        }
    }

    #[test]
    fn contact_points_lie_on_walls_and_flank() {
        let peg = peg(4e-4, 0.03, 0.3);
        let (sin, cos) = peg.calc_tilt().sin_cos();
        let tip = peg.calc_tip();
        assert!((tip[0] - peg.half_width * cos + peg.bore_half_width).abs() < 1e-15);
        let flank = (peg.bore_half_width - tip[0]) * cos + tip[1] * sin;
        assert!((flank - peg.half_width).abs() < 1e-12);
    }
}
