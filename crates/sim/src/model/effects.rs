//! The effects of a model, with what is worked out at its build.

use super::Model;
use super::lines::Lines;
use crate::error::ModelError;
use crate::parts::{BodyEffect, BodyPlace, Coordinate, Effect, EffectKind};
use spatial::Vec3;
use std::ops::Range;

/// Effects of a model, with what was worked out at its build.
#[derive(Clone, Debug, Default)]
pub(crate) struct Effects {
    pub list: Vec<Effect>,
    /// First memory of each effect, and the number of all.
    starts: Vec<usize>,
    pub lines: Lines,
    /// Sum of the tilts, W axes, m/s².
    pub tilt: Vec3,
    /// Whether an effect's memory has rates or is advanced by a step.
    pub has_motion: bool,
}

impl Effects {
    /// Numbers the memory, and hands efforts and gears to their coordinates.
    pub fn build(list: Vec<Effect>, model: &mut Model) -> Result<Self, ModelError> {
        let mut starts = vec![0];
        for effect in &list {
            starts.push(starts[starts.len() - 1] + effect.kind.memory_names().len());
        }
        let lines = Lines::new(model.actuators.len());
        let moves = |kind: &EffectKind| matches!(kind, EffectKind::Series(_) | EffectKind::Body(_));
        let has_motion = list.iter().any(|e| moves(&e.kind));
        let mut effects = Self { list, starts, lines, tilt: Vec3::zeros(), has_motion };
        for index in 0..effects.list.len() {
            effects.attach(index, model)?;
        }
        Ok(effects)
    }

    fn attach(&mut self, index: usize, model: &mut Model) -> Result<(), ModelError> {
        let Effect { name, kind } = &self.list[index];
        let refuse = |fault: &str| ModelError::Effect { name: name.clone(), fault: fault.to_owned() };
        match kind {
            EffectKind::Joint(effect) => {
                coordinate_of(model, effect.coordinate).ok_or_else(|| refuse(NO_COORDINATE))?.effects.push(index);
            }
            EffectKind::Series(series) => {
                let coordinate = coordinate_of(model, series.coordinate).ok_or_else(|| refuse(NO_COORDINATE))?;
                if coordinate.series.replace(index).is_some() {
                    return Err(refuse("the joint has a gear already; give it elasticity or backlash, not both"));
                }
                series.find_fault().map_or(Ok(()), |fault| Err(refuse(&fault)))?;
            }
            EffectKind::Line(line) => {
                self.lines.attach(line, self.starts[index], &model.actuators).map_err(|fault| refuse(&fault))?;
            }
            EffectKind::Body(effect) => {
                let place = find_place(model, &self.list, &effect.place);
                let place = place.ok_or_else(|| refuse("names no vehicle or link"))?;
                let law = effect.law;
                law.find_fault(model.step).map_or(Ok(()), |fault| Err(refuse(&fault)))?;
                self.list[index].kind = EffectKind::Body(BodyEffect { place, law });
            }
            EffectKind::Tilt(tilt) => self.tilt += tilt,
        }
        Ok(())
    }

    /// Where the memory of an effect stands in [`crate::State::effects`].
    pub fn memory(&self, index: usize) -> Range<usize> {
        self.starts[index]..self.starts[index + 1]
    }

    /// How many numbers all effects remember.
    pub fn n_memory(&self) -> usize {
        self.starts.last().copied().unwrap_or(0)
    }
}

const NO_COORDINATE: &str = "needs a revolute or prismatic joint that follows no other";

fn coordinate_of(model: &mut Model, coordinate: usize) -> Option<&mut Coordinate> {
    model.coordinates.get_mut(coordinate).filter(|c| c.is_scalar)
}

/// Centre of mass and tensor of the rigid body that an effect's link belongs to, with all parts locked at rest in it;
/// `None` where there is no such link.
pub(crate) fn find_place(model: &Model, effects: &[Effect], place: &BodyPlace) -> Option<BodyPlace> {
    let tree = &model.vehicles.get(place.vehicle)?.tree;
    let link = tree.links.get(place.link)?;
    let mut whole = tree.bodies[link.body].inertia;
    for effect in effects {
        if let EffectKind::Body(other) = &effect.kind
            && other.place.vehicle == place.vehicle
            && let Some(at) = tree.links.get(other.place.link).filter(|l| l.body == link.body)
        {
            whole += other.law.calc_locked().transformed(&at.frame_bl.rot, &at.frame_bl.pos);
        }
    }
    let rot_lb = link.frame_bl.rot.transpose();
    let com = link.frame_bl.inverse_point(&whole.com());
    Some(BodyPlace { com, tensor_com: rot_lb * whole.tensor_com() * rot_lb.transpose(), ..*place })
}
