//! Contact laws of the file → laws of the world.

use crate::spec::{self, BristleFriction, ContactLaw, FrictionLaw, NormalLaw};
use contact::Normal;
use friction::{Bristle, Friction, LuGre, RegularisedCoulomb};
use sim::PairLaw;

/// Slip speed over which a level falls that does not, m/s.
const NO_FALL: f64 = 1e-3;

pub(super) fn pair_law(law: &ContactLaw) -> PairLaw {
    PairLaw::new(normal_law(&law.normal), friction_law(&law.friction))
}

pub(super) fn pivot_law(law: &spec::Pivot) -> friction::Pivot {
    friction::Pivot {
        spin_lever: law.spin_lever_m,
        rolling_lever: law.rolling_lever_m,
        stiffness: law.stiffness_n_m_per_rad,
        damping: law.damping_n_m_s_per_rad,
    }
}

fn normal_law(law: &NormalLaw) -> Normal {
    match *law {
        NormalLaw::HuntCrossley { stiffness_n_per_m_exp, exponent, dissipation_s_per_m, adhesion_n } => Normal {
            law: contact::NormalLaw::HuntCrossley {
                stiffness: stiffness_n_per_m_exp,
                exponent,
                dissipation: dissipation_s_per_m,
            },
            adhesion: adhesion_n,
        },
        NormalLaw::Linear { stiffness_n_per_m, damping_n_s_per_m, adhesion_n } => Normal {
            law: contact::NormalLaw::SpringDamper { stiffness: stiffness_n_per_m, damping: damping_n_s_per_m },
            adhesion: adhesion_n,
        },
        // The model knows mass and gravity, and fills the force in.
        NormalLaw::DeadWeight {} => Normal::new(contact::NormalLaw::Constant { force: 0.0 }),
    }
}

fn friction_law(law: &FrictionLaw) -> Option<Friction> {
    Some(match *law {
        FrictionLaw::None => return None,
        FrictionLaw::Bristle(law) => bristle(&law).into(),
        FrictionLaw::RegularisedCoulomb(law) => RegularisedCoulomb {
            mu_static: law.mu,
            mu_kinetic: law.mu,
            stribeck_speed: NO_FALL,
            transition_speed: law.transition_velocity_m_per_s,
            viscous: 0.0,
        }
        .into(),
        FrictionLaw::Dahl(law) => LuGre::dahl(law.mu, law.stiffness_n_per_m).into(),
        FrictionLaw::LuGre(law) => LuGre {
            mu_static: law.mu_static.unwrap_or(law.mu),
            stribeck_speed: law.stribeck_velocity_m_per_s.unwrap_or(NO_FALL),
            damping: law.damping_n_s_per_m,
            viscous: law.viscous_n_s_per_m,
            ..LuGre::dahl(law.mu, law.stiffness_n_per_m)
        }
        .into(),
        FrictionLaw::ElastoPlastic(law) => LuGre {
            damping: law.damping_n_s_per_m,
            viscous: law.viscous_n_s_per_m,
            break_away: law.break_away_ratio,
            ..LuGre::dahl(law.mu, law.stiffness_n_per_m)
        }
        .into(),
    })
}

fn bristle(law: &BristleFriction) -> Bristle {
    Bristle {
        mu_static: law.mu_static.unwrap_or(law.mu),
        mu_kinetic: law.mu,
        stribeck_speed: law.stribeck_velocity_m_per_s.unwrap_or(NO_FALL),
        dwell_time: law.dwell_time_s.unwrap_or(0.0),
        across: law.across_ratio,
        stiffness: law.stiffness_n_per_m,
        damping: law.damping_n_s_per_m,
        viscous: law.viscous_n_s_per_m,
        ..Bristle::default()
    }
}
