//! Everything that the runs of a campaign share: the scenario, the design, what is read back, and the table's header.

use crate::applied::Gauge;
use crate::chance::run_seed;
use crate::design::Design;
use crate::error::CampaignError;
use crate::table::Header;
use scenario::spec::Campaign;
use scenario::{Mission, Scenario, Stock};
use sha2::{Digest, Sha256};
use std::fmt::Write;

/// Runs that are looked through for a second value of an input.
const LOOKED_AT: u64 = 64;
/// Tables of the scenario that are read elsewhere than in the built model: by the controller, the judge, the run loop.
const ELSEWHERE: [&str; 4] = ["strategy", "docking", "duration_s", "output"];

/// A campaign that is ready to run; shared by all threads.
#[derive(Debug)]
pub struct Plan {
    /// The scenario, nothing dispersed.
    pub scenario: Scenario,
    /// Its campaign, with what the command line changed.
    pub campaign: Campaign,
    /// The variant of it that was chosen.
    pub variant: Option<String>,
    /// How inputs are drawn.
    pub design: Design,
    /// What the table is of.
    pub header: Header,
    gauges: Vec<Gauge>,
    stock: Stock,
}

impl Plan {
    /// Builds the nominal mission once, checks every dispersion, and shows that the model hears each.
    ///
    /// `variant` names dispersions other than the campaign's own; `runs` takes the place of the file's number.
    pub fn new(scenario: Scenario, variant: Option<&str>, runs: Option<u32>) -> Result<Self, CampaignError> {
        let mut campaign = match (&scenario.campaign, runs) {
            (Some(campaign), _) => chosen(campaign, variant)?,
            (None, Some(runs)) => empty(runs),
            (None, None) => return Err(CampaignError::NoCampaign { file: scenario.source.file().to_owned() }),
        };
        // Strata are those of the file, so that more runs do not move the samples of the first ones.
        campaign.strata = campaign.strata.or(Some(campaign.runs.max(2)));
        campaign.runs = runs.unwrap_or(campaign.runs);
        let design = Design::new(&scenario, &campaign)?;
        let nominal = scenario::build(&scenario)?;
        let gauges: Vec<Gauge> = design.inputs.iter().map(|input| Gauge::of(&nominal, &input.path)).collect();
        let mut design = design;
        for (input, gauge) in design.inputs.iter_mut().zip(&gauges) {
            input.read_from = if gauge.reads_model() { "built model" } else { "scenario as built" }.to_owned();
        }
        let header = Header {
            scenario: scenario.name.clone(),
            description: scenario.description.clone().unwrap_or_default(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            seed: scenario.seed,
            success: campaign.success.clone().unwrap_or_else(|| "captured".to_owned()),
            sampling: design.words(),
            inputs: design.inputs.clone(),
            toml: toml_of(&scenario, &campaign),
            fingerprint: String::new(),
        };
        let header = Header { fingerprint: fingerprint(&header, &nominal), ..header };
        let stock = Stock::of(&nominal);
        let variant = variant.map(str::to_owned);
        let plan = Self { scenario, campaign, variant, design, header, gauges, stock };
        plan.check_heard()?;
        Ok(plan)
    }

    /// Number of runs.
    pub fn runs(&self) -> u64 {
        u64::from(self.campaign.runs)
    }

    /// The scenario of run `run`, with the values drawn for it.
    pub fn scenario_of(&self, run: u64) -> Result<(Scenario, Vec<f64>), CampaignError> {
        let drawn = self.design.draw(run);
        Ok((self.with_values(run, &drawn)?, drawn))
    }

    fn with_values(&self, run: u64, values: &[f64]) -> Result<Scenario, CampaignError> {
        let paths = self.design.inputs.iter().map(|i| i.path.as_str());
        let numbers: Vec<(&str, f64)> = paths.zip(values.iter().copied()).collect();
        Ok(self.scenario.with_numbers(&numbers, run_seed(self.scenario.seed, run))?)
    }

    /// The mission of a run's scenario.
    pub fn build(&self, scenario: &Scenario) -> Result<Mission, CampaignError> {
        Ok(scenario::build_from(scenario, &self.stock)?)
    }

    /// What the inputs are in a mission that was built.
    pub(crate) fn read_back(&self, mission: &Mission) -> Vec<Option<f64>> {
        self.gauges.iter().map(|gauge| gauge.read(mission)).collect()
    }

    /// A number that changes nothing in what is built is a slip of the pen, and a campaign over it a lie.
    fn check_heard(&self) -> Result<(), CampaignError> {
        let first = self.design.draw(0);
        let Ok(base) = self.with_values(0, &first).and_then(|s| self.build(&s)) else { return Ok(()) };
        let base = image(&base);
        for (k, input) in self.design.inputs.iter().enumerate() {
            let other = (1..LOOKED_AT).map(|run| self.design.draw(run)[k]).find(|value| *value != first[k]);
            let head = input.path.split(['.', '[']).next().unwrap_or_default();
            let Some(other) = other.filter(|_| !ELSEWHERE.contains(&head)) else { continue };
            let mut values = first.clone();
            values[k] = other;
            // What cannot be built does hear it; the run itself will say why.
            let Ok(built) = self.with_values(0, &values).and_then(|s| self.build(&s)) else { continue };
            if image(&built) == base {
                let hint = hint(&self.scenario, &input.path);
                return Err(CampaignError::Unheard { path: input.path.clone(), hint });
            }
        }
        Ok(())
    }
}

fn hint(scenario: &Scenario, path: &str) -> String {
    let by_approach = scenario.vehicles.iter().any(|v| v.approach.is_some()) && path.contains(".pose");
    match by_approach {
        true => "the vehicle's `approach` says where it is; disperse that".to_owned(),
        false => "another key may override it; see `softdock check`".to_owned(),
    }
}

/// The campaign with the dispersions of a variant, or its own.
fn chosen(campaign: &Campaign, variant: Option<&str>) -> Result<Campaign, CampaignError> {
    let mut own = Campaign { variants: Vec::new(), ..campaign.clone() };
    let Some(name) = variant else { return Ok(own) };
    let Some(variant) = campaign.variants.iter().find(|v| v.name == name) else {
        let have = campaign.variants.iter().map(|v| format!("\"{}\"", v.name)).collect::<Vec<_>>().join(", ");
        let have = if have.is_empty() { "none".to_owned() } else { have };
        return Err(CampaignError::NoVariant { name: name.to_owned(), have });
    };
    own.runs = variant.runs;
    own.disperse.clone_from(&variant.disperse);
    own.expects.clone_from(&variant.expects);
    Ok(own)
}

fn empty(runs: u32) -> Campaign {
    Campaign {
        runs,
        sampling: Default::default(),
        strata: None,
        success: None,
        signals: Vec::new(),
        disperse: Vec::new(),
        correlate: Vec::new(),
        variants: Vec::new(),
        expects: Vec::new(),
    }
}

/// The inputs of the campaign, without the number of runs: a longer campaign is the same campaign.
fn toml_of(scenario: &Scenario, campaign: &Campaign) -> String {
    let campaign = Campaign { runs: campaign.strata.unwrap_or(1), ..campaign.clone() };
    scenario::to_toml(&Scenario { campaign: Some(campaign), ..scenario.clone() })
}

/// The built model and its state as text: two builds that differ in anything but the places of their files differ here.
fn image(mission: &Mission) -> String {
    let model = mission.world.model();
    format!("{model:?}{:?}{:?}", model.scene.colliders(), mission.world.state())
}

/// Digest of the version, the inputs and everything that was built from files.
fn fingerprint(header: &Header, nominal: &Mission) -> String {
    let mut hash = Sha256::new();
    for text in [header.version.as_str(), &header.toml, &image(nominal)] {
        hash.update(text.as_bytes());
        hash.update([0]);
    }
    hash.finalize().iter().take(16).fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}
