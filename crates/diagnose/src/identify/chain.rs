//! A run as a chain of linear intervals: states and unknown forces eliminated, numbers left.
//!
//! Interval i, about the states that are believed at present, with θ the numbers and y = (θ, 1):
//!
//!   ρᵢ = Sᵢ δsᵢ + Fᵢ fᵢ + Yᵢ y,        Yᵢ = (∂r/∂θ, r)           residuals, units of noise
//!   δsᵢ₊₁ = Aᵢ δsᵢ + Bᵢ fᵢ + Dᵢ y,      Dᵢ = (∂end/∂θ, defect)    continuity
//!   fᵢ ~ N(0, diag qᵢ²),   δs₀ ~ N(0, L₀ L₀ᵀ)
//!
//! With δsᵢ = mᵢ y + Lᵢ ξ, fᵢ = q φ and ζ = (ξ, φ) ~ N(0, 1) one interval costs a least-squares problem with a unit prior (square-root covariance
//! filter: Kaminski, Bryson and Schmidt 1971; sensitivities carried along: Gupta and Mehra 1974):
//!
//!   H = (S L, F q),  V = Y + S m,  N = 1 + HᵀH = C Cᵀ,   K += VᵀV − (HᵀV)ᵀ N⁻¹ HᵀV,   log|R| += log|N|
//!   m⁺ = A m + D − T N⁻¹ HᵀV,   L⁺ L⁺ᵀ = T N⁻¹ Tᵀ,   T = (A L, B q)
//!
//! yᵀ K y is then the least that states and forces leave of the cost: −2 log of the marginal likelihood but for log|R|. N is never less than one, so
//! that neither exact continuity (q = 0) nor a state that nothing shows needs a special case. Backwards the adjoint g = ∂cost/∂s gives the smoothed states,
//!
//!   ζ̂ = −N⁻¹ (HᵀV y + Tᵀ g⁺),   g = Sᵀ ρ + Aᵀ g⁺,
//!
//! and the information Λ of what comes later the covariance of ζ (two-filter form: Fraser and Potter 1969). All of this asks for products of the columns
//! (S, F, Y) alone, channel by channel, so that the samples are read once and the noise of a channel can still be another.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use std::borrow::Borrow;

/// One interval: products of its columns, and how it goes on.
#[derive(Clone, Debug)]
pub struct Node {
    /// Channels and what each tells.
    pub parts: Vec<(u16, Part)>,
    /// Products of (S, F, Y) over the residuals of all channels.
    pub all: DMatrix<f64>,
    /// ∂end/∂s.
    pub a: DMatrix<f64>,
    /// ∂end/∂f.
    pub b: DMatrix<f64>,
    /// ∂end/∂θ, and last what the end exceeds the next interval's state by.
    pub d: DMatrix<f64>,
}

/// What one channel tells in an interval, whichever is smaller.
#[derive(Clone, Debug)]
pub enum Part {
    /// Rows of (S, F, Y).
    Rows(DMatrix<f64>),
    /// Their products.
    Products(DMatrix<f64>),
}

impl Part {
    fn new(rows: DMatrix<f64>) -> Self {
        if rows.nrows() < rows.ncols() { Self::Rows(rows) } else { Self::Products(rows.transpose() * rows) }
    }

    /// Adds so many times the products to a sum.
    fn add_to(&self, sum: &mut DMatrix<f64>, weight: f64) {
        match self {
            Self::Rows(rows) => sum.gemm(weight, &rows.transpose(), rows, 1.0),
            Self::Products(products) => sum.zip_apply(products, |s, p| *s += weight * p),
        }
    }

    /// Expected square of the residuals at (δs, f, y), of which the first coordinates are known but for a covariance.
    fn square(&self, at: &DVector<f64>, doubt: &DMatrix<f64>) -> f64 {
        let n = doubt.nrows();
        match self {
            Self::Rows(rows) => {
                let own = rows.columns(0, n);
                (rows * at).norm_squared() + (own * doubt).dot(&own)
            }
            Self::Products(products) => {
                at.dot(&(products * at)) + products.view((0, 0), (n, n)).component_mul(doubt).sum()
            }
        }
    }
}

