//! Made-up diagnoses with their evidence, shaped as an estimator would give them: a joint, a contact, nothing, something unknown.

mod cases;

pub use cases::{contact, joint, null, unknown};

use diagnose::diagnosis::{
    BeforeAfter, Diagnosis, Errors, Found, Located, ParamValue, Rival, Role, RunError, StdErr, Verdict,
};
use diagnose::evidence::{
    Curve, Evidence, Heat, HeatRow, Hypothesis, Identifiable, Level, Remark, Stage, Status, Whiteness,
};

/// Reproducible numbers that look like noise: a linear congruential generator, twelve draws a normal deviate.
pub struct Noise(u64);

impl Noise {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }
}

/// How a sample is described in short.
pub struct Sample<'a> {
    pub scenario: &'a str,
    pub recording: &'a str,
    pub verdict: Verdict,
    pub window_s: f64,
    /// Free run and windows of the nominal model, and of the corrected one.
    pub before: (f64, f64),
    pub after: (f64, f64),
}

impl Sample<'_> {
    pub fn diagnosis(&self, located: Vec<Located>, effects: Vec<Found>) -> Diagnosis {
        let free = BeforeAfter { before: self.before.0, after: self.after.0 };
        let windowed = BeforeAfter { before: self.before.1, after: self.after.1 };
        let run = |k: usize| {
            let size = [1.0, 0.4, 1.9, 0.7, 1.2][k];
            let of = |x: f64| if x < 1.1 { x + 0.003 * (size - 1.0) } else { x * size };
            RunError {
                file: format!("run-0{}.csv", k + 1),
                role: if k < 3 { Role::Fit } else { Role::Holdout },
                before: of(self.before.0),
                after: of(self.after.0),
                windowed_before: of(self.before.1),
                windowed_after: of(self.after.1),
            }
        };
        let runs = (0..5).map(run).collect();
        let fit = BeforeAfter { before: 1.1 * free.before, after: free.after - 0.002 };
        Diagnosis {
            within_tolerance: Vec::new(),
            explained_share: None,
            remainder: None,
            format: 1,
            scenario: self.scenario.to_owned(),
            recording: self.recording.to_owned(),
            verdict: self.verdict,
            located,
            effects,
            error: Errors {
                fit,
                holdout: Some(free),
                window_s: self.window_s,
                windowed,
                within_tolerance: None,
                runs,
                channels: Vec::new(),
            },
            remarks: Vec::new(),
        }
    }
}

pub fn located(place: &str, share: f64, (from_s, to_s): (f64, f64), condition: &str) -> Located {
    Located { place: place.to_owned(), share, from_s, to_s, condition: condition.to_owned() }
}

pub fn found(name: &str, place: &str, params: &[(&str, f64, f64)], rivals: &[(&str, &str, f64)]) -> Found {
    let rival = |r: &(&str, &str, f64)| Rival { name: r.0.to_owned(), place: r.1.to_owned(), score_gap: r.2 };
    Found {
        name: name.to_owned(),
        place: place.to_owned(),
        params: params.iter().map(|p| (p.0.to_owned(), ParamValue::Number(p.1))).collect(),
        std_err: params.iter().map(|p| (p.0.to_owned(), StdErr::one(p.2))).collect(),
        slides: false,
        rivals: rivals.iter().map(rival).collect(),
    }
}

/// A heat strip whose mismatch is `size(channel, t)` times noise².
pub fn heat(
    (run, role): (&str, Role),
    channels: &[&str],
    (duration, bins): (f64, usize),
    size: impl Fn(usize, f64) -> f64,
) -> Heat {
    let mut noise = Noise::new(7);
    let edges_s: Vec<f64> = (0..=bins).map(|k| duration * k as f64 / bins as f64).collect();
    let mut row = |(k, channel): (usize, &&str)| {
        let mut around = || 1.0 + 0.12 * noise.normal();
        let nominal = edges_s[1..].iter().map(|t| around() + size(k, *t)).collect();
        let corrected = edges_s[1..].iter().map(|_| around()).collect();
        HeatRow { channel: (*channel).to_owned(), nominal, corrected }
    };
    let rows = channels.iter().enumerate().map(&mut row).collect();
    Heat { run: run.to_owned(), role, window_s: None, edges_s, rows }
}

