//! Forces of one's own: what a user of the library adds to a model without a line here.
//!
//! A [`Force`] acts on links. It is evaluated where forces from outside are: at the start of a step by the Euler schemes, at its middle by the midpoint rule,
//! at every stage by Runge–Kutta; explicitly, so that a stiff one wants a short step. Its impulse stands in the account of impulses and its work in that of
//! works ([`crate::Works::forces`], the balance's `effect_work`), with the twists that displace its links, so that the audits of momentum and energy close
//! over it as over everything else.

use super::effect::BodyMotion;
use spatial::Wrench;

/// A force: a function of time and of how its links move.
pub trait Force: std::fmt::Debug + Send + Sync {
    /// For messages.
    fn name(&self) -> &str;

    /// The links that it acts on, as vehicle and link ([`crate::Model::link`]); the same at every call.
    fn links(&self) -> &[(usize, usize)];

    /// Adds what acts on each link to `wrenches`: about the link's origin, W axes, N·m and N. All three are in the order of [`Self::links`].
    ///
    /// Two links that pull at each other get opposite forces on one line: only then is momentum kept.
    fn act(&self, motions: &[BodyMotion], wrenches: &mut [Wrench]);
}