/// What may vary beside the numbers.
#[derive(Clone, Copy, Debug)]
pub struct Prior<'a> {
    /// Standard deviation of the first state, by coordinate.
    pub start: &'a DVector<f64>,
    /// Standard deviation of the unknown force of every interval, by coordinate.
    pub force: &'a [DVector<f64>],
    /// Factor of the noise of every interval, by channel.
    pub noise: &'a [DVector<f64>],
}

/// A run with its states and forces eliminated.
#[derive(Clone, Debug)]
pub struct Marginal {
    /// K: products of the numbers' columns and the residual.
    pub gram: DMatrix<f64>,
    /// log|R|, the price of what forces and states may be.
    pub log_det: f64,
}

/// States and forces of a run when the numbers are given.
#[derive(Clone, Debug, Default)]
pub struct Smoothed {
    /// Change of each state.
    pub states: Vec<DVector<f64>>,
    /// Force of each interval.
    pub forces: Vec<DVector<f64>>,
    /// Variance of each force.
    pub variances: Vec<DVector<f64>>,
    /// Channels and expected squares of their residuals, units of the noise as it was given; by interval.
    pub squares: Vec<Vec<(u16, f64)>>,
}

/// A run with its states and forces eliminated, and what it takes to find them.
#[derive(Debug)]
pub struct Filtered {
    /// What is left of it.
    pub marginal: Marginal,
    seen: Vec<Seen>,
}

/// One interval as the filter has seen it.
#[derive(Debug)]
struct Seen {
    /// Products over all channels.
    gram: DMatrix<f64>,
    /// HᵀH.
    information: DMatrix<f64>,
    /// Standard deviation of its force.
    force: DVector<f64>,
    n: Cholesky<f64, Dyn>,
    /// HᵀV.
    hv: DMatrix<f64>,
    t: DMatrix<f64>,
    l: DMatrix<f64>,
    m: DMatrix<f64>,
}

/// Runs the filter and hands every interval to `look`.
fn filter<N: Borrow<Node>>(
    nodes: impl IntoIterator<Item = N>,
    prior: Prior<'_>,
    mut look: impl FnMut(Seen),
) -> Marginal {
    let mut nodes = nodes.into_iter().peekable();
    let width = nodes.peek().map_or(1, |n| n.borrow().d.ncols());
    let n_x = prior.start.len();
    let n_u = nodes.peek().map_or(n_x, |n| n_x + n.borrow().b.ncols());
    let mut l = DMatrix::from_diagonal(prior.start);
    let mut m = DMatrix::zeros(n_x, width);
    // What is the sum of a product and its transpose: the product.
    let [mut total, mut crossed] = [(); 2].map(|()| DMatrix::zeros(width, width));
    let mut log_det = 0.0;
    for ((node, noise), force) in nodes.zip(prior.noise).zip(prior.force) {
        let node = node.borrow();
        let gram = node.weighted(noise);
        let (zz, zy) = (gram.view((0, 0), (n_u, n_u)), gram.view((0, n_u), (n_u, width)));
        let (zs, sy) = (zz.columns(0, n_x), zy.rows(0, n_x));
        let information = rooted(&rooted(&zz.into_owned(), &l, force).transpose(), &l, force);
        let n = with_unit(&information);
        let hv = rooted(&(zy + zs * &m), &l, force);
        let half_v = half(&n, hv.clone());
        crossed.gemm(1.0, &m.transpose(), &(sy + 0.5 * (zs.rows(0, n_x) * &m)), 1.0);
        total += gram.view((n_u, n_u), (width, width));
        total.gemm(-1.0, &half_v.transpose(), &half_v, 1.0);
        log_det += 2.0 * n.l_dirty().diagonal().iter().map(|c| c.ln()).sum::<f64>();
        let t = beside(&(&node.a * &l), &scaled(&node.b, force));
        let half_t = half(&n, t.transpose());
        let mut next_m = &node.a * &m + &node.d;
        next_m.gemm(-1.0, &half_t.transpose(), &half_v, 1.0);
        let next_l = root(half_t);
        look(Seen { gram, information, force: force.clone(), n, hv, t, l, m });
        (l, m) = (next_l, next_m);
    }
    Marginal { gram: total + &crossed + crossed.transpose(), log_det }
}

