//! What a mechanism looks like at an instant: for observers, recorders and the energy account.

use crate::model::Model;
use crate::parts::{MechanismMemory, MechanismStatus, Rows, Side};
use spatial::{Twist, Vec3, Wrench};

/// A mechanism at the world's present state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MechanismReport {
    /// Index into [`crate::Model::mechanisms`].
    pub index: usize,
    /// Whether it holds.
    pub status: MechanismStatus,
    /// Time of the last change of status, s.
    pub since: f64,
    /// Where its wrenches act, W, m; where A's frame stands, if it does not act.
    pub point_w: Vec3,
    /// On B about that point, W axes, by the law at this instant; on A its negative.
    pub wrench_w: Wrench,
    /// Coordinates of the deformation: a strut's length (m) first and alone; else rotation vector (rad) and offset (m).
    pub deformation: [f64; 6],
    /// Their rates.
    pub rates: [f64; 6],
    /// Tension of a strut, N; zero for other kinds.
    pub tension: f64,
    /// Elastic energy, J.
    pub stored: f64,
}

/// Evaluates the law of mechanism `index` where its sides stand.
pub(crate) fn calc_report(
    model: &Model,
    index: usize,
    sides: &[Side; 2],
    memory: &MechanismMemory,
    time: f64,
) -> MechanismReport {
    let kind = &model.mechanisms[index].kind;
    let mut report = MechanismReport {
        index,
        status: memory.status,
        since: memory.since,
        point_w: sides[0].frame.pos,
        wrench_w: Wrench::default(),
        deformation: Rows::default(),
        rates: Rows::default(),
        tension: 0.0,
        stored: 0.0,
    };
    let Some(at) = kind.calc_deformation(sides, memory, time) else { return report };
    let about_point = |side: &Side| side.twist.about(&(at.point - side.frame.pos));
    let u: Twist = about_point(&sides[1]) - about_point(&sides[0]);
    (report.point_w, report.deformation) = (at.point, at.e);
    for i in 0..at.n {
        report.rates[i] = u.dot(&at.rows[i]) + at.rest_rate[i];
        let law = kind.eval(i, at.e[i], report.rates[i]);
        report.wrench_w += at.rows[i] * law.force;
        report.stored += law.stored;
        if at.n == 1 {
            report.tension = -law.force;
        }
    }
    report
}
