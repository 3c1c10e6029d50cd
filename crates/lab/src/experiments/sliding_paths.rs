//! Paths of straight pieces and arcs, by their length.

use spatial::{Rot, Vec3};

/// A piece of a path.
#[derive(Clone, Copy, Debug)]
pub(super) enum Piece {
    /// Straight, between two points, m.
    Line {
        /// Start.
        from: Vec3,
        /// End.
        to: Vec3,
    },
    /// About an axis.
    Arc {
        /// Centre, m.
        centre: Vec3,
        /// From the centre to the start, m; across the axis.
        arm: Vec3,
        /// Unit axis.
        axis: Vec3,
        /// Positive about the axis, rad.
        angle: f64,
    },
}

impl Piece {
    fn length(&self) -> f64 {
        match self {
            Self::Line { from, to } => (to - from).norm(),
            Self::Arc { arm, angle, .. } => arm.norm() * angle.abs(),
        }
    }

    /// Place and unit tangent at a length from the start.
    fn at(&self, s: f64) -> (Vec3, Vec3) {
        match self {
            Self::Line { from, to } => {
                let along = (to - from).normalize();
                (from + s * along, along)
            }
            Self::Arc { centre, arm, axis, angle } => {
                let turned = Rot::from_scaled_axis(axis * (s / arm.norm()).copysign(*angle)) * arm;
                (centre + turned, axis.cross(&turned).normalize() * angle.signum())
            }
        }
    }
}

/// Pieces one after the other.
#[derive(Clone, Debug)]
pub(super) struct Path(Vec<Piece>);

impl Path {
    /// Of pieces, each starting where the last one ends.
    pub(super) fn new(pieces: Vec<Piece>) -> Self {
        Self(pieces)
    }

    /// Length, m.
    pub(super) fn length(&self) -> f64 {
        self.0.iter().map(Piece::length).sum()
    }

    /// Place and unit tangent at a length from the start; the end beyond it.
    pub(super) fn at(&self, s: f64) -> (Vec3, Vec3) {
        let mut left = s;
        for piece in &self.0 {
            if left <= piece.length() {
                return piece.at(left);
            }
            left -= piece.length();
        }
        self.0.last().map_or((Vec3::zeros(), Vec3::x()), |p| p.at(p.length()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_goes_on_from_piece_to_piece() {
        let path = Path::new(vec![
            Piece::Line { from: Vec3::zeros(), to: Vec3::x() },
            Piece::Arc { centre: -Vec3::z() + Vec3::x(), arm: Vec3::z(), axis: Vec3::y(), angle: 1.0 },
        ]);
        let (before, after) = (path.at(1.0 - 1e-9), path.at(1.0 + 1e-9));
        assert!((before.0 - after.0).norm() < 1e-8 && (before.1 - after.1).norm() < 1e-8);
        assert!((path.length() - 2.0).abs() < 1e-15);
    }
}
