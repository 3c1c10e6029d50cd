//! The parameters that are judged by default. `softdock lab cube-tosses --refit` and `softdock lab fretting --refit`
//! find them again and print them.

use super::fretting_fit::Family;
use super::toss_fit::Corner;

/// Before fitting: μ of the data's own model file (0.15), the contact law of softdock's example scenario, sharp corners.
pub const BEFORE: Corner = Corner {
    mu: 0.15,
    static_ratio: 1.0,
    stribeck_speed: 0.05,
    stiffness: 2e5,
    exponent: 1.5,
    dissipation: 0.6,
    bristle_stiffness: 1e5,
    bristle_damping: 60.0,
    radius: 0.0,
};

/// Fitted to tosses 0–99 with gravity, table height and starts corrected; of two exponents, 1 and 1.5, the better one there.
pub const CORRECTED: Corner = Corner {
    mu: 0.1757,
    static_ratio: 1.0,
    stribeck_speed: 0.05,
    stiffness: 21_813.0,
    exponent: 1.0,
    dissipation: 4.432,
    bristle_stiffness: 17_080.0,
    bristle_damping: 19.77,
    radius: 4.489e-3,
};

/// Fitted to tosses 0–99 as recorded: first sample, 9.81 m/s², table at zero. The best of four starts *on those tosses*;
/// the first start ended worse there (13.6 % and 22.2° for 13.1 % and 19.0°) and better on the judged ones (11.2 % for 11.9 %).
pub const RECORDED: Corner = Corner {
    mu: 0.1800,
    static_ratio: 1.0,
    stribeck_speed: 0.05,
    stiffness: 12_730.0,
    exponent: 1.0,
    dissipation: 5.944,
    bristle_stiffness: 11_069.0,
    bristle_damping: 38.74,
    radius: 6.716e-3,
};

/// Fitted to the first 25 cycles of the fretting loop, in the order of [`Family::parameters`].
pub fn fretting(family: Family) -> Vec<f64> {
    match family {
        Family::Coulomb => vec![0.2150, 1.266e-8, 7.3e-3],
        Family::Dahl => vec![0.53863, 36_677.0],
        Family::LuGre => vec![0.5234, 0.0508, 2.208e-4, 36_633.0, 4.76, 8.45],
        Family::ElastoPlastic => vec![0.47667, 0.01088, 6.65e-5, 41_001.0, 6.46, 10.65, 0.7059],
        Family::Bristle => vec![0.46755, 0.01445, 1.242e-5, 40_428.0, 0.598, 40.62],
        Family::Bristles(_) => vec![0.47003, 4.6713e-5, 7.012e-5, 13.81, 16.5],
    }
}
