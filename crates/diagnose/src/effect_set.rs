//! Sets of effects with the values of their coordinates: what is fitted, and what a search takes in and puts out.

use crate::hypothesis::{Hypothesis, Tier};
use nalgebra::DMatrix;
use scenario::spec::Effect;

/// Effects with the values of their coordinates.
#[derive(Clone, Debug, Default)]
pub struct EffectSet {
    /// Hypotheses and where in their coordinates they stand.
    pub members: Vec<(Hypothesis, Vec<f64>)>,
    /// Coordinates that are not fitted because the data say nothing about them: member and coordinate.
    pub held: Vec<(usize, usize)>,
}

impl EffectSet {
    /// Whether the same effect at the same place is among its findings.
    pub fn has_finding(&self, wanted: &Hypothesis) -> bool {
        self.findings().any(|(h, _)| h.title() == wanted.title())
    }

    /// A hypothesis that may act beside it: none of its findings, and of the numbers that have a tolerance one that stands at its end.
    pub fn still_open(&self, h: Hypothesis) -> Option<Hypothesis> {
        match self.members.iter().find(|(m, _)| m.title() == h.title()) {
            None => Some(h),
            Some((m, x)) if m.is_tolerated() && m.is_at_bound(x) => Some(h.screened_beside(x)),
            Some(_) => None,
        }
    }

    /// The `[[effect]]` entries.
    pub fn effects(&self) -> Vec<Effect> {
        self.members.iter().map(|(h, x)| h.effect(x)).collect()
    }

    /// Member and coordinate of every fitted number.
    pub fn slots(&self) -> Vec<(usize, usize)> {
        let all = self.members.iter().enumerate().flat_map(|(m, (h, _))| (0..h.coordinates.len()).map(move |k| (m, k)));
        all.filter(|slot| !self.held.contains(slot)).collect()
    }

    /// Whether its last member corrects a nominal number.
    pub fn ends_with_correction(&self) -> bool {
        self.members.last().is_some_and(|(h, _)| h.tier == Tier::Nominal && !h.is_tolerated())
    }

    /// Members that are findings: not those that only move within their tolerances.
    pub fn findings(&self) -> impl Iterator<Item = &(Hypothesis, Vec<f64>)> {
        self.members.iter().filter(|(h, _)| !h.is_tolerated())
    }

    /// What each member is and where.
    pub fn titles(&self) -> Vec<String> {
        self.members.iter().map(|(h, _)| h.title()).collect()
    }

    /// Whether it says anything beyond tolerances.
    pub fn has_findings(&self) -> bool {
        self.findings().next().is_some()
    }

    /// The members within tolerances alone.
    pub fn tolerated(&self) -> Self {
        self.only(Hypothesis::is_tolerated)
    }

    /// The findings alone.
    pub fn without_tolerated(&self) -> Self {
        self.only(|h| !h.is_tolerated())
    }

    /// Its members of a kind.
    fn only(&self, wanted: impl Fn(&Hypothesis) -> bool) -> Self {
        let others = (0..self.members.len()).rev().filter(|m| !wanted(&self.members[*m].0));
        others.fold(self.clone(), |set, m| set.without(m))
    }

    /// Mean and inverse variance of a fitted coordinate's prior, where it has one: its tolerance, or how far an effect's number may be expected.
    pub(crate) fn prior(&self, (m, k): (usize, usize)) -> Option<(f64, f64)> {
        let h = &self.members[m].0;
        let coordinate = &h.coordinates[k];
        let sigma = if h.is_tolerated() { h.tolerance[k] } else { coordinate.spread };
        (sigma > 0.0 && sigma.is_finite()).then(|| (coordinate.neutral, 1.0 / (sigma * sigma)))
    }

