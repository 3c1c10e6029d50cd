//! The 3-D extended bristle friction law, standalone.
//!
//! A contact point's friction is a brush that touches the common tangent plane; its state is one effective bristle, a
//! spring that stretches and turns within that plane (Liang, Fillmore and Ma 2012, section 2, after Haessig and
//! Friedland 1991). One law gives the force in sticking and in sliding:
//!
//!   s⁺ = s + displacement of B's material point relative to A's, in the plane      trial deflection, m
//!   s' = s⁺            where |s⁺| ≤ s_max = μ fₙ / k                                sticks
//!   s' = s_max s⁺/|s⁺| elsewhere                                                   slides: dragged along
//!   f  = −(k s' + c (s' − s)/τ), shortened to μ fₙ, − b u                           on B, N
//!
//! with τ the time between s and s'. The level μ may fall with the slip speed (Stribeck) or at breakaway, return with the time
//! at rest ([`Levels`]), and differ across a grain (an ellipse in place of the circle |s| ≤ s_max, to which s⁺ is
//! shortened along itself, so that steady sliding is opposed by the level of its direction).
//! A falling normal force shrinks the bound, and the bristle with it; what it stored beyond is lost, never given back.
//! As bodies and plane turn, [`carry`] and [`mean_of`] bring s into the new plane at its length. [`Pivot`] is the lumped
//! resistance of a single point to spinning and rolling. [`RegularisedCoulomb`] and [`LuGre`] (with Dahl and elasto-plastic)
//! answer the same questions through the same interface, [`Friction`], for comparison.
//!
//! Sign: `f` acts on B, `s` and `u` are B's motion relative to A. All vectors lie in the tangent plane, in any axes.
//! The law is pure: it returns a force *and* what becomes of the bristle; only an accepted step commits it.
//!
//! # Embedding it: a block that is pulled over a plane
//!
//! ```
//! use friction::{Bristle, Trial};
//! use nalgebra::Vector3;
//! let law = Bristle { mu_static: 0.4, mu_kinetic: 0.4, stiffness: 1e5, damping: 100.0, ..Bristle::default() };
//! let (mass, h, pull, mut x, mut v, mut s) = (1.0, 1e-4, 1.5, 0.0, 0.0, Vector3::zeros());
//! for _ in 0..10_000 {
//!     let slip = Vector3::new(v, 0.0, 0.0);
//!     let brush = law.eval(&Trial { s, s_trial: s + h * slip, slip, elapsed: h, normal_force: 9.81 * mass, ..Trial::default() });
//!     v += h * (pull + brush.force.x) / mass;
//!     (x, s) = (x + h * v, brush.s);
//! }
//! assert!((x - pull / law.stiffness).abs() < 1e-9); // below 0.4 · 9.81 N: it springs, and it does not creep
//! ```

mod bristle;
mod coulomb;
mod ellipse;
mod flow;
mod law;
mod levels;
mod lugre;
mod pivot;
mod transport;
mod trial;

pub use bristle::Bristle;
pub use coulomb::RegularisedCoulomb;
pub use flow::SlipPath;
pub use law::Friction;
pub use levels::Levels;
pub use lugre::LuGre;
pub use pivot::{Pivot, PivotMoment, Turn};
pub use transport::{carry, mean_of};
pub use trial::{Brush, BrushRate, FrictionError, Slope, Trial};
