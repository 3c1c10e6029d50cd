//! From `[campaign]` to the inputs of every run.
//!
//! Grids, sweeps and directions are run through in every combination, the first entry slowest; all other entries draw their
//! uniform numbers (`chance`) and turn them by the inverse distribution function. Correlated entries share normal
//! scores z' = L z with L Lᵀ the matrix of correlations (a Gaussian copula; Iman and Conover 1982 for the aim).

use crate::chance::{Ask, SOBOL_DIMENSIONS};
use crate::error::CampaignError;
use crate::table::Input;
use nalgebra::{DMatrix, DVector};
use scenario::Scenario;
use scenario::spec::{Campaign, Disperse, Sampling};
use statrs::distribution::{ContinuousCDF, Normal};
use std::f64::consts::TAU;

/// How the inputs of a campaign are drawn.
#[derive(Clone, Debug)]
pub struct Design {
    seed: u64,
    sampling: Sampling,
    strata: u64,
    entries: Vec<Entry>,
    copula: Option<Copula>,
    /// Combinations of all grids.
    combinations: u64,
    /// The dispersed numbers, in the order of the file.
    pub inputs: Vec<Input>,
}

/// Lower triangle over the correlated entries, and their indices.
type Copula = (DMatrix<f64>, Vec<usize>);

/// One `[[campaign.disperse]]`.
#[derive(Clone, Debug)]
struct Entry {
    name: String,
    key: String,
    kind: Kind,
    /// First of its uniform numbers among the campaign's.
    dimension: usize,
}

#[derive(Clone, Debug)]
enum Kind {
    Normal { mean: f64, sigma: f64, ends: [f64; 2] },
    Uniform { low: f64, high: f64 },
    Choice(Vec<f64>),
    Ball { radius: f64, components: usize },
    Grid(Vec<f64>),
    Directions { radius: f64, count: u32 },
}

impl Kind {
    /// Uniform numbers that it takes.
    fn dimensions(&self) -> usize {
        match self {
            Self::Normal { .. } | Self::Uniform { .. } | Self::Choice(_) => 1,
            Self::Ball { components, .. } => *components,
            Self::Grid(_) | Self::Directions { .. } => 0,
        }
    }

    /// Values that it runs through; one where it draws.
    fn count(&self) -> u64 {
        match self {
            Self::Grid(values) => values.len() as u64,
            Self::Directions { count, .. } => u64::from(*count),
            _ => 1,
        }
    }

    fn is_continuous(&self) -> bool {
        matches!(self, Self::Normal { .. } | Self::Uniform { .. })
    }

    fn words(&self) -> String {
        match self {
            Self::Normal { mean, sigma, ends: [low, high] } if low.is_finite() || high.is_finite() => {
                format!("normal, mean {mean}, σ {sigma}, within {low} … {high}")
            }
            Self::Normal { mean, sigma, .. } => format!("normal, mean {mean}, σ {sigma}"),
            Self::Uniform { low, high } => format!("uniform, {low} … {high}"),
            Self::Choice(values) => format!("one of {values:?}"),
            Self::Ball { radius, components: 2 } => {
                format!("component of a vector, uniform in a disc of radius {radius}")
            }
            Self::Ball { radius, .. } => format!("component of a vector, uniform in a ball of radius {radius}"),
            Self::Grid(values) => format!("each of {values:?}"),
            Self::Directions { radius, count } => {
                format!("component of a vector of length {radius} in {count} directions")
            }
        }
    }
}

