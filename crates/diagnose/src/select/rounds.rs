//! One round of a search: the sets that promise most, fitted in full simulation, and the best of them.

use super::detail::{but_for_a_detail, relaxed};
use super::enough::Enough;
use super::left::{Left, Smaller};
use super::pool::Pool;
use super::regression::Spoken;
use super::search::{
    AT_ONCE, END, LOOK, Looked, NEXT_TO_NOTHING, Remainder, Tried, criterion, names, remainder, to_the_end,
};
use super::sets::LinearSet;
use crate::effect_set::EffectSet;
use crate::error::DiagnoseError;
use crate::identify::fit::{Fitted, Problem};
use crate::identify::marginal::Spread;
use crate::screen::Score;
use crate::work::{Until, Watch};

/// Sets of one size of the chain that are fitted in full simulation in a round, and how many of all where promises are broken.
const FITTED: usize = 2;
const ALL_FITTED: usize = 12;
/// Effects that are fitted alone where none of the sets leaves next to nothing: what a chain promises of a law hangs on how well it follows what moves.
const ALONE: usize = 8;
/// Places among them at which the most promising law is tried beside its own.
const SIBLINGS: usize = 2;
/// Sets of one size among them that the missing force speaks for; of the largest one.
const SPOKEN: usize = 2;
/// Share of the best promise, or of what another way has brought beyond a fit, below which a set is not fitted, of its own promise below which it may do
/// more with what it holds in reserve, and below which it was none.
pub(super) const PROMISING: f64 = 0.6;
const REFUTED: f64 = 0.1;
/// Share of the most that a set gains by which first fits may be short of what they come to.
const CLOSE: f64 = 0.02;

/// What a round of fits goes by.
#[derive(Clone, Copy)]
pub(super) struct Bounds {
    /// Its number.
    pub(super) round: usize,
    /// Hypotheses.
    pub(super) many: usize,
    /// Price of the cheapest effect.
    pub(super) cheapest: f64,
    /// What the unknown forces beside the nominal model do.
    pub(super) all: f64,
    /// Whether what is left is so little that the laws may make it themselves: what does not promise its price is not looked at then.
    pub(super) is_own: bool,
    /// Promise below which a set is not looked at: it could not come up with what was found on another way.
    pub(super) least: f64,
}

/// Fits the sets that promise most in full simulation; the best of them, taken to the end, where it is worth its price, and the best of those with fewer effects.
pub(super) fn fit_sets(
    problem: &Problem<'_>,
    begun: &Fitted,
    looked: &Looked,
    Bounds { round, many, cheapest, all, is_own, least }: Bounds,
    tried: &mut Vec<Tried>,
) -> Result<Option<(Fitted, Option<Fitted>)>, DiagnoseError> {
    let mut now = begun;
    let mut finer: Fitted;
    let (before, here) = (criterion(now, many), problem.power(now));
    let mut worthy: Vec<(usize, Fitted)> = Vec::new();
    let mut smaller: Vec<Smaller> = Vec::new();
    let (pool, watch) = (&looked.pool, problem.stage.work.watch);
    let mut known = Known::default();
    let mut enough: Vec<Enough> = Vec::new();
    while let Some(set) = next(looked, now, &mut known, !enough.is_empty()) {
        if known.done.len() == ALL_FITTED || problem.stage.work.is_spent(Until::Search) {
            break;
        }
        let added: Vec<String> = set.members.iter().map(|m| pool.of(m.0).title()).collect();
        known.done.push(pool.titles(set.members.iter().map(|m| m.0)));
        let costs = pool.price(&set.members.iter().map(|m| m.0).collect::<Vec<_>>(), now.count);
        let promised = now.score - set.score;
        if enough.iter().any(|known| known.outdoes(&added, costs)) || is_own && promised < costs || promised < least {
            continue;
        }
        let (same, fit) = match fit_first(problem, now, &set, pool, (many, here)) {
            Ok(Some(found)) => found,
            refuted => {
                known.refute((set, added), refuted.err(), watch);
                continue;
            }
        };
        if let Some(same) = same {
            finer = same;
            now = &finer;
        }
        let after = criterion(&fit, many);
        let (promised, brought) = (now.score - set.score, now.score - fit.score);
        let left = remainder(problem, &fit)?;
        let (names, power) = (names(&fit.set), problem.power(&fit));
        let gains = format!("promised {promised:.1}, brought {brought:.1}, criterion {:.1}", after - before);
        watch.step(&format!("  {names}: {gains}, {:.3} % left", 100.0 * power / here));
        known.judge(set, &added, [promised, brought]);
        if left.rise < cheapest || power < NEXT_TO_NOTHING * here {
            enough.push(Enough { titles: added.clone(), limit: costs + left.rise });
        }
        // What a set adds to a smaller one has to take its part of what that leaves, or a sensor's fault.
        let own = Smaller { titles: added.clone(), left: Left { power, spread: fit.spread.clone() } };
        let is_idle = smaller.iter().any(|known| own.is_idle_beside(known, all, problem.stage.doubt));
        smaller.push(own);
        let (scores, taken) = ([now.score, fit.score], (here - power) / all.max(f64::MIN_POSITIVE));
        tried.push(Tried { round, set: fit.set.clone(), added, scores, criteria: [before, after], promised, taken });
        if !is_idle && after < before {
            worthy.push((tried.len() - 1, fit));
        }
    }
    Ok(best_of(problem, worthy, tried, (before, here, many)))
}