impl Node {
    /// An interval by the rows of each channel, and how it goes on.
    pub fn new(rows: Vec<(u16, DMatrix<f64>)>, [a, b, d]: [DMatrix<f64>; 3]) -> Self {
        let side = b.ncols() + a.ncols() + d.ncols();
        let parts: Vec<(u16, Part)> = rows.into_iter().map(|(channel, rows)| (channel, Part::new(rows))).collect();
        let mut all = DMatrix::zeros(side, side);
        parts.iter().for_each(|(_, part)| part.add_to(&mut all, 1.0));
        Self { parts, all, a, b, d }
    }

    /// The same of channels whose noise is as it is known.
    pub fn summed(all: DMatrix<f64>, [a, b, d]: [DMatrix<f64>; 3]) -> Self {
        Self { parts: Vec::new(), all, a, b, d }
    }

    /// Products over all channels, each over the factor of its noise: most have none.
    fn weighted(&self, noise: &DVector<f64>) -> DMatrix<f64> {
        let factor = |channel: &u16| noise[*channel as usize];
        // What is next to nothing is not told as a difference.
        if self.parts.iter().any(|(channel, _)| factor(channel) > LOUD) {
            let mut sum = DMatrix::zeros(self.all.nrows(), self.all.ncols());
            self.parts.iter().for_each(|(channel, part)| part.add_to(&mut sum, factor(channel).powi(-2)));
            return sum;
        }
        let mut sum = self.all.clone();
        for (channel, part) in self.parts.iter().filter(|(channel, _)| factor(channel) != 1.0) {
            part.add_to(&mut sum, factor(channel).powi(-2) - 1.0);
        }
        sum
    }
}

/// Factor of a channel's noise from which on its part is no small change of all.
const LOUD: f64 = 10.0;

/// Eliminates states and forces of a run, whose intervals may be made one after the other.
pub fn eliminate<N: Borrow<Node>>(nodes: impl IntoIterator<Item = N>, prior: Prior<'_>) -> Marginal {
    filter(nodes, prior, |_| ())
}

/// The same with all that it takes to find them.
pub fn filtered(nodes: &[Node], prior: Prior<'_>) -> Filtered {
    let mut seen = Vec::with_capacity(nodes.len());
    let marginal = filter(nodes, prior, |s| seen.push(s));
    Filtered { marginal, seen }
}

/// States and forces of a run at `theta`.
pub fn smooth(nodes: &[Node], filtered: &Filtered, theta: &DVector<f64>) -> Smoothed {
    let Filtered { seen, .. } = filtered;
    let y = theta.push(1.0);
    let n_x = nodes.first().map_or(0, |n| n.a.ncols());
    let n_f = nodes.first().map_or(0, |n| n.b.ncols());
    let n_u = n_x + n_f;
    let mut gradient = DVector::zeros(n_x);
    let mut later = DMatrix::zeros(n_x, n_x);
    let mut out = Smoothed::default();
    for (node, seen) in nodes.iter().zip(seen).rev() {
        let zeta = -seen.n.solve(&(&seen.hv * &y + seen.t.tr_mul(&gradient)));
        let (xi, phi) = (zeta.rows(0, n_x), zeta.rows(n_x, n_f));
        let state = &seen.m * &y + &seen.l * xi;
        let force = phi.component_mul(&seen.force);
        let all = DVector::from_iterator(n_u + y.len(), state.iter().chain(&force).chain(&y).copied());
        gradient = seen.gram.rows(0, n_x) * &all + node.a.tr_mul(&gradient);
        let known = with_unit(&(&seen.information + seen.t.transpose() * (&later * &seen.t)));
        let covariance = known.inverse();
        let spread = covariance.diagonal().rows(n_x, n_f).into_owned();
        let doubt = spread_of(&covariance, &seen.l, &seen.force);
        let square = |(channel, part): &(u16, Part)| (*channel, part.square(&all, &doubt));
        out.squares.push(node.parts.iter().map(square).collect());
        out.variances.push(spread.component_mul(&seen.force).component_mul(&seen.force));
        out.states.push(state);
        out.forces.push(force);
        later = told_by(node, seen, &later);
    }
    out.states.reverse();
    out.forces.reverse();
    out.variances.reverse();
    out.squares.reverse();
    out
}