impl Design {
    /// Checks and prepares the dispersions of a scenario. `campaign` may differ from the one in its file.
    pub fn new(scenario: &Scenario, campaign: &Campaign) -> Result<Self, CampaignError> {
        let (mut entries, mut inputs, mut dimension) = (Vec::new(), Vec::new(), 0);
        for (i, spec) in campaign.disperse.iter().enumerate() {
            let paths = paths_of(spec);
            let kind = kind_of(scenario, spec, &paths, i)?;
            let name = spec.name.clone().unwrap_or_else(|| paths.join(", "));
            for (k, path) in paths.iter().enumerate() {
                let column = match (&spec.name, paths.len()) {
                    (Some(name), 1) => name.clone(),
                    (Some(name), _) => format!("{name}_{}", ["x", "y", "z"][k]),
                    (None, _) => path.clone(),
                };
                inputs.push(Input { name: column, path: path.clone(), distribution: kind.words(), ..Input::default() });
            }
            let entry = Entry { name, key: paths.join(" "), kind, dimension };
            dimension += entry.kind.dimensions();
            entries.push(entry);
        }
        check_names(&inputs)?;
        if campaign.sampling == Sampling::Sobol && dimension > SOBOL_DIMENSIONS {
            return Err(CampaignError::TooManyDimensions { wanted: dimension, most: SOBOL_DIMENSIONS });
        }
        let copula = copula(campaign, &entries)?;
        let combinations = entries.iter().try_fold(1_u64, |n, e| n.checked_mul(e.kind.count()));
        let combinations = combinations.ok_or(CampaignError::TooManyCombinations)?;
        let strata = u64::from(campaign.strata.unwrap_or(campaign.runs).max(2));
        Ok(Self { seed: scenario.seed, sampling: campaign.sampling, strata, entries, copula, combinations, inputs })
    }

    /// Combinations of all grids: a multiple of this many runs takes each equally often.
    pub fn combinations(&self) -> u64 {
        self.combinations
    }

    /// How the inputs are drawn, in words.
    pub fn words(&self) -> String {
        let draws = self.entries.iter().any(|e| e.kind.dimensions() > 0);
        let sampling = match self.sampling {
            Sampling::Random => "independent draws".to_owned(),
            Sampling::LatinHypercube => format!("Latin hypercubes of {} runs", self.strata),
            Sampling::Sobol => "scrambled Sobol' sequence".to_owned(),
        };
        match (self.combinations, draws) {
            (1, true) => sampling,
            (1, false) => "nothing is dispersed".to_owned(),
            (n, true) => format!("{n} combinations, with {sampling}"),
            (n, false) => format!("{n} combinations"),
        }
    }

    /// The inputs of run `run`, in the order of [`Design::inputs`].
    pub fn draw(&self, run: u64) -> Vec<f64> {
        let mut uniform: Vec<Vec<f64>> = self.entries.iter().map(|e| self.uniform(e, run)).collect();
        if let Some((lower, members)) = &self.copula {
            let normal = standard_normal();
            let scores =
                DVector::from_iterator(members.len(), members.iter().map(|e| normal.inverse_cdf(uniform[*e][0])));
            let together = lower * scores;
            for (score, entry) in together.iter().zip(members) {
                uniform[*entry][0] = normal.cdf(*score);
            }
        }
        let mut rest = run % self.combinations;
        let mut places = vec![0; self.entries.len()];
        for (place, entry) in places.iter_mut().zip(&self.entries).rev() {
            (*place, rest) = (rest % entry.kind.count(), rest / entry.kind.count());
        }
        let each = self.entries.iter().zip(&uniform).zip(&places);
        each.flat_map(|((entry, u), place)| values_of(&entry.kind, u, *place)).collect()
    }

    fn uniform(&self, entry: &Entry, run: u64) -> Vec<f64> {
        (0..entry.kind.dimensions())
            .map(|component| {
                let ask = Ask { seed: self.seed, run, name: &entry.key, component };
                match self.sampling {
                    Sampling::Random => ask.random(),
                    Sampling::LatinHypercube => ask.latin(self.strata),
                    Sampling::Sobol => ask.sobol(entry.dimension + component),
                }
            })
            .collect()
    }
}

fn paths_of(spec: &Disperse) -> Vec<String> {
    spec.path.iter().chain(spec.paths.iter().flatten()).cloned().collect()
}