/// A proposal fitted beside a fit, and that on the same intervals where these are others; none where it led astray and is no better from near what changes
/// nothing either.
fn fit_first(
    problem: &Problem<'_>,
    now: &Fitted,
    Proposal { members, beside, spread, score, is_again }: &Proposal,
    pool: &Pool,
    (many, here): (usize, f64),
) -> Result<Option<(Option<Fitted>, Fitted)>, DiagnoseError> {
    let begun = Fitted { spread: spread.clone(), ..now.clone() };
    let set = members.iter().fold(now.set.clone(), |all, (m, x)| all.with(pool.of(*m), x));
    let look =
        |set: EffectSet| problem.fit(&begun, set, LOOK).map(|fit| but_for_a_detail(problem, now, fit, (many, here)));
    if *is_again {
        let near = NEAR.into_iter().filter_map(|share| look(set.a_share_of_the_way(&now.set, share)).ok());
        let mut near = near.filter(|(same, fit)| fit.score < same.as_ref().unwrap_or(now).score);
        return Ok(near.next());
    }
    let slots = now.set.slots();
    let along = (beside.len() == slots.len() && !slots.is_empty()).then(|| {
        let moved = now.set.moved(&slots, beside);
        members.iter().fold(moved, |all, (m, x)| all.with(pool.of(*m), x))
    });
    let along = along.filter(|along| problem.is_likelier_to_begin(&begun, [along, &set]));
    let first = match along.map(look) {
        Some(Ok(first)) => first,
        None | Some(Err(_)) => look(set.clone())?,
    };
    let gain = |(same, fit): &(Option<Fitted>, Fitted)| same.as_ref().unwrap_or(now).score - fit.score;
    let is_better = criterion(&first.1, many) < criterion(first.0.as_ref().unwrap_or(now), many);
    if is_better && gain(&first) >= PROMISING * (now.score - score) {
        return Ok(Some(first));
    }
    // A law that leads astray may do so for what it holds in reserve.
    let free = set.released().into_iter().filter_map(|free| look(free).ok());
    let better = |best: (_, Fitted), free: (_, Fitted)| {
        if criterion(&free.1, many) < criterion(&best.1, many) { free } else { best }
    };
    Ok(Some(free.fold(first, better)))
}

/// Shares of the way to what is promised from which a fit is tried again that has led astray.
const NEAR: [f64; 2] = [0.25, 0.01];

/// What is known of the sets of a round.
#[derive(Default)]
struct Known {
    /// Those that were fitted, and titles of those that brought next to nothing of what they promised.
    done: Vec<Vec<String>>,
    refuted: Vec<Vec<String>>,
    /// Those that became worse than what changes nothing: promised too far away for what is linear.
    astray: Vec<Proposal>,
}

impl Known {
    /// Takes note of a set that is no better from near what changes nothing either, or cannot be followed where it was promised, which is said.
    fn refute(&mut self, (set, added): (Proposal, Vec<String>), error: Option<DiagnoseError>, watch: &dyn Watch) {
        if let Some(error) = error {
            watch.step(&format!("  {}: {error}", added.join("; ")));
            if !set.is_again {
                self.astray.push(Proposal { is_again: true, ..set });
            }
        }
        self.refuted.push(added);
    }

    /// Takes note of what a set brought.
    fn judge(&mut self, set: Proposal, added: &[String], [promised, brought]: [f64; 2]) {
        if set.is_again && brought >= REFUTED * promised {
            self.refuted.retain(|known| known != added);
        } else if !set.is_again && brought < REFUTED * promised {
            self.refuted.push(added.to_vec());
        }
        if !set.is_again && brought < 0.0 {
            self.astray.push(Proposal { is_again: true, ..set });
        }
    }
}

