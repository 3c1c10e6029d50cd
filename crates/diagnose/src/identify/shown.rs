//! Coordinates of a state that show.
//!
//! The attitude of a body that nothing but a gyro follows, or the place of one that only a star tracker does, is told by nothing and moves nothing that is:
//! it is no part of what an estimate carries from interval to interval, where whole turns of it would have to be linear.

use super::track::{Frame, Interval};
use crate::reading::Reading;
use crate::start::Freedom;
use nalgebra::DMatrix;
use scenario::measure::Quantity;

/// Change of what is read by a unit of a coordinate, units of noise, and of another coordinate, below which it is what rounding makes.
const UNREAD: f64 = 1e-2;
const UNMOVED: f64 = 1e-7;

/// Of some coordinates those that show, or that move others which do. `readings`: of any run; `of`: a run and an interval of it.
pub fn shown<'a, R: Iterator<Item = &'a Reading>>(
    frame: &Frame<'_>,
    readings: impl Fn() -> R,
    (run, interval): (usize, &Interval),
) -> Vec<Freedom> {
    let all = frame.freedoms.to_vec();
    let may_be: Vec<bool> = all.iter().map(|f| may_be_hidden(f, readings())).collect();
    let link = may_be.contains(&true).then(|| frame.link(run, interval)).flatten();
    let Some(link) = link else { return all };
    let is_hidden = hidden((&link.s, &link.a), &may_be);
    all.into_iter().zip(is_hidden).filter(|(_, hidden)| !hidden).map(|(f, _)| f).collect()
}

/// Whether it is one of a base of which nothing reads the like, nor anything that comes and goes: a camera, a force.
fn may_be_hidden<'a>(freedom: &Freedom, readings: impl Iterator<Item = &'a Reading>) -> bool {
    let quantity = |r: &Reading| r.quantity;
    match *freedom {
        Freedom::Turn(b, _) => !readings.map(quantity).any(|q| match q {
            Quantity::Orientation(v, _) => v == b,
            of => comes_and_goes(of),
        }),
        Freedom::Place(b, _) | Freedom::Speed(b, _) => !readings.map(quantity).any(|q| match q {
            Quantity::Position(v, _) | Quantity::LinearVelocity(v, _) => v == b,
            of => comes_and_goes(of),
        }),
        Freedom::Spin(..) | Freedom::Joint(_) | Freedom::Rate(_) | Freedom::Memory(_) | Freedom::Bristle(..) => false,
    }
}

fn comes_and_goes(quantity: Quantity) -> bool {
    matches!(
        quantity,
        Quantity::Force(_)
            | Quantity::Torque(_)
            | Quantity::SpecificForce(_)
            | Quantity::SeenPosition(_)
            | Quantity::SeenOrientation(_)
    )
}

/// Which coordinates nothing reads (`s`: ∂r/∂s) and that move (`a`: ∂end/∂s) none but the like, among those that may be so: the largest such set.
fn hidden((s, a): (&DMatrix<f64>, &DMatrix<f64>), may_be: &[bool]) -> Vec<bool> {
    let mut hidden: Vec<bool> = (0..may_be.len()).map(|k| may_be[k] && s.column(k).amax() < UNREAD).collect();
    loop {
        let moves = |k: usize| (0..hidden.len()).any(|j| !hidden[j] && a[(j, k)].abs() > UNMOVED);
        let shows: Vec<usize> = (0..hidden.len()).filter(|k| hidden[*k] && moves(*k)).collect();
        if shows.is_empty() {
            return hidden;
        }
        shows.into_iter().for_each(|k| hidden[k] = false);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_read_by_way_of_another_one_shows() {
        // The first is read, the second moves it, the third moves the fourth, and that nothing.
        let s = DMatrix::from_row_slice(1, 4, &[1.0, 0.0, 0.0, 0.0]);
        let mut a = DMatrix::identity(4, 4);
        (a[(0, 1)], a[(3, 2)]) = (0.1, 0.1);
        assert_eq!(hidden((&s, &a), &[true; 4]), [false, false, true, true]);
        assert_eq!(
            hidden((&s, &a), &[true, true, true, false]),
            [false; 4],
            "what may not be hidden is moved by the third"
        );
    }
}