fn kind_of(scenario: &Scenario, spec: &Disperse, paths: &[String], i: usize) -> Result<Kind, CampaignError> {
    let refuse =
        |reason: &str| CampaignError::Dispersion { entry: i, paths: paths.join(", "), reason: reason.to_owned() };
    let vector = spec.ball.is_some() || spec.directions.is_some();
    if vector != (paths.len() > 1) {
        return Err(refuse("`ball` and `directions` take `paths`, all others one `path`"));
    }
    if let Some(normal) = &spec.normal {
        let mean = match normal.mean {
            Some(mean) => mean,
            None => own_value(scenario, &paths[0])
                .ok_or_else(|| refuse("the file says nothing at this path, so give the distribution a `mean`"))?,
        };
        let ends = [normal.low.unwrap_or(f64::NEG_INFINITY), normal.high.unwrap_or(f64::INFINITY)];
        return Ok(Kind::Normal { mean, sigma: normal.sigma, ends });
    }
    if let Some(uniform) = &spec.uniform {
        return Ok(Kind::Uniform { low: uniform.low, high: uniform.high });
    }
    if let Some(values) = &spec.choice {
        return Ok(Kind::Choice(values.clone()));
    }
    if let Some(values) = &spec.grid {
        return Ok(Kind::Grid(values.clone()));
    }
    if let Some(sweep) = &spec.sweep {
        let last = f64::from(sweep.count - 1);
        let value = |k: u32| sweep.low + (sweep.high - sweep.low) * f64::from(k) / last;
        return Ok(Kind::Grid((0..sweep.count).map(value).collect()));
    }
    if let Some(ball) = &spec.ball {
        return Ok(Kind::Ball { radius: ball.radius, components: paths.len() });
    }
    match &spec.directions {
        Some(_) if paths.len() != 2 => Err(refuse("`directions` lie in a plane: give two paths")),
        Some(d) => Ok(Kind::Directions { radius: d.radius, count: d.count }),
        None => Err(refuse("no distribution")),
    }
}

/// The value that the file, or its default, has at a path.
fn own_value(scenario: &Scenario, path: &str) -> Option<f64> {
    let values = scenario.value_at(path).ok()?;
    let (_, value) = values.first()?;
    value.as_float().or(value.as_integer().map(|i| i as f64))
}

fn check_names(inputs: &[Input]) -> Result<(), CampaignError> {
    for (i, input) in inputs.iter().enumerate() {
        if inputs[..i].iter().any(|other| other.path == input.path) {
            return Err(CampaignError::DispersedTwice { path: input.path.clone() });
        }
        if inputs[..i].iter().any(|other| other.name == input.name) {
            return Err(CampaignError::NamedTwice { name: input.name.clone() });
        }
    }
    Ok(())
}

fn copula(campaign: &Campaign, entries: &[Entry]) -> Result<Option<Copula>, CampaignError> {
    let find = |name: &String| {
        let found = entries.iter().position(|e| e.name == *name || e.key == *name);
        match found {
            Some(e) if entries[e].kind.is_continuous() => Ok(e),
            Some(_) => Err(CampaignError::Correlation {
                name: name.clone(),
                reason: "only normal and uniform numbers can be correlated".to_owned(),
            }),
            None => Err(CampaignError::Correlation {
                name: name.clone(),
                reason: "no dispersion has this name or path".to_owned(),
            }),
        }
    };
    let mut pairs = Vec::new();
    for correlate in &campaign.correlate {
        let [a, b] = &correlate.between;
        pairs.push((find(a)?, find(b)?, correlate.rho));
    }
    let mut members: Vec<usize> = pairs.iter().flat_map(|(a, b, _)| [*a, *b]).collect();
    members.sort_unstable();
    members.dedup();
    if members.is_empty() {
        return Ok(None);
    }
    let place = |e: usize| members.partition_point(|m| *m < e);
    let mut matrix = DMatrix::identity(members.len(), members.len());
    for (a, b, rho) in pairs {
        (matrix[(place(a), place(b))], matrix[(place(b), place(a))]) = (rho, rho);
    }
    let names = members.iter().map(|m| entries[*m].name.as_str()).collect::<Vec<_>>().join(", ");
    let factor = matrix.cholesky().ok_or(CampaignError::NotACorrelation { names })?;
    Ok(Some((factor.l(), members)))
}