/// What is fitted next: the first of the proposals that was not yet; where nothing was enough, before sets of several what went astray, from near what
/// changes nothing, and after them laws alone.
fn next(looked: &Looked, now: &Fitted, known: &mut Known, is_enough: bool) -> Option<Proposal> {
    let promising = next_of(proposals(looked, now, &known.refuted), &looked.pool, &known.done);
    if is_enough {
        return promising;
    }
    if promising.as_ref().is_none_or(|p| p.members.len() > 1) && !known.astray.is_empty() {
        return Some(known.astray.remove(0));
    }
    promising.or_else(|| next_of(alone(looked, now), &looked.pool, &known.done))
}

/// The first proposal that was not fitted yet.
fn next_of(proposals: Vec<Proposal>, pool: &Pool, done: &[Vec<String>]) -> Option<Proposal> {
    proposals.into_iter().find(|p| !done.contains(&pool.titles(p.members.iter().map(|m| m.0))))
}

/// The best of some fits, each with its number among those tried; those that are next to as good as it are taken to the end first, and told as they are there.
/// And another way to begin: the best of those with fewer effects.
fn best_of(
    problem: &Problem<'_>,
    worthy: Vec<(usize, Fitted)>,
    tried: &mut [Tried],
    (before, here, many): (f64, f64, usize),
) -> Option<(Fitted, Option<Fitted>)> {
    let gain = |fit: &Fitted| before - criterion(fit, many);
    let close = |all: &[(usize, Fitted)]| {
        let most = all.iter().map(|(_, fit)| gain(fit)).fold(f64::NEG_INFINITY, f64::max);
        most - CLOSE * most.abs()
    };
    // What leaves more than noise, with derivatives of its own at its own clock as well, is not followed to the end of what it does without what it holds in
    // reserve.
    let free = |(index, fit): &(usize, Fitted)| {
        let has_reserve = fit.set.findings().any(|(h, _)| !h.reserve.is_empty());
        let is_noise = remainder(problem, fit).is_ok_and(|left| left.is_noise());
        let fit = match is_noise || !has_reserve {
            true => fit.clone(),
            false => noise_alone(problem, fit, here).unwrap_or_else(|| relaxed(problem, fit.clone(), many)),
        };
        (*index, fit)
    };
    let mut to_the_end = |(index, fit): (usize, Fitted)| {
        let fit = to_the_end(problem, fit);
        let of: &mut Tried = &mut tried[index];
        of.set.clone_from(&fit.set);
        (of.scores[1], of.criteria[1]) = (fit.score, criterion(&fit, many));
        fit
    };
    let by_criterion = |a: &Fitted, b: &Fitted| criterion(a, many).total_cmp(&criterion(b, many));
    let least = close(&worthy);
    let freed: Vec<(usize, Fitted)> = worthy.iter().filter(|(_, fit)| gain(fit) >= least).map(free).collect();
    let least = close(&freed);
    let best = freed.into_iter().filter(|(_, fit)| gain(fit) >= least).map(&mut to_the_end).min_by(by_criterion)?;
    // What bears most of the missing force goes before what is likelier and leaves most of it.
    let power = |fit: &Fitted| problem.power(fit) / here;
    let most = worthy.iter().min_by(|a, b| power(&a.1).total_cmp(&power(&b.1)));
    if let Some(bears) = most.filter(|(_, fit)| power(fit) < BEARS[0] && power(&best) > BEARS[1]) {
        return Some((to_the_end(free(bears)), Some(best)));
    }
    let effects = |fit: &Fitted| fit.set.findings().count();
    let smaller = worthy.into_iter().map(|(_, fit)| fit).filter(|fit| effects(fit) < effects(&best));
    let smaller = smaller.min_by(by_criterion);
    Some((best, smaller))
}

/// A fit that leaves so little (`here`: of how much) that noise alone may be left at the clock of what it is, followed there, where that is so.
fn noise_alone(problem: &Problem<'_>, fit: &Fitted, here: f64) -> Option<Fitted> {
    if problem.power(fit) > UNHEARD * here {
        return None;
    }
    let heard = problem.clone().heard_by(&fit.set).ok()?;
    let begun = heard.reheard(problem, fit).ok()?;
    let ended = heard.fit(begun.as_ref().unwrap_or(fit), fit.set.clone(), END).ok()?;
    remainder(&heard, &ended).ok().filter(Remainder::is_noise)?;
    if begun.is_some() { problem.onto(&ended).ok() } else { Some(ended) }
}

/// Share of the missing force that a right law may leave at the clock of the nominal model.
const UNHEARD: f64 = 1e-4;
/// Shares of the missing force that are left by what bears most of it, and by what bears little.
const BEARS: [f64; 2] = [0.1, 0.5];

