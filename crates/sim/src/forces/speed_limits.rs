//! Checks of the motors' speed limits at the solution of a step or a stage.

use super::Acting;
use crate::model::Model;
use crate::parts::{Branch, CoordinateForce, CoordinatePoint, FALL};
use crate::state::State;
use crate::workspace::Workspace;

/// Whether a rate is so far below a limit that the line at full effort stands.
fn is_far(limit: f64, point: &CoordinatePoint, rate: f64) -> bool {
    point.branch == Some(Branch::Full) && rate.abs() < (1.0 - FALL) * limit
}

/// Checks the limits at the solution of a scheme that checks no other law; where one was passed, draws a new line.
pub(crate) fn hold_in_step(model: &Model, state: &State, ws: &mut Workspace) -> bool {
    let mut hold = true;
    for &i in &model.speed_limited {
        let (v_new, (effort, slope)) = (state.v[i] + ws.v_gain[i], ws.coordinate_lines[i]);
        if is_far(model.coordinates[i].speed_limit, &ws.coordinate_points[i], v_new) {
            continue;
        }
        let acting = Acting { model, state, step: ws.step, since: None };
        let law = model.coordinates[i].eval(&ws.coordinate_points[i], v_new, &acting);
        if ws.coordinate_points[i].branch != law.branch {
            ws.coordinate_points[i].branch = law.branch;
            hold = false;
        }
        ws.coordinate_forces[i] = CoordinateForce { effort: effort - slope * ws.v_gain[i], ..law };
        ws.coordinate_lines[i] = (law.effort + law.slope * ws.v_gain[i], law.slope);
    }
    hold
}

/// The same at a stage of Runge–Kutta, whose gains are accelerations.
pub(crate) fn hold_at_stage(model: &Model, state: &State, ws: &mut Workspace, v_start: &[f64]) -> bool {
    let mut hold = true;
    for &i in &model.speed_limited {
        let end = v_start[i] + ws.step * ws.v_gain[i];
        if is_far(model.coordinates[i].speed_limit, &ws.coordinate_points[i], end) {
            continue;
        }
        let before = ws.coordinate_points[i].branch;
        let point = CoordinatePoint { end: Some(end), ..ws.coordinate_points[i] };
        let acting = Acting { model, state, step: ws.step, since: ws.since };
        let law = model.coordinates[i].eval(&point, state.v[i], &acting);
        let slope = ws.step * law.fall;
        ws.coordinate_forces[i] = law;
        ws.coordinate_lines[i] = (law.effort + slope * ws.v_gain[i], slope);
        ws.coordinate_points[i] = CoordinatePoint { branch: law.branch, ..point };
        hold &= law.branch == before;
    }
    hold
}