fn values_of(kind: &Kind, u: &[f64], place: u64) -> Vec<f64> {
    match kind {
        Kind::Normal { mean, sigma, ends } => vec![truncated(*mean, *sigma, *ends, u[0])],
        Kind::Uniform { low, high } => vec![low + (high - low) * u[0]],
        Kind::Choice(values) => vec![values[((u[0] * values.len() as f64) as usize).min(values.len() - 1)]],
        Kind::Grid(values) => vec![values[place as usize]],
        Kind::Directions { radius, count } => {
            let (sin, cos) = (TAU * place as f64 / f64::from(*count)).sin_cos();
            vec![radius * cos, radius * sin]
        }
        Kind::Ball { radius, components: 2 } => {
            let ((sin, cos), r) = ((TAU * u[1]).sin_cos(), radius * u[0].sqrt());
            vec![r * cos, r * sin]
        }
        Kind::Ball { radius, .. } => {
            let ((sin, cos), r, z) = ((TAU * u[1]).sin_cos(), radius * u[0].cbrt(), 1.0 - 2.0 * u[2]);
            let across = (1.0 - z * z).max(0.0).sqrt();
            vec![r * across * cos, r * across * sin, r * z]
        }
    }
}

fn truncated(mean: f64, sigma: f64, [low, high]: [f64; 2], u: f64) -> f64 {
    if sigma == 0.0 {
        return mean.clamp(low, high);
    }
    let normal = standard_normal();
    let share = |x: f64| normal.cdf((x - mean) / sigma);
    let (below, above) = (share(low), share(high));
    (mean + sigma * normal.inverse_cdf(below + (above - below) * u)).clamp(low, high)
}

fn standard_normal() -> Normal {
    Normal::standard()
}

#[cfg(test)]
mod tests {
    use super::*;

    const RUNS: u64 = 4000;

    /// A column for each input of a campaign that is written like this.
    fn columns(campaign: &str, runs: u64) -> Vec<Vec<f64>> {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/probe-drogue.toml");
        let scenario = scenario::load(file.as_ref(), &[]).expect("the scenario is in the repository");
        let campaign: Campaign = toml::from_str(campaign).expect("a campaign");
        let design = Design::new(&scenario, &campaign).expect("it can be drawn");
        let drawn: Vec<Vec<f64>> = (0..runs).map(|run| design.draw(run)).collect();
        (0..design.inputs.len()).map(|k| drawn.iter().map(|row| row[k]).collect()).collect()
    }

    fn mean(x: &[f64]) -> f64 {
        x.iter().sum::<f64>() / x.len() as f64
    }

    fn correlation(x: &[f64], y: &[f64]) -> f64 {
        let product = |a: &[f64], b: &[f64]| {
            let (ma, mb) = (mean(a), mean(b));
            a.iter().zip(b).map(|(p, q)| (p - ma) * (q - mb)).sum::<f64>()
        };
        product(x, y) / (product(x, x) * product(y, y)).sqrt()
    }

    #[test]
    fn correlated_normals_have_the_correlation_and_their_own_spread() {
        let all = columns(
            "runs = 4000\nsampling = \"latin-hypercube\"\n\
             disperse = [{ name = \"a\", path = \"seed\", normal = { mean = 3.0, sigma = 2.0 } }, \
             { name = \"b\", path = \"duration_s\", normal = { mean = 0.0, sigma = 0.1 } }]\n\
             correlate = [{ between = [\"a\", \"b\"], rho = 0.7 }]",
            RUNS,
        );
        // Standard error of a correlation: (1 − ρ²)/√n.
        let error = (1.0 - 0.49) / (RUNS as f64).sqrt();
        assert!((correlation(&all[0], &all[1]) - 0.7).abs() < 4.0 * error);
        let spread = |x: &[f64]| mean(&x.iter().map(|v| (v - mean(x)).powi(2)).collect::<Vec<_>>()).sqrt();
        assert!((mean(&all[0]) - 3.0).abs() < 0.15 && (spread(&all[0]) - 2.0).abs() < 0.1);
        assert!((spread(&all[1]) - 0.1).abs() < 0.005);
    }