/// A set that is worth a fit.
#[derive(Clone)]
struct Proposal {
    /// Entries of the pool, and coordinates to begin with.
    members: Vec<(usize, Vec<f64>)>,
    /// How far the numbers that are fitted already go with them; empty where that is not known.
    beside: Vec<f64>,
    /// −2 log likelihood that is promised.
    score: f64,
    /// Spread to begin with.
    spread: Spread,
    /// Whether it led astray before, and is begun near what changes nothing.
    is_again: bool,
}

/// The sets that are worth a fit: those that promise most by the criterion, of the chain and of the missing force, smaller ones first. What adds to a
/// set that brought next to nothing of what it promised promises nothing.
fn proposals(looked: &Looked, now: &Fitted, refuted: &[Vec<String>]) -> Vec<Proposal> {
    let pool = &looked.pool;
    let is_open = |members: &[(usize, Vec<f64>)]| {
        let own = pool.titles(members.iter().map(|m| m.0));
        !refuted.iter().any(|known| known.iter().all(|t| own.contains(t)))
    };
    let sets: Vec<&LinearSet> = looked.grown.sets.iter().filter(|s| is_open(&s.members)).collect();
    let spoken: Vec<&Spoken> = looked.spoken.iter().filter(|s| is_open(&s.members)).collect();
    let most = sets.iter().map(|s| now.score - s.score).fold(0.0, f64::max);
    let loudest = spoken.iter().map(|s| -s.change).fold(0.0, f64::max);
    let titles = |members: &[(usize, Vec<f64>)]| pool.titles(members.iter().map(|m| m.0));
    let by_force = (1..=AT_ONCE).flat_map(|size| {
        let own = spoken.iter().filter(move |s| s.members.len() == size && -s.change >= PROMISING * loudest);
        own.take(if size < AT_ONCE { SPOKEN } else { 1 })
    });
    let by_force = by_force.map(|s| Proposal {
        members: s.members.clone(),
        beside: Vec::new(),
        score: now.score + s.change,
        spread: now.spread.clone(),
        is_again: false,
    });
    let is_worth = |s: &&&LinearSet| now.score - s.score >= PROMISING * most;
    let worth = (1..=AT_ONCE).flat_map(|size| {
        let of_size = move |s: &&&LinearSet| s.members.len() == size;
        sets.iter().filter(is_worth).filter(of_size).take(FITTED)
    });
    let single = sets.iter().find(|s| s.members.len() == 1);
    let by_chain = worth.chain(single).map(|s| Proposal {
        members: s.members.clone(),
        beside: s.beside.clone(),
        score: s.score,
        spread: s.spread.clone(),
        is_again: false,
    });
    let siblings = single.map_or_else(Vec::new, |single| siblings(looked, now, single));
    let mut all: Vec<Proposal> = Vec::new();
    // What the missing force says of a law is nearer to it where no line follows that.
    for proposal in by_force.chain(by_chain).chain(siblings.into_iter().filter(|p| is_open(&p.members))) {
        if !all.iter().any(|known| titles(&known.members) == titles(&proposal.members)) {
            all.push(proposal);
        }
    }
    all.sort_by_key(|p| p.members.len());
    all
}

/// A law alone, as the chain scored it.
fn scored(pool: &Pool, now: &Fitted, s: &Score, spread: &Spread) -> Option<Proposal> {
    let entry = pool.entries.iter().position(|e| e.hypothesis == s.hypothesis && e.point == s.point)?;
    let members = vec![(entry, s.start.clone())];
    let beside = s.beside.clone();
    Some(Proposal { members, beside, score: now.score - s.score, spread: spread.clone(), is_again: false })
}

/// Laws alone that promise anything, the most promising first, a form of each.
fn alone(looked: &Looked, now: &Fitted) -> Vec<Proposal> {
    let pool = &looked.pool;
    let mut titles: Vec<String> = Vec::new();
    let mut is_new = |s: &&Score| {
        let title = pool.hypotheses[s.hypothesis].title();
        let is_new = !titles.contains(&title);
        titles.push(title);
        is_new
    };
    let promising = looked.grown.scores.iter().filter(|s| s.score > 0.0).filter(&mut is_new);
    promising.filter_map(|s| scored(pool, now, s, &now.spread)).take(ALONE).collect()
}

/// The law of a set of one at the other places that promise as much: there it looks much like it.
fn siblings(looked: &Looked, now: &Fitted, single: &LinearSet) -> Vec<Proposal> {
    let Looked { pool, grown, .. } = looked;
    let own = pool.of(single.members[0].0);
    let is_sibling = |s: &&Score| {
        let of = &pool.hypotheses[s.hypothesis];
        of.name == own.name && of.place != own.place && s.score >= PROMISING * (now.score - single.score)
    };
    let proposal = |s: &Score| scored(pool, now, s, &single.spread);
    grown.scores.iter().filter(is_sibling).filter_map(proposal).take(SIBLINGS).collect()
}
