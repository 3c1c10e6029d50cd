//! Forces from nowhere: what an estimator holds to be missing, beside all laws.
//!
//!   joints   τᵢ   on coordinate i
//!   bases    (M, F)  on the base link, about its origin, link axes
//!
//! They act throughout until they are changed, are no part of any law, and stand in no account of works.

use spatial::Wrench;

/// Forces beside all laws.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Push {
    /// By coordinate, N·m or N; those beyond the end are none.
    pub joints: Vec<f64>,
    /// By vehicle, on its base link about the link's origin, link axes; those beyond the end are none.
    pub bases: Vec<Wrench>,
}