    /// Where the fitted numbers that have a tolerance stand, in standard deviations from their nominal values.
    pub fn within_tolerances(&self) -> Vec<f64> {
        let off = |slot: (usize, usize)| {
            let (mean, weight) = self.prior(slot).filter(|_| self.members[slot.0].0.is_tolerated())?;
            Some((self.members[slot.0].1[slot.1] - mean) * weight.sqrt())
        };
        self.slots().into_iter().filter_map(off).collect()
    }

    /// What the prior adds to the cost: Σ ((x − x₀)/σ)².
    pub fn prior_cost(&self) -> f64 {
        let slots = self.members.iter().enumerate().flat_map(|(m, (_, x))| (0..x.len()).map(move |k| (m, k)));
        slots
            .filter_map(|s| self.prior(s).map(|(mean, weight)| weight * (self.members[s.0].1[s.1] - mean).powi(2)))
            .sum()
    }

    /// Adds the prior's curvature and slope to products over (active numbers, …, residual), the first of which are the fitted numbers.
    pub(crate) fn add_prior(&self, k: &mut DMatrix<f64>) {
        let last = k.ncols() - 1;
        for (i, slot) in self.slots().into_iter().enumerate() {
            let Some((mean, weight)) = self.prior(slot) else { continue };
            k[(i, i)] += weight;
            let slope = weight * (self.members[slot.0].1[slot.1] - mean);
            k[(i, last)] += slope;
            k[(last, i)] += slope;
        }
    }

    /// The set with one more, which takes the place of the same number within its tolerance.
    pub fn with(&self, hypothesis: &Hypothesis, x: &[f64]) -> Self {
        let is_same = |(h, _): &(Hypothesis, Vec<f64>)| h.is_tolerated() && h.title() == hypothesis.title();
        let mut set = match self.members.iter().position(is_same) {
            Some(at) => self.without(at),
            None => self.clone(),
        };
        set.held.extend(hypothesis.held.iter().map(|k| (set.members.len(), *k)));
        set.members.push((hypothesis.clone(), x.to_vec()));
        set
    }

    /// The set without one.
    pub fn without(&self, member: usize) -> Self {
        let mut set = Self::default();
        for (i, m) in self.members.iter().enumerate().filter(|(i, _)| *i != member) {
            set.held.extend(self.held.iter().filter(|h| h.0 == i).map(|h| (set.members.len(), h.1)));
            set.members.push(m.clone());
        }
        set
    }

    /// The set with a law in the place of one of its members; where that law is in it already it goes to where it would begin.
    pub fn instead(&self, member: usize, plain: &Hypothesis, x: &[f64]) -> Self {
        let mut set = self.without(member);
        let is_same = |(h, _): &(Hypothesis, Vec<f64>)| !h.is_tolerated() && h.title() == plain.title();
        let Some((own, at)) = set.members.iter_mut().find(|m| is_same(m)) else { return set.with(plain, x) };
        if x.len() == at.len() {
            *at = own.clamped(x);
        }
        set
    }

    /// The set with all free that its members hold in reserve, where it leads astray, from each end of that; none where they hold nothing.
    pub fn released(&self) -> Vec<Self> {
        if self.members.iter().all(|(h, _)| h.reserve.is_empty()) {
            return Vec::new();
        }
        let mut free = vec![self.clone(); 2];
        for (at, (h, x)) in self.members.iter().enumerate() {
            for (set, released) in free.iter_mut().zip(h.relaxed_afar(x).into_iter().flatten()) {
                set.held.retain(|(m, k)| *m != at || released.0.held.contains(k));
                set.members[at] = released;
            }
        }
        free
    }

    /// The set with every number held.
    pub fn frozen(&self) -> Self {
        Self { held: self.slots().into_iter().chain(self.held.iter().copied()).collect(), ..self.clone() }
    }