    #[test]
    fn a_truncated_normal_keeps_within_its_ends_and_has_its_own_mean() {
        let x = &columns(
            "runs = 4000\nsampling = \"latin-hypercube\"\n\
             disperse = [{ path = \"duration_s\", normal = { mean = 1.0, sigma = 0.5, low = 1.0, high = 2.0 } }]",
            RUNS,
        )[0];
        assert!(x.iter().all(|x| (1.0..=2.0).contains(x)));
        // μ + σ (φ(α) − φ(β))/(Φ(β) − Φ(α)) with α = 0, β = 2.
        let expected = 1.0 + 0.5 * (0.398_942_280_4 - 0.053_990_966_5) / 0.477_249_868_1;
        assert!((mean(x) - expected).abs() < 1e-3, "{} for {expected}", mean(x));
    }

    #[test]
    fn a_disc_is_filled_evenly_and_directions_lie_on_its_rim() {
        let all = columns(
            "runs = 4000\ndisperse = [{ name = \"r\", paths = [\"duration_s\", \"seed\"], ball = { radius = 2.0 } }]",
            RUNS,
        );
        let inside = |radius: f64| {
            let within = all[0].iter().zip(&all[1]).filter(|(x, y)| x.hypot(**y) < radius).count();
            within as f64 / RUNS as f64
        };
        assert_eq!(inside(2.0 + 1e-12), 1.0);
        // A quarter of the area; standard error √(p q/n).
        assert!((inside(1.0) - 0.25).abs() < 4.0 * (0.25 * 0.75 / RUNS as f64).sqrt());
        let rim = columns(
            "runs = 8\ndisperse = [{ name = \"r\", paths = [\"duration_s\", \"seed\"], directions = { radius = 2.0, count = 8 } }]",
            8,
        );
        assert!(rim[0].iter().zip(&rim[1]).all(|(x, y)| (x.hypot(*y) - 2.0).abs() < 1e-12));
        assert!(mean(&rim[0]).abs() < 1e-12 && mean(&rim[1]).abs() < 1e-12);
    }

    #[test]
    fn grids_take_every_combination_once_the_first_slowest() {
        let all = columns(
            "runs = 6\ndisperse = [{ path = \"duration_s\", grid = [1.0, 2.0] }, \
             { path = \"seed\", sweep = { low = 0.0, high = 1.0, count = 3 } }]",
            6,
        );
        assert_eq!(all[0], [1.0, 1.0, 1.0, 2.0, 2.0, 2.0]);
        assert_eq!(all[1], [0.0, 0.5, 1.0, 0.0, 0.5, 1.0]);
    }

    #[test]
    fn correlations_that_contradict_each_other_are_refused() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/probe-drogue.toml");
        let scenario = scenario::load(file.as_ref(), &[]).expect("the scenario is in the repository");
        let three = "runs = 10\n\
             disperse = [{ name = \"a\", path = \"seed\", uniform = { low = 0.0, high = 1.0 } }, \
             { name = \"b\", path = \"duration_s\", uniform = { low = 0.0, high = 1.0 } }, \
             { name = \"c\", path = \"integrator.step_s\", uniform = { low = 0.0, high = 1.0 } }]\n\
             correlate = [{ between = [\"a\", \"b\"], rho = 0.9 }, { between = [\"b\", \"c\"], rho = 0.9 }, \
             { between = [\"a\", \"c\"], rho = -0.9 }]";
        let campaign: Campaign = toml::from_str(three).expect("a campaign");
        let refused = Design::new(&scenario, &campaign).expect_err("no such numbers exist");
        assert!(matches!(refused, CampaignError::NotACorrelation { .. }), "{refused}");
    }
}
