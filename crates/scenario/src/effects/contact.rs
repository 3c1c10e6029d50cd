//! What definitions of contact effects share: the law that an entry may edit, and why it may not.

use contact::NormalLaw;
use friction::{Bristle, Friction};
use sim::PairLaw;

/// Bounds of a friction level that is fitted.
pub(super) const LEVELS: [f64; 2] = [1e-3, 5.0];

pub(super) const DEAD_WEIGHT: &str =
    "meets a contact that is pressed by a constant force and has no such number; leave it out";

pub(super) const TWO_LEVELS: &str =
    "meets a contact whose level changes already: it can fall with speed or grow at rest, not both";

/// The bristle law of a pair.
pub(super) fn bristle(law: &mut PairLaw) -> Result<&mut Bristle, String> {
    match &mut law.friction {
        Some(Friction::Bristle(law)) => Ok(law),
        _ => Err("needs bristle friction; give the contact friction = { law = \"bristle\", … }".to_owned()),
    }
}

/// The stiffness of a normal law, and its exponent where one is given.
pub(super) fn set_stiffness(law: &mut NormalLaw, k: f64, n: Option<f64>) -> Result<(), String> {
    match law {
        NormalLaw::HuntCrossley { stiffness, exponent, .. } => {
            *stiffness = k;
            *exponent = n.unwrap_or(*exponent);
        }
        NormalLaw::SpringDamper { stiffness, .. } => {
            if n.is_some_and(|n| n != 1.0) {
                return Err("gives an exponent to a linear law; give the contact a hunt-crossley law".to_owned());
            }
            *stiffness = k;
        }
        NormalLaw::Constant { .. } => return Err(DEAD_WEIGHT.to_owned()),
    }
    Ok(())
}
