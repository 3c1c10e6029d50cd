//! What an experiment is and what it answers.

use serde::Serialize;

/// A named experiment.
#[derive(Clone, Copy, Debug)]
pub struct Experiment {
    /// Name on the command line, in words with dashes.
    pub name: &'static str,
    /// The question that it answers, one line.
    pub question: &'static str,
    /// Runs it.
    pub run: fn(&Options) -> Result<Outcome, LabError>,
}

/// How an experiment runs.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Step of the integrator, s; the experiment's own where absent.
    pub step: Option<f64>,
    /// Shorter runs and coarser grids, for a first look; figures that need the whole run are left out.
    pub quick: bool,
    /// Folder of the recordings of real things; the environment's where absent (see [`crate::real`]).
    pub data: Option<std::path::PathBuf>,
    /// Whether parameters are fitted to recordings anew; else the committed ones are judged.
    pub refit: bool,
}

/// A run to look at: its log and what its scene looks like; `None` where there is none.
pub type Recording = Option<(record::Log, record::Scene)>;

/// What an experiment found.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// Figures in the order of the report.
    pub figures: Vec<Figure>,
    /// Charts, drawn one below the other.
    pub charts: Vec<Chart>,
    /// One run to look at: its log and what its scene looks like.
    pub run: Recording,
    /// What a reader should know besides: limits, sources, what was left out; a Markdown table where it begins with `|`.
    pub notes: Vec<String>,
}

/// A measured figure beside what it should be.
#[derive(Clone, Debug, Serialize)]
pub struct Figure {
    /// What it is, with its condition: "creep at 50 % of the limit, 1 h".
    pub name: String,
    /// Measured, in `unit`.
    pub measured: f64,
    /// What theory says, in `unit`; NaN where there is none.
    pub expected: f64,
    /// Unit, "1" for none.
    pub unit: &'static str,
    /// How far it may be off.
    pub allowed: Allowed,
}

/// How far a figure may be from what it should be.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Allowed {
    /// |measured − expected| ≤ x |expected|.
    Relative(f64),
    /// |measured − expected| ≤ x.
    Absolute(f64),
    /// |measured| ≤ x.
    AtMost(f64),
    /// |measured| ≥ x.
    AtLeast(f64),
    /// Printed for the reader; nothing to hold.
    Shown,
}

impl Figure {
    /// A figure that must be within a fraction of what theory says.
    pub fn relative(name: impl Into<String>, measured: f64, expected: f64, unit: &'static str, fraction: f64) -> Self {
        Self { name: name.into(), measured, expected, unit, allowed: Allowed::Relative(fraction) }
    }

    /// A figure that must be within an amount of what theory says.
    pub fn absolute(name: impl Into<String>, measured: f64, expected: f64, unit: &'static str, amount: f64) -> Self {
        Self { name: name.into(), measured, expected, unit, allowed: Allowed::Absolute(amount) }
    }

    /// A figure whose size must not exceed a bound.
    pub fn at_most(name: impl Into<String>, measured: f64, bound: f64, unit: &'static str) -> Self {
        Self { name: name.into(), measured, expected: 0.0, unit, allowed: Allowed::AtMost(bound) }
    }

    /// A figure whose size must reach a bound.
    pub fn at_least(name: impl Into<String>, measured: f64, bound: f64, unit: &'static str) -> Self {
        Self { name: name.into(), measured, expected: f64::NAN, unit, allowed: Allowed::AtLeast(bound) }
    }

    /// A figure that is only shown, beside what theory says (NaN: nothing).
    pub fn shown(name: impl Into<String>, measured: f64, expected: f64, unit: &'static str) -> Self {
        Self { name: name.into(), measured, expected, unit, allowed: Allowed::Shown }
    }

    /// Whether the figure is what it should be; NaN never is, unless it is only shown.
    pub fn holds(&self) -> bool {
        let off = (self.measured - self.expected).abs();
        match self.allowed {
            Allowed::Relative(x) => off <= x * self.expected.abs(),
            Allowed::Absolute(x) => off <= x,
            Allowed::AtMost(x) => self.measured.abs() <= x,
            Allowed::AtLeast(x) => self.measured.abs() >= x,
            Allowed::Shown => true,
        }
    }
}

impl Outcome {
    /// Whether all figures hold.
    pub fn holds(&self) -> bool {
        self.figures.iter().all(Figure::holds)
    }
}

/// Curves over one pair of axes.
#[derive(Clone, Debug, Default)]
pub struct Chart {
    /// What it shows.
    pub title: String,
    /// Quantity and unit across: "time, s".
    pub across: String,
    /// Quantity and unit up.
    pub up: String,
    /// Whether the axes (across, up) are logarithmic.
    pub logarithmic: (bool, bool),
    /// Whether one unit is as long across as up: paths and places.
    pub equal_scales: bool,
    /// The curves.
    pub curves: Vec<Curve>,
}

/// One curve of a chart.
#[derive(Clone, Debug, Default)]
pub struct Curve {
    /// Name in the legend.
    pub name: String,
    /// Points (across, up); NaN breaks the line.
    pub points: Vec<(f64, f64)>,
    /// Drawn as theory (dashed) rather than as a measurement.
    pub is_theory: bool,
    /// Drawn as marks rather than as a line: single measurements.
    pub is_marks: bool,
}

impl Chart {
    /// A chart without curves; `across` and `up` with their units: "time, s".
    pub fn new(title: impl Into<String>, across: impl Into<String>, up: impl Into<String>) -> Self {
        Self { title: title.into(), across: across.into(), up: up.into(), ..Self::default() }
    }

    /// The same with logarithmic axes.
    pub fn logarithmic(self, across: bool, up: bool) -> Self {
        Self { logarithmic: (across, up), ..self }
    }

    /// The same with one measured line more.
    pub fn line(self, name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        self.curve(Curve { name: name.into(), points, ..Curve::default() })
    }

    /// The same with one line of theory more.
    pub fn theory(self, name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        self.curve(Curve { name: name.into(), points, is_theory: true, ..Curve::default() })
    }

    /// The same with single measurements more.
    pub fn marks(self, name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        self.curve(Curve { name: name.into(), points, is_marks: true, ..Curve::default() })
    }

    /// The same with one curve more.
    pub fn curve(mut self, curve: Curve) -> Self {
        self.curves.push(curve);
        self
    }
}

/// Why an experiment could not be run.
#[derive(Debug, thiserror::Error)]
pub enum LabError {
    /// The model is unsound.
    #[error("experiment {experiment}: {source}")]
    Model {
        /// Which one.
        experiment: &'static str,
        /// What is wrong with it.
        source: sim::ModelError,
    },
    /// The run diverged.
    #[error("experiment {experiment}: {source}")]
    Step {
        /// Which one.
        experiment: &'static str,
        /// Where.
        source: sim::StepError,
    },
    /// The recording failed.
    #[error(transparent)]
    Record(#[from] record::RecordError),
    /// A recording of the real thing is missing or unsound.
    #[error(transparent)]
    Real(Box<crate::real::RealError>),
}