/// Covariance of (δs, f) from that of ζ.
fn spread_of(covariance: &DMatrix<f64>, l: &DMatrix<f64>, force: &DVector<f64>) -> DMatrix<f64> {
    let n_x = l.nrows();
    let mut half = covariance.clone();
    half.rows_mut(0, n_x).copy_from(&(l * covariance.rows(0, n_x)));
    force.iter().enumerate().for_each(|(j, q)| half.row_mut(n_x + j).scale_mut(*q));
    let mut out = half.clone();
    out.columns_mut(0, n_x).copy_from(&(half.columns(0, n_x) * l.transpose()));
    force.iter().enumerate().for_each(|(j, q)| out.column_mut(n_x + j).scale_mut(*q));
    out
}

/// Information about the state at the begin of an interval by what it and all later ones measure, its force eliminated.
fn told_by(node: &Node, Seen { gram, force, .. }: &Seen, later: &DMatrix<f64>) -> DMatrix<f64> {
    let (n_x, n_f) = (node.a.ncols(), force.len());
    let b = scaled(&node.b, force);
    let (la, lb) = (later * &node.a, later * &b);
    let ss = gram.view((0, 0), (n_x, n_x)) + node.a.transpose() * la;
    let sf = scaled(&gram.view((0, n_x), (n_x, n_f)).into_owned(), force) + node.a.transpose() * &lb;
    let own = scaled(&gram.view((n_x, n_x), (n_f, n_f)).into_owned(), force).transpose();
    let ff = with_unit(&(scaled(&own, force) + b.transpose() * lb));
    let information = ss - &sf * ff.solve(&sf.transpose());
    0.5 * (&information + information.transpose())
}

/// One step of the filter about a state that is believed as it is: what an interval says of its own state and of the next one's.
#[derive(Clone, Debug)]
pub struct Update {
    /// Change of the interval's state.
    pub state: DVector<f64>,
    /// Its force.
    pub force: DVector<f64>,
    /// Root of the covariance of the end.
    pub root: DMatrix<f64>,
}

/// The update by one interval without numbers, its noise that which it was given, from a root of the covariance of its state.
pub fn update(node: &Node, l: &DMatrix<f64>, force: &DVector<f64>) -> Update {
    let n_u = node.a.ncols() + node.b.ncols();
    let gram = &node.all;
    let zz = gram.view((0, 0), (n_u, n_u)).into_owned();
    let n = with_unit(&rooted(&rooted(&zz, l, force).transpose(), l, force));
    let hv = rooted(&gram.view((0, n_u), (n_u, 1)).into_owned(), l, force);
    let zeta = -n.solve(&hv).column(0);
    let t = beside(&(&node.a * l), &scaled(&node.b, force));
    let (xi, phi) = (zeta.rows(0, l.ncols()), zeta.rows(l.ncols(), force.len()));
    Update { state: l * xi, force: phi.component_mul(force), root: root(half(&n, t.transpose())) }
}

/// 1 + X, factored; X is not negative but for round-off, which is scaled away where it counts.
fn with_unit(x: &DMatrix<f64>) -> Cholesky<f64, Dyn> {
    let mut x = 0.5 * (x + x.transpose());
    let floor = ROUND_OFF * x.diagonal().amax();
    (0..x.nrows()).for_each(|i| x[(i, i)] += 1.0);
    if let Some(c) = Cholesky::new(x.clone()) {
        return c;
    }
    (0..x.nrows()).for_each(|i| x[(i, i)] += floor);
    let diagonal = x.diagonal().map(|d| if d.is_finite() { d.abs().max(1.0) } else { 1.0 });
    Cholesky::new(x).unwrap_or_else(|| Cholesky::pack_dirty(DMatrix::from_diagonal(&diagonal.map(f64::sqrt))))
}

/// Share of the largest of some products that round-off leaves of the smallest.
const ROUND_OFF: f64 = 1e-12;

/// C⁻¹ X, of which X N⁻¹ X is the square.
fn half(n: &Cholesky<f64, Dyn>, mut x: DMatrix<f64>) -> DMatrix<f64> {
    n.l_dirty().solve_lower_triangular_mut(&mut x);
    x
}

