//! Fitting families of friction laws to the measured loop, all by the same search on the same cycles.
//!
//! Confidence: standard errors from the linearised least squares, with cycles as clusters (Liang and Zeger 1986): samples
//! within a cycle are anything but independent, cycles nearly are. They say how well *these data* tell the parameter under
//! *this law*; they do not say that the law is right.

use super::Search;
use super::fretting::Loop;
use friction::{Bristle, Friction, LuGre, RegularisedCoulomb};
use spatial::nalgebra::{DMatrix, DVector};

/// A family of laws with a few positive parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// A smooth curve over the slip speed.
    Coulomb,
    /// Dahl 1968.
    Dahl,
    /// Canudas de Wit and others 1995.
    LuGre,
    /// Dupont and others 2002.
    ElastoPlastic,
    /// One extended bristle.
    Bristle,
    /// This many extended bristles that share the load.
    Bristles(usize),
}

/// All families that are compared.
pub const FAMILIES: [Family; 7] = [
    Family::Coulomb,
    Family::Dahl,
    Family::LuGre,
    Family::ElastoPlastic,
    Family::Bristle,
    Family::Bristles(3),
    Family::Bristles(8),
];

/// Load at which the bristles of a bundle have their reach, N.
const LOAD: f64 = 5.0;

impl Family {
    /// Name in tables.
    pub fn name(self) -> String {
        match self {
            Self::Coulomb => "Coulomb, regularised".to_owned(),
            Self::Dahl => "Dahl".to_owned(),
            Self::LuGre => "LuGre".to_owned(),
            Self::ElastoPlastic => "elasto-plastic".to_owned(),
            Self::Bristle => "bristle".to_owned(),
            Self::Bristles(n) => format!("{n} bristles"),
        }
    }

    /// Whether it is one of the extended bristle model's.
    pub fn is_bristle(self) -> bool {
        matches!(self, Self::Bristle | Self::Bristles(_))
    }