    /// The same members a share of the way here from where another set has them, or from where they change nothing.
    pub(crate) fn a_share_of_the_way(&self, from: &Self, share: f64) -> Self {
        let mut set = self.clone();
        for (h, x) in &mut set.members {
            let known = from.members.iter().find(|(of, known)| of.title() == h.title() && known.len() == x.len());
            let begin = known.map_or_else(|| h.neutral(), |(_, known)| known.clone());
            for (x, begin) in x.iter_mut().zip(begin).filter(|(_, b)| b.is_finite()) {
                *x = begin + share * (*x - begin);
            }
        }
        set
    }

    pub(crate) fn moved(&self, slots: &[(usize, usize)], by: &[f64]) -> Self {
        let mut set = self.clone();
        for ((m, k), d) in slots.iter().zip(by) {
            set.members[*m].1[*k] += d;
        }
        for (h, x) in &mut set.members {
            *x = h.clamped(x);
        }
        set
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::hypotheses;
    use crate::facts::Facts;

    #[test]
    fn friction_that_leads_astray_may_creep_and_what_has_nothing_in_reserve_stays() {
        let all = hypotheses(&Facts::of_joints(1));
        let of = |name: &str| all.iter().find(|h| h.name == name).expect("it is in the library");
        let (dry, viscous) = (of("joint-coulomb-friction"), of("joint-viscous-friction"));
        let plain = EffectSet::default().with(viscous, &viscous.neutral());
        assert!(plain.released().is_empty());
        let set = plain.with(dry, &dry.neutral());
        assert_eq!(set.slots(), [(0, 0), (1, 0)], "its level alone is fitted");
        let free = set.released();
        assert_eq!(free.len(), 2, "it has a reach and a rate in reserve, which begin at either end");
        assert!(free.iter().all(|set| set.slots() == [(0, 0), (1, 0), (1, 1), (1, 2)]));
        let near = dry.relaxed(&dry.neutral()).expect("so it has").1;
        let [smooth, stiff] = [0, 1].map(|way| &free[way].members[1].1);
        assert!(0.0 < near[2] && near[2] < smooth[2] && stiff[2] < smooth[2], "smoothest where it creeps fastest");
        assert!(stiff[1] < smooth[1], "stiffest where it yields least");
    }

    #[test]
    fn what_is_held_goes_with_its_member() {
        let all = hypotheses(&Facts::of_joints(1));
        let of = |name: &str| all.iter().find(|h| h.name == name).expect("it is in the library");
        let (dry, viscous) = (of("joint-coulomb-friction"), of("joint-viscous-friction"));
        let mut number = viscous.clone();
        number.tolerance = vec![0.1; number.coordinates.len()];
        let set = EffectSet::default().with(&number, &number.neutral()).with(dry, &dry.neutral());
        assert_eq!(set.held, [(1, 1), (1, 2)]);
        let alone = set.without_tolerated();
        assert_eq!((alone.titles(), &alone.held[..]), (vec![dry.title()], &[(0, 1), (0, 2)][..]));
        assert_eq!(set.tolerated().titles(), [viscous.title()]);
    }

    #[test]
    fn a_law_takes_another_ones_place_once_even_where_it_was_there_before() {
        let all = hypotheses(&Facts::of_joints(1));
        let of = |name: &str| all.iter().find(|h| h.name == name).expect("it is in the library");
        let (plain, rich, beside) =
            (of("joint-coulomb-friction"), of("joint-stribeck-friction"), of("joint-viscous-friction"));
        let at = |h: &Hypothesis, first: f64| [&[first], &h.neutral()[1..]].concat();
        let two = EffectSet::default().with(rich, &at(rich, 0.9)).with(beside, &beside.neutral());
        let alone = two.instead(0, plain, &at(plain, 0.7));
        assert_eq!(alone.titles(), [beside.title(), plain.title()]);
        let three = EffectSet::default().with(plain, &at(plain, 0.2)).with(rich, &at(rich, 0.9));
        let one = three.instead(1, plain, &at(plain, 0.7));
        assert_eq!(one.titles(), [plain.title()]);
        assert_eq!(one.members[0].1[0], 0.7, "it begins where the richer law stood");
    }
}