/// A channel: its truth and the nominal model's error, as functions of time.
pub fn curve(
    (channel, unit, sigma): (&str, &str, f64),
    (run, role): (&str, Role),
    (duration, rate): (f64, f64),
    truth: impl Fn(f64) -> f64,
    error: impl Fn(f64) -> f64,
) -> Curve {
    let mut noise = Noise::new(channel.len() as u64);
    let t: Vec<f64> = (0..(duration * rate) as usize).map(|k| k as f64 / rate).collect();
    Curve {
        run: run.to_owned(),
        role,
        channel: channel.to_owned(),
        unit: unit.to_owned(),
        sigma,
        window_s: None,
        measured: t.iter().map(|t| truth(*t) + sigma * noise.normal()).collect(),
        nominal: t.iter().map(|t| truth(*t) + error(*t)).collect(),
        corrected: t.iter().map(|t| truth(*t) + 0.1 * sigma * (3.0 * t).sin()).collect(),
        t,
    }
}

/// Hypotheses: (name, place, screen, share, refit, status, why).
pub fn ranking(rows: &[(&str, &str, f64, f64, f64, Status, &str)]) -> Vec<Hypothesis> {
    let one = |r: &(&str, &str, f64, f64, f64, Status, &str)| Hypothesis {
        name: r.0.to_owned(),
        place: r.1.to_owned(),
        screen_score: r.2,
        freedoms: 1 + r.0.len() % 3,
        share: r.3,
        refit_fall: r.4,
        bic_gain: r.4 - 12.1,
        held_back_gain: 0.31 * r.4,
        status: r.5,
        why: r.6.to_owned(),
    };
    rows.iter().map(one).collect()
}

pub fn whiteness(channel: &str, lag: f64, memory: f64) -> Whiteness {
    let mut noise = Noise::new(3);
    let lags_s: Vec<f64> = (1..=30).map(|k| f64::from(k) * lag).collect();
    Whiteness {
        channel: channel.to_owned(),
        before: lags_s.iter().map(|t| (-t / memory).exp()).collect(),
        after: lags_s.iter().map(|_| 0.012 * noise.normal()).collect(),
        lags_s,
        bound: 0.025,
    }
}

/// What every sample has: remarks on the data, identifiability, times.
pub fn common(mut evidence: Evidence, probe: (&str, &str, &str, &str, f64)) -> Evidence {
    let remark =
        |level, subject: &str, text: &str| Remark { level, subject: subject.to_owned(), text: text.to_owned() };
    evidence.quality = vec![
        remark(
            Level::Note,
            "run-03.csv",
            "1.2 % of the samples are missing, in 14 gaps of at most 8 ms; nothing was interpolated.",
        ),
        remark(Level::Warning, "run-01.csv", "3 time stamps are repeated; the first of each was kept."),
    ];
    let identifiable = |k: usize| Identifiable {
        effect: probe.0.to_owned(),
        place: probe.1.to_owned(),
        parameter: probe.2.to_owned(),
        unit: probe.3.to_owned(),
        std_err: if k == 2 { f64::INFINITY } else { probe.4 * (1.0 + k as f64) },
        condition: 10_f64.powi(2 * k as i32),
        remark: if k == 2 { "the motion never excites it" } else { "" }.to_owned(),
    };
    evidence.identifiability = (0..3).map(identifiable).collect();
    let stage = |name: &str, wall_s, simulated_s| Stage { name: name.to_owned(), wall_s, simulated_s };
    evidence.timings = vec![
        stage("read and check", 0.8, 0.0),
        stage("nominal replay, step check", 4.1, 180.0),
        stage("screen, two window lengths", 31.0, 2900.0),
        stage("refits", 62.0, 5400.0),
        stage("intervals, holdout", 18.5, 1300.0),
    ];
    evidence
}
