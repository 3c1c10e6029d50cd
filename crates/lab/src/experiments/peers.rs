//! What other simulators answer to the pulled block of [`super::slider_line`]: 1 ms, their names of options as they give them.
//!
//! Measured with MuJoCo 4.0.0, Drake 1.51.1, PyBullet 3.2.7 and rapier3d-f64 0.36.1 on the same job, not by this program.

/// One simulator's answer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Peer {
    pub name: &'static str,
    /// Mean speed at half the limit over 8 s, m/s.
    pub creep: f64,
    /// Displacement at 90 % of the break-away time, m.
    pub presliding: f64,
    /// Greatest spring force, N.
    pub peak: f64,
    /// When the speed passes 5 mm/s, s.
    pub onset: f64,
    /// Departures from below 1 mm/s in 30 s.
    pub departures: u32,
}

const fn peer(name: &'static str, creep: f64, presliding: f64, peak: f64, onset: f64, departures: u32) -> Peer {
    Peer { name, creep, presliding, peak, onset, departures }
}

/// The answers, best known settings included.
pub(super) const PEERS: [Peer; 15] = [
    peer("Drake SAP", 1.13e-6, 6.62e-6, 4.024, 4.012, 72),
    peer("Drake lagged (default)", 5.77e-5, 2.20e-4, 4.008, 4.054, 1),
    peer("Drake lagged, v_s 1e-6", 1.31e-6, 5.62e-6, 4.022, 4.029, 42),
    peer("Drake TAMSI", 2.93e-5, 1.00e-4, 4.022, 4.041, 42),
    peer("MuJoCo default", 6.31e-4, 2.45e-3, 3.984, 3.778, 1),
    peer("MuJoCo elliptic", 5.11e-4, 1.58e-3, 4.014, 4.248, 1),
    peer("MuJoCo elliptic, impratio 10", 5.11e-5, 1.71e-4, 4.025, 4.054, 42),
    peer("MuJoCo elliptic, impratio 100", 5.11e-6, 2.55e-5, 4.026, 4.036, 42),
    peer("MuJoCo elliptic, noslip", 6.77e-8, 2.43e-5, 4.025, 4.036, 42),
    peer("MuJoCo elliptic, solref 2 ms, impratio 10", 5.18e-6, 1.67e-5, 4.009, 3.964, 276),
    peer("PyBullet default", -3.06e-6, -3.94e-6, 4.013, 4.026, 1),
    peer("PyBullet 500 iterations", -3.06e-6, -3.94e-6, 4.013, 4.026, 1),
    peer("rapier default", -1.99e-15, -7.15e-7, 4.023, 4.029, 42),
    peer("rapier Coulomb, 4 iterations", -1.99e-15, -4.94e-7, 3.631, 3.636, 43),
    peer("rapier Coulomb, 20 it, no recycling", 3.86e-12, -1.03e-6, 3.631, 3.636, 43),
];
