//! One `[[effect]]` entry, held against its definition: name, kind of place, parameters and their ranges.

use crate::build::faults::Faults;
use crate::effects::{self, EffectDef, Neutral, Parameter, PlaceKind, Shape};
use crate::spec::{Effect, ParamValue};
use spatial::Vec3;

/// An effect whose name, kind of place and parameters are sound.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entry<'a> {
    /// Index into the file's effects.
    index: usize,
    pub(super) def: &'static EffectDef,
    /// Kind of its place.
    pub(super) kind: PlaceKind,
    /// What stands behind the colon.
    pub(super) place: &'a str,
    spec: &'a Effect,
}

impl<'a> Entry<'a> {
    /// The entry, if it is sound; else its faults are told.
    pub(super) fn check(index: usize, spec: &'a Effect, faults: &mut Faults<'_>) -> Option<Self> {
        let key = |k: &str| format!("effect[{index}].{k}");
        let Some(def) = effects::find(&spec.name) else {
            faults.unknown(&key("name"), "effect", &spec.name, effects::catalogue().map(|e| e.name));
            return None;
        };
        let places = def.places;
        let (kind, place) = spec.place.split_once(':').unwrap_or((&spec.place, ""));
        let Some(kind) = places.iter().copied().find(|p| p.text() == kind) else {
            let valid = places.iter().map(|p| p.text()).collect::<Vec<_>>().join(" or ");
            faults.add(&key("place"), format!("{def} acts at a {valid}, not at \"{}\"", spec.place));
            return None;
        };
        let entry = Self { index, def, kind, place, spec };
        entry.check_parameters(faults).then_some(entry)
    }

    fn check_parameters(&self, faults: &mut Faults<'_>) -> bool {
        let parameters = self.def.parameters;
        let mut sound = true;
        for name in self.spec.params.keys().filter(|k| !parameters.iter().any(|p| p.name == k.as_str())) {
            let valid = parameters.iter().map(|p| p.name);
            faults.unknown(&self.key(name), &format!("parameter of {}", self.def), name, valid);
            sound = false;
        }
        for parameter in parameters {
            let fault = match self.spec.params.get(parameter.name) {
                Some(value) => find_fault(parameter, value),
                None if parameter.is_required => Some(format!("is missing: {} needs it", self.def)),
                None => None,
            };
            if let Some(fault) = fault {
                faults.add(&self.key(parameter.name), fault);
                sound = false;
            }
        }
        sound
    }

    /// Path of a parameter or of "place" in the file.
    pub(crate) fn key(&self, name: &str) -> String {
        format!("effect[{}].{name}", self.index)
    }

    /// Complains about the effect at its place.
    pub(crate) fn fault(&self, faults: &mut Faults<'_>, reason: &str) {
        faults.add(&self.key("place"), format!("{} {reason}", self.def));
    }

    /// Whether it stands at a joint.
    pub(super) fn is_at_joint(&self) -> bool {
        self.kind == PlaceKind::Joint
    }

    /// For messages of the simulation.
    pub(super) fn title(&self) -> String {
        format!("{} at {}", self.def, self.spec.place)
    }

    /// A number; where the file gives none, the neutral value, or zero where there is none.
    pub(crate) fn number(&self, name: &str) -> f64 {
        self.given(name).unwrap_or_else(|| self.neutral(name))
    }

    /// Whether the file says anything of a parameter.
    pub(crate) fn is_given(&self, name: &str) -> bool {
        self.value(name).is_some()
    }

    /// A number, where the file gives it.
    pub(crate) fn given(&self, name: &str) -> Option<f64> {
        self.value(name).and_then(ParamValue::number)
    }

    /// A vector; one number is along no axis and stands for (x, x, x) of nothing: see [`Entry::numbers`].
    pub(crate) fn vector(&self, name: &str) -> Vec3 {
        match self.numbers(name) {
            Some([x, y, z]) => Vec3::new(*x, *y, *z),
            _ => Vec3::repeat(self.neutral(name)),
        }
    }

    /// The numbers that the file gives.
    pub(crate) fn numbers(&self, name: &str) -> Option<&'a [f64]> {
        self.value(name).and_then(ParamValue::numbers)
    }

    /// The word of a choice; its first where the file gives none.
    pub(crate) fn word(&self, name: &str) -> &'a str {
        let default = match self.def.parameter(name).map(|p| p.shape) {
            Some(Shape::Choice([first, ..])) => *first,
            _ => "",
        };
        match self.value(name) {
            Some(ParamValue::Text(word)) => word,
            _ => default,
        }
    }

    /// What the file says of a parameter. A definition that asks for one which it does not have is a bug in it.
    fn value(&self, name: &str) -> Option<&'a ParamValue> {
        debug_assert!(self.def.parameter(name).is_some(), "{} asks for a parameter {name} and has none", self.def);
        self.spec.params.get(name)
    }

    fn neutral(&self, name: &str) -> f64 {
        match self.def.parameter(name).map(|p| p.neutral) {
            Some(Neutral::Value(value)) => value,
            _ => 0.0,
        }
    }
}

/// What is wrong with a parameter's value.
fn find_fault(parameter: &Parameter, value: &ParamValue) -> Option<String> {
    if let Shape::Choice(words) = parameter.shape {
        let found = matches!(value, ParamValue::Text(word) if words.contains(&word.as_str()));
        return (!found).then(|| format!("must be one of \"{}\"", words.join("\", \"")));
    }
    let lengths: &[usize] = match parameter.shape {
        Shape::Number => &[1],
        Shape::Vector => &[3],
        Shape::Tensor => &[6],
        _ => &[1, 3],
    };
    let numbers = value.numbers().unwrap_or(&[]);
    let is_list = matches!(value, ParamValue::Numbers(_));
    if !lengths.contains(&numbers.len()) || (is_list && parameter.shape == Shape::Number) {
        let what = match parameter.shape {
            Shape::Number => "a number",
            Shape::Vector => "three numbers",
            Shape::Tensor => "six numbers: xx, yy, zz, xy, xz, yz",
            _ => "a number or three",
        };
        return Some(format!("must be {what}"));
    }
    numbers.iter().find_map(|x| find_range_fault(parameter, *x))
}

fn find_range_fault(parameter: &Parameter, x: f64) -> Option<String> {
    let ([low, high], is_neutral) = (parameter.range, parameter.neutral == Neutral::Value(x));
    if is_neutral || (x.is_finite() && (low..=high).contains(&x)) {
        return None;
    }
    let demand = match low {
        f64::MIN_POSITIVE => "must be a finite number above zero".to_owned(),
        0.0 => "must be a finite number of at least zero".to_owned(),
        _ => "must be a finite number".to_owned(),
    };
    Some(format!("= {x} {demand}"))
}
