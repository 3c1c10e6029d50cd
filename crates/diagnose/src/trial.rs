//! Temporary driver.
#![allow(clippy::print_stdout, missing_docs)]
use crate::catalogue::hypotheses;
use crate::error::DiagnoseError;
use crate::facts::Facts;
use crate::fit::{EffectSet, Effort, Fit, fit};
use crate::guess::guess;
use crate::linear::{Segment, Stage, windows};
use crate::plant::Plant;
use crate::replay::Pace;
use crate::search::{Limits, search};
use crate::tape::Tape;
use record::{RecordingSet, Role};
use scenario::Scenario;

pub fn run(scenario: Scenario, set: &RecordingSet) -> Result<(), DiagnoseError> {
    let t0 = std::time::Instant::now();
    let window: Option<f64> = std::env::var("W").ok().and_then(|w| w.parse().ok());
    let step: f64 = std::env::var("H").ok().and_then(|w| w.parse().ok()).unwrap_or(scenario.integrator.step_s);
    let mut plant = Plant::new(scenario);
    let built = plant.build(&[])?;
    let tapes: Vec<Tape> = set.runs.iter().map(|r| Tape::new(set, r, &built)).collect::<Result<_, _>>()?;
    plant.attach(set, &built.model, tapes[0].readings.iter().map(|r| r.channel.clone()).collect())?;
    let built = plant.build(&[])?;
    for t in &tapes {
        println!("{} {:?} {} scalars span {:?}", t.file, t.role, t.count_scalars(), t.span);
    }
    let stage = Stage { tapes: &tapes, pace: Pace { step } };
    let segments: Vec<Segment> = (0..tapes.len())
        .filter(|r| tapes[*r].role == Role::Fit)
        .flat_map(|run| windows(&tapes[run], window).into_iter().map(move |span| (run, span)))
        .map(|(run, span)| Segment { run, span, start: guess(&built, &tapes[run], span.from) })
        .collect();
    println!("{} segments, {:.1} s", segments.len(), t0.elapsed().as_secs_f64());
    let (cost, count) = stage.cost(&built, &segments);
    println!("guess rms {:.3}  {:.2} s", (cost / count as f64).sqrt(), t0.elapsed().as_secs_f64());
    per_reading(
        &stage,
        &Fit {
            set: EffectSet::default(),
            built: built.clone(),
            segments: segments.clone(),
            cost,
            count,
            freedom: 0,
            covariance: nalgebra::DMatrix::zeros(0, 0),
            converged: false,
            iterations: 0,
        },
    );
    let nominal = fit(&stage, &plant, EffectSet::default(), segments, Effort { iterations: 6, share: 1e-4 })?;
    show("nominal", &nominal, t0);
    let w = window.unwrap_or(tapes[0].span.1);
    let located =
        crate::locate::locate(&stage, &plant, &nominal, crate::locate::places(&Facts::new(&nominal.built, &tapes), w))?;
    for p in located.ranked() {
        println!(
            "  located {:30} S {:12.1} rank {} share {:.3}",
            located.places[p].name,
            located.score(p),
            located.rank(p),
            located.share(p)
        );
    }
    println!("{:.1} s", t0.elapsed().as_secs_f64());
    let keep: Vec<String> = located
        .ranked()
        .into_iter()
        .filter(|p| located.share(*p) > 0.2 * located.share(located.ranked()[0]))
        .map(|p| located.places[p].name.clone())
        .collect();
    let facts = |f: &Fit| {
        let mut h = hypotheses(&Facts::new(&f.built, &tapes));
        h.retain(|h| !h.place.starts_with("joint:") || keep.contains(&h.place));
        h
    };
    let limits = Limits { effects: 3, refits: 4, sigmas: 4.0 };
    let (found, attempts) = search(&stage, &plant, nominal, &facts, &limits)?;
    tell(&attempts);
    show("found", &found, t0);
    if window.is_some() {
        let segments: Vec<Segment> = found
            .segments
            .iter()
            .filter(|s| s.span.from == tapes[s.run].span.0)
            .map(|s| Segment { span: crate::replay::Span { from: s.span.from, to: tapes[s.run].span.1 }, ..s.clone() })
            .collect();
        let whole = fit(&stage, &plant, found.set, segments, Effort { iterations: 12, share: 1e-5 })?;
        show("whole", &whole, t0);
        let (found, attempts) = search(&stage, &plant, whole, &facts, &limits)?;
        tell(&attempts);
        show("found", &found, t0);
    }
    Ok(())
}

fn tell(attempts: &[crate::search::Attempt]) {
    for a in attempts.iter().filter(|a| a.fall.is_some() || a.share > 0.02) {
        println!(
            "  {} {:28} {:24} S {:11.1} share {:.4} fall {:?} gain {:?} p {} {} {:.4?}",
            a.round,
            a.name,
            a.place,
            a.score,
            a.share,
            a.fall,
            a.gain,
            a.parameters,
            if a.kept { "KEPT" } else { "" },
            a.found
        );
    }
}

fn show(what: &str, f: &Fit, t0: std::time::Instant) {
    println!(
        "{what}: rms {:.4} excess {:.0} ({:.1} sd) it {} conv {} N {}  {:.2} s",
        f.rms(),
        f.excess(),
        f.excess() / f.spread(),
        f.iterations,
        f.converged,
        f.count,
        t0.elapsed().as_secs_f64()
    );
    for (h, x) in &f.set.members {
        println!("   {} {:?}", h.title(), h.decode(x));
    }
}

pub fn per_reading(stage: &Stage<'_>, f: &Fit) {
    for s in f.segments.iter().take(2) {
        let tape = &stage.tapes[s.run];
        let r = stage.residuals(&f.built, s);
        let range = tape.range(s.span);
        for (k, reading) in tape.readings.iter().enumerate() {
            let mut at: Vec<f64> = Vec::new();
            for i in range.clone() {
                if tape.events[i].reading as usize == k {
                    let o = tape.offsets[i] - tape.offsets[range.start];
                    at.extend(r.iter().skip(o).take(reading.width()));
                }
            }
            println!(
                "   {} {} sigma {:.3e} n {} rms {:.3} first {:?} last {:?}",
                tape.file,
                reading.channel,
                reading.sigma,
                at.len(),
                (at.iter().map(|x| x * x).sum::<f64>() / at.len() as f64).sqrt(),
                &at[..6.min(at.len())],
                &at[at.len().saturating_sub(3)..]
            );
        }
    }
}
