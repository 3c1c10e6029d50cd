//! A quaternion's four columns as four series: unit, and without flips of sign.
//!
//! q and −q are one rotation, and trackers change from one to the other as they please. The sign that is nearer to the
//! sample before is taken; the first has w ≥ 0. Rounding and sensors leave the norm a little off 1: it is divided out,
//! and said where it is so far off that the columns may not be a quaternion at all.

use super::time::Timeline;

/// Norms that rounding and sloppy conversion explain.
const NORM: f64 = 0.01;
/// Below this the quaternion has no direction.
const ZERO: f64 = 1e-6;

/// A quaternion channel.
#[derive(Clone, Debug, Default)]
pub(super) struct Orientation {
    pub(super) times: Vec<f64>,
    /// w, x, y, z.
    pub(super) parts: [Vec<f64>; 4],
    /// Samples whose sign was turned.
    pub(super) flips: usize,
    /// Samples at the time of the one before, averaged into it.
    pub(super) merged: usize,
    /// Rows that hold some of the four components, or a quaternion of norm 0.
    pub(super) broken: usize,
    /// Samples with a norm far from 1, and the farthest norm.
    pub(super) off: usize,
    pub(super) farthest: f64,
}

/// Reads the four columns together.
pub(super) fn read(timeline: &Timeline, columns: [&[f64]; 4]) -> Orientation {
    let mut read = Orientation { farthest: 1.0, ..Orientation::default() };
    let mut sum = [0.0; 4];
    let mut before = [1.0, 0.0, 0.0, 0.0];
    for (row, t) in &timeline.rows {
        let q = columns.map(|column| column[*row]);
        let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        if !norm.is_finite() || norm < ZERO {
            read.broken += usize::from(q.iter().any(|x| x.is_finite()));
            continue;
        }
        read.judge(norm);
        let turned = q.iter().zip(&before).map(|(a, b)| a * b).sum::<f64>() < 0.0;
        read.flips += usize::from(turned && !read.times.is_empty());
        let unit = q.map(|x| if turned { -x / norm } else { x / norm });
        let again = read.times.last() == Some(t);
        sum = if again { std::array::from_fn(|i| sum[i] + unit[i]) } else { unit };
        before = read.put(*t, sum, again);
    }
    read
}

impl Orientation {
    fn judge(&mut self, norm: f64) {
        if (norm - 1.0).abs() > NORM {
            self.off += 1;
            if (norm - 1.0).abs() > (self.farthest - 1.0).abs() {
                self.farthest = norm;
            }
        }
    }

    /// Writes the mean of what was read at one instant.
    fn put(&mut self, t: f64, sum: [f64; 4], again: bool) -> [f64; 4] {
        let norm = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
        let unit = sum.map(|x| x / norm);
        if again {
            self.merged += 1;
            self.parts.iter_mut().zip(unit).for_each(|(part, x)| {
                part.pop();
                part.push(x);
            });
        } else {
            self.times.push(t);
            self.parts.iter_mut().zip(unit).for_each(|(part, x)| part.push(x));
        }
        unit
    }
}