    /// Names of the parameters, with units.
    pub fn parameters(self) -> &'static [&'static str] {
        match self {
            Self::Coulomb => &["mu", "transition speed, m/s", "viscous, N s/m"],
            Self::Dahl => &["mu", "stiffness, N/m"],
            Self::LuGre => &[
                "mu kinetic",
                "mu static - kinetic",
                "Stribeck speed, m/s",
                "stiffness, N/m",
                "damping, N s/m",
                "viscous, N s/m",
            ],
            Self::ElastoPlastic => &[
                "mu kinetic",
                "mu static - kinetic",
                "Stribeck speed, m/s",
                "stiffness, N/m",
                "damping, N s/m",
                "viscous, N s/m",
                "break-away",
            ],
            Self::Bristle => &[
                "mu kinetic",
                "mu static - kinetic",
                "Stribeck speed, m/s",
                "stiffness, N/m",
                "damping, N s/m",
                "viscous, N s/m",
            ],
            Self::Bristles(_) => &["mu", "first reach, m", "last reach, m", "damping, N s/m", "viscous, N s/m"],
        }
    }

    /// Where the search starts.
    pub fn start(self) -> Vec<f64> {
        match self {
            Self::Coulomb => vec![0.46, 5e-5, 10.0],
            Self::Dahl => vec![0.48, 5e4],
            Self::LuGre | Self::Bristle => vec![0.46, 0.01, 1e-4, 4e4, 10.0, 10.0],
            Self::ElastoPlastic => vec![0.46, 0.01, 1e-4, 4e4, 10.0, 10.0, 0.5],
            Self::Bristles(_) => vec![0.47, 4e-5, 8e-5, 10.0, 10.0],
        }
    }

    /// The bundle of laws at these parameters.
    pub fn build(self, x: &[f64]) -> Vec<Friction> {
        match self {
            Self::Coulomb => vec![Friction::from(RegularisedCoulomb {
                mu_static: x[0],
                mu_kinetic: x[0],
                stribeck_speed: 1e-3,
                transition_speed: x[1],
                viscous: x[2],
            })],
            Self::Dahl => vec![Friction::from(LuGre::dahl(x[0], x[1]))],
            Self::LuGre => vec![Friction::from(lugre(x, 0.0))],
            Self::ElastoPlastic => vec![Friction::from(lugre(x, x[6]))],
            Self::Bristle => vec![Friction::from(Bristle {
                mu_static: x[0] + x[1],
                mu_kinetic: x[0],
                stribeck_speed: x[2],
                stiffness: x[3],
                damping: x[4],
                viscous: x[5],
                ..Bristle::default()
            })],
            Self::Bristles(n) => (0..n).map(|i| Friction::from(one_of(n, i, x))).collect(),
        }
    }

    /// Fits on the first half of the cycles.
    pub fn fit(self, data: &Loop, search: &Search) -> Vec<f64> {
        let start = self.start();
        let at = |z: &[f64]| -> Vec<f64> { start.iter().zip(z).map(|(x, z)| x * z.exp()).collect() };
        let range = data.fitted();
        let found = search.minimise(&vec![0.0; start.len()], |z| {
            let laws = self.build(&at(z));
            if laws.iter().any(|law| law.check().is_err()) {
                return f64::INFINITY;
            }
            data.calc_error(&data.drive(&laws, range.end), range.clone())
        });
        at(&found.x)
    }

    /// Standard errors of the parameters on the fitted cycles.
    pub fn calc_standard_errors(self, data: &Loop, x: &[f64]) -> Vec<f64> {
        let half = data.cycles.len() / 2;
        let range = data.fitted();
        let force = data.drive(&self.build(x), range.end);
        let columns: Vec<Vec<f64>> = (0..x.len()).map(|p| self.calc_column(data, x, p)).collect();
        let rows = DMatrix::from_fn(range.len(), x.len(), |i, p| columns[p][range.start + i]);
        let Some(bread) = (rows.tr_mul(&rows)).pseudo_inverse(1e-30).ok() else { return vec![f64::NAN; x.len()] };
        let mut meat: DMatrix<f64> = DMatrix::zeros(x.len(), x.len());
        for cycle in 0..half {
            let mut score: DVector<f64> = DVector::zeros(x.len());
            for i in data.cycles[cycle]..data.cycles[cycle + 1] {
                for (p, column) in columns.iter().enumerate() {
                    score[p] += column[i] * (data.force[i] - force[i]);
                }
            }
            meat += &score * score.transpose();
        }
        let covariance = &bread * meat * &bread;
        (0..x.len()).map(|p| x[p] * covariance[(p, p)].max(0.0).sqrt()).collect()
    }

    /// ∂f/∂(ln x_p) by a central difference of 0.1 %.
    fn calc_column(self, data: &Loop, x: &[f64], p: usize) -> Vec<f64> {
        let end = data.fitted().end;
        let moved = |factor: f64| {
            let mut x = x.to_vec();
            x[p] *= factor;
            data.drive(&self.build(&x), end)
        };
        moved(1.001).iter().zip(moved(0.999)).map(|(up, down)| (up - down) / 2e-3).collect()
    }
}

fn lugre(x: &[f64], break_away: f64) -> LuGre {
    LuGre {
        mu_static: x[0] + x[1],
        mu_kinetic: x[0],
        stribeck_speed: x[2],
        stiffness: x[3],
        damping: x[4],
        viscous: x[5],
        break_away,
    }
}

/// Bristle `i` of `n`: an equal share of load, damping and viscous term, its own reach.
fn one_of(n: usize, i: usize, x: &[f64]) -> Bristle {
    let share = 1.0 / n as f64;
    let reach = x[1] + (x[2] - x[1]) * (i as f64 + 0.5) * share;
    Bristle {
        mu_static: x[0],
        mu_kinetic: x[0],
        stiffness: x[0] * LOAD * share / reach,
        damping: x[3] * share,
        viscous: x[4] * share,
        ..Bristle::default()
    }
}