/// A root of T N⁻¹ Tᵀ with as many columns as rows, from C⁻¹ Tᵀ.
fn root(half: DMatrix<f64>) -> DMatrix<f64> {
    if half.nrows() < half.ncols() {
        let rows = half.ncols();
        return half.transpose().resize_horizontally(rows, 0.0);
    }
    half.qr().r().transpose()
}

/// diag(Lᵀ, q) X.
fn rooted(x: &DMatrix<f64>, l: &DMatrix<f64>, force: &DVector<f64>) -> DMatrix<f64> {
    let n_x = l.nrows();
    let mut out = x.clone();
    out.rows_mut(0, n_x).copy_from(&(l.transpose() * x.rows(0, n_x)));
    force.iter().enumerate().for_each(|(j, q)| out.row_mut(n_x + j).scale_mut(*q));
    out
}

fn beside(a: &DMatrix<f64>, b: &DMatrix<f64>) -> DMatrix<f64> {
    let mut both = DMatrix::zeros(a.nrows(), a.ncols() + b.ncols());
    both.columns_mut(0, a.ncols()).copy_from(a);
    both.columns_mut(a.ncols(), b.ncols()).copy_from(b);
    both
}

fn scaled(a: &DMatrix<f64>, by: &DVector<f64>) -> DMatrix<f64> {
    let mut out = a.clone();
    out.column_iter_mut().zip(by.iter()).for_each(|(mut column, s)| column *= *s);
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    const STATES: usize = 2;
    const FORCES: usize = 1;
    const NUMBERS: usize = 2;
    const SAMPLES: usize = 3;
    const INTERVALS: usize = 4;

    /// One interval, sample by sample: (S, F, Y) and the node of it.
    fn interval(dice: &mut ChaCha8Rng) -> (DMatrix<f64>, Node) {
        let mut draw = |rows, columns| {
            DMatrix::from_fn(rows, columns, |_, _| f64::from(dice.next_u32()) / f64::from(u32::MAX) - 0.5)
        };
        let rows = draw(SAMPLES, STATES + FORCES + NUMBERS + 1);
        let (a, b, d) = (draw(STATES, STATES), draw(STATES, FORCES), draw(STATES, NUMBERS + 1));
        let parts = vec![(0, rows.rows(0, 1).into_owned()), (1, rows.rows(1, SAMPLES - 1).into_owned())];
        (rows, Node::new(parts, [a, b, d]))
    }

    /// The same problem with all unknowns at once: ρ = J z + Y y with z of unit variance; by sample over the factor of its noise.
    struct Dense {
        j: DMatrix<f64>,
        y: DMatrix<f64>,
    }

    impl Dense {
        fn new(all: &[(DMatrix<f64>, Node)], prior: Prior<'_>) -> Self {
            let unknowns = STATES + INTERVALS * FORCES;
            let mut state = DMatrix::zeros(STATES, unknowns);
            (0..STATES).for_each(|k| state[(k, k)] = prior.start[k]);
            let mut offset = DMatrix::zeros(STATES, NUMBERS + 1);
            let (mut j, mut y) = (DMatrix::zeros(0, unknowns), DMatrix::zeros(0, NUMBERS + 1));
            for (i, (rows, node)) in all.iter().enumerate() {
                let mut force = DMatrix::zeros(FORCES, unknowns);
                force[(0, STATES + i)] = prior.force[i][0];
                let s = rows.columns(0, STATES);
                let mut own_j = s * &state + rows.columns(STATES, FORCES) * &force;
                let mut own_y = rows.columns(STATES + FORCES, NUMBERS + 1) + s * &offset;
                for k in 0..SAMPLES {
                    let factor = prior.noise[i][usize::from(k > 0)];
                    own_j.row_mut(k).unscale_mut(factor);
                    own_y.row_mut(k).unscale_mut(factor);
                }
                j = DMatrix::from_fn(j.nrows() + SAMPLES, unknowns, |r, c| {
                    if r < j.nrows() { j[(r, c)] } else { own_j[(r - j.nrows(), c)] }
                });
                y = DMatrix::from_fn(y.nrows() + SAMPLES, NUMBERS + 1, |r, c| {
                    if r < y.nrows() { y[(r, c)] } else { own_y[(r - y.nrows(), c)] }
                });
                offset = &node.a * offset + &node.d;
                state = &node.a * state + &node.b * force;
            }
            Self { j, y }
        }
    }

    fn problem() -> Vec<(DMatrix<f64>, Node)> {
        let mut dice = ChaCha8Rng::seed_from_u64(3);
        (0..INTERVALS).map(|_| interval(&mut dice)).collect()
    }

    fn with_prior(check: impl Fn(Prior<'_>)) {
        let start = DVector::from_vec(vec![2.0, 0.5]);
        let force: Vec<_> = (0..INTERVALS).map(|i| DVector::from_element(1, 0.7 + 0.2 * i as f64)).collect();
        let noise: Vec<_> = (0..INTERVALS).map(|i| DVector::from_vec(vec![1.0, 1.5 + i as f64])).collect();
        check(Prior { start: &start, force: &force, noise: &noise });
    }

    #[test]
    fn a_chain_is_the_least_squares_problem_of_all_unknowns_at_once() {
        let all = problem();
        let nodes: Vec<Node> = all.iter().map(|a| a.1.clone()).collect();
        with_prior(|prior| {
            let Dense { j, y } = Dense::new(&all, prior);
            let r = DMatrix::identity(j.nrows(), j.nrows()) + &j * j.transpose();
            let gram = y.tr_mul(&(r.clone().try_inverse().expect("it is positive") * &y));
            let found = eliminate(&nodes, prior);
            assert!((&found.gram - &gram).amax() < 1e-12 * gram.amax(), "{} {gram}", found.gram);
            assert!((found.log_det - r.determinant().ln()).abs() < 1e-12);
        });
    }

    #[test]
    fn smoothed_forces_and_their_variances_are_those_of_the_posterior() {
        let all = problem();
        let nodes: Vec<Node> = all.iter().map(|a| a.1.clone()).collect();
        let theta = DVector::from_vec(vec![0.3, -0.8]);
        with_prior(|prior| {
            let Dense { j, y } = Dense::new(&all, prior);
            let information = DMatrix::identity(j.ncols(), j.ncols()) + j.tr_mul(&j);
            let covariance = information.try_inverse().expect("it is positive");
            let z = -(&covariance * j.tr_mul(&(&y * theta.push(1.0))));
            let found = smooth(&nodes, &filtered(&nodes, prior), &theta);
            for i in 0..INTERVALS {
                let q = prior.force[i][0];
                assert!((found.forces[i][0] - q * z[STATES + i]).abs() < 1e-12);
                assert!((found.variances[i][0] - q * q * covariance[(STATES + i, STATES + i)]).abs() < 1e-12);
            }
            (0..STATES).for_each(|k| assert!((found.states[0][k] - prior.start[k] * z[k]).abs() < 1e-12));
            // Expected squares of the residuals, channel by channel, units of the noise as given.
            let residual = &j * &z + &y * theta.push(1.0);
            let spread = &j * &covariance * j.transpose();
            let all: f64 = (0..residual.len()).map(|i| residual[i].powi(2) + spread[(i, i)]).sum();
            let over = |(own, noise): (&Vec<(u16, f64)>, &DVector<f64>)| -> f64 {
                own.iter().map(|(c, s)| s / noise[*c as usize].powi(2)).sum()
            };
            let told: f64 = found.squares.iter().zip(prior.noise).map(over).sum();
            assert!((all - told).abs() < 1e-10, "{all} {told}");
        });
    }

    #[test]
    fn without_forces_a_chain_is_one_free_run() {
        let nodes: Vec<Node> = problem().into_iter().map(|a| a.1).collect();
        let (start, none) = (DVector::from_vec(vec![2.0, 0.5]), vec![DVector::zeros(FORCES); nodes.len()]);
        let noise = vec![DVector::from_element(2, 1.0); nodes.len()];
        let prior = Prior { start: &start, force: &none, noise: &noise };
        let found = smooth(&nodes, &filtered(&nodes, prior), &DVector::zeros(NUMBERS));
        for i in 1..INTERVALS {
            let next = &nodes[i - 1].a * &found.states[i - 1] + nodes[i - 1].d.column(NUMBERS);
            assert!((&next - &found.states[i]).amax() < 1e-12, "it is continuous");
        }
    }
}
