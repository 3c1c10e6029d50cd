//! Units that foreign columns may be written in, and their size in SI.

/// What a unit measures; two dimensions may both fit a joint's channel (turning or sliding).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// m
    Length,
    /// rad
    Angle,
    /// m/s
    Speed,
    /// rad/s
    Rate,
    /// m/s²
    Acceleration,
    /// N
    Force,
    /// N·m
    Torque,
    /// s
    Time,
    /// Pure number, quaternion component, valve state.
    Number,
}

impl Dimension {
    /// The SI unit.
    pub fn si(self) -> &'static str {
        match self {
            Self::Length => "m",
            Self::Angle => "rad",
            Self::Speed => "m/s",
            Self::Rate => "rad/s",
            Self::Acceleration => "m/s²",
            Self::Force => "N",
            Self::Torque => "N·m",
            Self::Time => "s",
            Self::Number => "1",
        }
    }
}

/// A unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// As printed.
    pub name: &'static str,
    /// What it measures.
    pub dimension: Dimension,
    /// How many SI units it is.
    pub in_si: f64,
}

const fn unit(name: &'static str, dimension: Dimension, in_si: f64) -> Unit {
    Unit { name, dimension, in_si }
}

const DEG: f64 = std::f64::consts::PI / 180.0;
const TURN: f64 = std::f64::consts::TAU;

/// Every unit that is known. The pound-force is 0.45359237 kg · 9.80665 m/s² (NIST SP 811), the inch 25.4 mm.
pub const UNITS: &[Unit] = &[
    unit("m", Dimension::Length, 1.0),
    unit("cm", Dimension::Length, 1e-2),
    unit("mm", Dimension::Length, 1e-3),
    unit("um", Dimension::Length, 1e-6),
    unit("nm", Dimension::Length, 1e-9),
    unit("km", Dimension::Length, 1e3),
    unit("in", Dimension::Length, 0.0254),
    unit("ft", Dimension::Length, 0.3048),
    unit("rad", Dimension::Angle, 1.0),
    unit("mrad", Dimension::Angle, 1e-3),
    unit("urad", Dimension::Angle, 1e-6),
    unit("deg", Dimension::Angle, DEG),
    unit("arcmin", Dimension::Angle, DEG / 60.0),
    unit("arcsec", Dimension::Angle, DEG / 3600.0),
    unit("rev", Dimension::Angle, TURN),
    unit("m/s", Dimension::Speed, 1.0),
    unit("cm/s", Dimension::Speed, 1e-2),
    unit("mm/s", Dimension::Speed, 1e-3),
    unit("um/s", Dimension::Speed, 1e-6),
    unit("km/h", Dimension::Speed, 1.0 / 3.6),
    unit("rad/s", Dimension::Rate, 1.0),
    unit("mrad/s", Dimension::Rate, 1e-3),
    unit("deg/s", Dimension::Rate, DEG),
    unit("mdeg/s", Dimension::Rate, 1e-3 * DEG),
    unit("deg/h", Dimension::Rate, DEG / 3600.0),
    unit("rev/s", Dimension::Rate, TURN),
    unit("rpm", Dimension::Rate, TURN / 60.0),
    unit("m/s²", Dimension::Acceleration, 1.0),
    unit("m/s^2", Dimension::Acceleration, 1.0),
    unit("g", Dimension::Acceleration, 9.80665),
    unit("N", Dimension::Force, 1.0),
    unit("mN", Dimension::Force, 1e-3),
    unit("uN", Dimension::Force, 1e-6),
    unit("kN", Dimension::Force, 1e3),
    unit("lbf", Dimension::Force, 4.448_221_615_260_5),
    unit("N·m", Dimension::Torque, 1.0),
    unit("mN·m", Dimension::Torque, 1e-3),
    unit("N·mm", Dimension::Torque, 1e-3),
    unit("N·cm", Dimension::Torque, 1e-2),
    unit("kN·m", Dimension::Torque, 1e3),
    unit("s", Dimension::Time, 1.0),
    unit("ms", Dimension::Time, 1e-3),
    unit("us", Dimension::Time, 1e-6),
    unit("ns", Dimension::Time, 1e-9),
    unit("min", Dimension::Time, 60.0),
    unit("1", Dimension::Number, 1.0),
    unit("%", Dimension::Number, 1e-2),
];

/// A unit by its name; `N m`, `Nm` and `N*m` are `N·m`, `µ` is `u`, `°` is `deg`.
pub fn find(name: &str) -> Option<&'static Unit> {
    let plain = plain(name);
    UNITS.iter().find(|unit| unit.name == plain)
}

fn plain(name: &str) -> String {
    let text = name.trim().replace(['µ', 'μ'], "u").replace('°', "deg").replace([' ', '*'], "·");
    match text.as_str() {
        "Nm" => "N·m".to_owned(),
        "mNm" => "mN·m".to_owned(),
        "kNm" => "kN·m".to_owned(),
        "Nmm" => "N·mm".to_owned(),
        "Ncm" => "N·cm".to_owned(),
        "dps" => "deg/s".to_owned(),
        "degree" | "degrees" => "deg".to_owned(),
        "turn" | "turns" => "rev".to_owned(),
        _ => text,
    }
}

/// The names of all units that measure one of these.
pub fn names_of(dimensions: &[Dimension]) -> Vec<&'static str> {
    UNITS.iter().filter(|unit| dimensions.contains(&unit.dimension)).map(|unit| unit.name).collect()
}
