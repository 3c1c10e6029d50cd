//! The same projections from this library's algorithms, each with the sum of its terms' magnitudes as its size.

use crate::state::Draw;
use multibody::{
    Accelerations, Drive, Dynamics, Kinematics, Tree, add_gravity, calc_centroidal_momentum, calc_kinetic_energy,
    calc_potential_energy,
};
use spatial::nalgebra::{DMatrix, DVector};
use spatial::{Twist, Vec3, Wrench};

/// A projection and the sum of the magnitudes of its terms.
#[derive(Clone, Copy)]
pub struct Projection {
    pub value: f64,
    pub size: f64,
}

impl Projection {
    fn of(terms: impl Iterator<Item = f64>) -> Self {
        terms.fold(Self { value: 0.0, size: 0.0 }, |p, t| Self { value: p.value + t, size: p.size + t.abs() })
    }

    fn weighted(weights: &[f64], values: &[f64]) -> Self {
        Self::of(weights.iter().zip(values).map(|(w, v)| w * v))
    }
}

/// One robot in one state.
pub struct Ours<'a> {
    tree: &'a Tree,
    draw: Draw<'a>,
    gravity: Vec3,
    base_free: bool,
    kin: Kinematics,
    dynamics: Dynamics,
    v: Vec<f64>,
    weight: Vec<Wrench>,
}

impl<'a> Ours<'a> {
    pub fn new(tree: &'a Tree, draw: Draw<'a>, gravity: Vec3, base_free: bool) -> Self {
        let (mut kin, v) = (Kinematics::new(tree), draw.signed("v"));
        kin.update_positions(tree, &draw.pose(), &draw.q());
        kin.update_velocities(tree, &twist(&v), &v[6..]);
        let mut weight = vec![Wrench::default(); tree.bodies.len()];
        add_gravity(&kin, &gravity, &mut weight);
        Self { tree, draw, gravity, base_free, kin, dynamics: Dynamics::new(tree), v, weight }
    }

    pub fn placement(&self, link: &str) -> Projection {
        let frame = self.kin.link_frame(self.tree, self.tree.link(link).unwrap());
        let entries: Vec<f64> = frame.pos.iter().chain(frame.rot.iter()).copied().collect();
        Projection::weighted(&self.draw.weights("placement", link, 12), &entries)
    }

    pub fn velocity(&self, link: &str) -> Projection {
        let twist = self.kin.link_twist(self.tree, self.tree.link(link).unwrap());
        Projection::weighted(&self.draw.weights("velocity", link, 6), &entries(&twist))
    }

    /// A global column by its name in the index.
    pub fn column(&mut self, name: &str, links: &[String]) -> Projection {
        let (what, part) = name.split_once('.').unwrap_or((name, ""));
        match what {
            "jacobian" | "jacobian_rate" | "bias" => self.jacobian(what, links),
            "rnea" => {
                let tau = self.calc_inverse(&self.draw.signed("a"));
                self.freedoms(what, part, &tau, "effort")
            }
            "aba" => {
                let a = self.calc_forward();
                self.freedoms(what, part, &a, "acceleration")
            }
            "mass" => self.mass(part),
            "com" | "linear" | "angular" => self.centroidal(what),
            "total" => Projection::of(self.tree.bodies.iter().map(|b| b.inertia.mass)),
            "kinetic" => Projection::of(std::iter::once(calc_kinetic_energy(&self.kin))),
            "potential" => self.potential(),
            _ => panic!("the index has a column {name:?} that this test does not know"),
        }
    }

    fn jacobian(&self, what: &str, links: &[String]) -> Projection {
        let name = &links[self.draw.stream("link", "jacobian").below(links.len())];
        let link = self.tree.link(name).unwrap();
        let (body, point) = (self.tree.links[link].body, self.kin.link_frame(self.tree, link).pos);
        let mut columns = vec![Twist::default(); 6 + self.tree.nv];
        let x = if what == "bias" { self.v.clone() } else { self.draw.freedom_weights("jacobian.x") };
        let w = self.draw.weights(what, "", 6);
        self.kin.calc_jacobian(self.tree, body, &point, &mut columns);
        let of_position = project_columns(&columns, &x, &w);
        if what == "jacobian" {
            return of_position;
        }
        self.kin.calc_jacobian_rate(self.tree, body, &point, &mut columns);
        let mut of_rate = project_columns(&columns, &x, &w);
        // J̇ may vanish (a base link's does); its natural size is J times the rates, which are near 1 rad/s.
        of_rate.size += of_position.size;
        of_rate
    }

    /// Generalised force (F_B, τ) of the acceleration (α, classical, v̇), against gravity.
    fn calc_inverse(&mut self, a: &[f64]) -> Vec<f64> {
        let base = twist(&self.v);
        let spatial = Twist::new(twist(a).ang, twist(a).lin - base.ang.cross(&base.lin));
        let motion = Accelerations { base: spatial, v: &self.v[6..], v_dot: &a[6..] };
        let mut tau = vec![0.0; self.tree.nv];
        let wrench = self.dynamics.calc_inverse(self.tree, &self.kin, &motion, &self.weight, &mut tau);
        wrench.moment.iter().chain(wrench.force.iter()).chain(&tau).copied().collect()
    }

    /// Acceleration (α, classical, v̇) of the drawn efforts.
    fn calc_forward(&mut self) -> Vec<f64> {
        let tau: Vec<f64> = self.draw.signed("tau").iter().zip(self.draw.sizes("effort")).map(|(t, e)| t * e).collect();
        if self.tree.has_mimic() {
            return self.solve_forward(&tau);
        }
        let mut external = self.weight.clone();
        external[0] += Wrench::new(twist(&tau).ang, twist(&tau).lin);
        let mut v_dot = vec![0.0; self.tree.nv];
        let drive = Drive { v: &self.v[6..], tau: &tau[6..], external: &external, base_free: self.base_free };
        let a = self.dynamics.calc_forward(self.tree, &self.kin, &drive, &mut v_dot).unwrap();
        let base = twist(&self.v);
        let classical = if self.base_free { a.lin + base.ang.cross(&base.lin) } else { a.lin };
        a.ang.iter().chain(classical.iter()).chain(&v_dot).copied().collect()
    }

    /// M a = τ − RNEA(0): the way round mimic joints.
    fn solve_forward(&mut self, tau: &[f64]) -> Vec<f64> {
        let held = if self.base_free { 0 } else { 6 };
        let bias = self.calc_inverse(&vec![0.0; 6 + self.tree.nv]);
        let free = self.calc_mass_matrix().view_range(held.., held..).into_owned();
        let force = DVector::from_iterator(tau.len() - held, tau.iter().zip(&bias).skip(held).map(|(t, b)| t - b));
        let a = free.cholesky().unwrap().solve(&force);
        std::iter::repeat_n(0.0, held).chain(a.iter().copied()).collect()
    }

    fn calc_mass_matrix(&mut self) -> DMatrix<f64> {
        let n = 6 + self.tree.nv;
        let mut m = vec![0.0; n * n];
        self.dynamics.calc_mass_matrix(self.tree, &self.kin, &[], &mut m, n);
        DMatrix::from_row_slice(n, n, &m)
    }

    fn freedoms(&self, what: &str, part: &str, values: &[f64], size: &str) -> Projection {
        let (weights, sizes) = (self.draw.freedom_weights(what), self.draw.sizes(size));
        let range = if part == "base" { 0..6 } else { 6..values.len() };
        Projection::of(range.map(|i| weights[i] * values[i] / sizes[i]))
    }

    fn mass(&mut self, block: &str) -> Projection {
        let m = self.calc_mass_matrix();
        let (x, y) = (self.draw.freedom_weights("mass.x"), self.draw.freedom_weights("mass.y"));
        let (sizes, n) = (self.draw.sizes("mass"), m.nrows());
        let (rows, columns) = match block {
            "bb" => (0..6, 0..6),
            "bj" => (0..6, 6..n),
            _ => (6..n, 6..n),
        };
        let term = |(i, j): (usize, usize)| y[i] / sizes[i] * m[(i, j)] * x[j] / sizes[j];
        Projection::of(rows.flat_map(|i| columns.clone().map(move |j| (i, j))).map(term))
    }

    fn centroidal(&self, what: &str) -> Projection {
        let (com, momentum) = calc_centroidal_momentum(&self.kin);
        let vector = match what {
            "com" => com,
            "linear" => momentum.force,
            _ => momentum.moment,
        };
        let mut projection = Projection::weighted(&self.draw.weights(what, "", 3), vector.as_slice());
        if what == "linear" {
            // It may vanish (the bodies of a wheel turn about their centres); its natural size is that of its terms.
            let terms = |(i, v): (&spatial::Inertia, &Twist)| i.mass * v.lin.norm() + v.ang.norm() * i.mc.norm();
            projection.size += self.kin.inertia.iter().zip(&self.kin.vel).map(terms).sum::<f64>();
        }
        projection
    }

    /// Sized by the bodies' own energies, which may cancel.
    fn potential(&self) -> Projection {
        let own = |i: &spatial::Inertia| self.gravity.dot(&(i.mc + i.mass * self.kin.anchor)).abs();
        let size = self.kin.inertia.iter().map(own).sum();
        Projection { value: calc_potential_energy(&self.kin, &self.gravity), size }
    }
}

/// Σ w (J x).
fn project_columns(columns: &[Twist], x: &[f64], w: &[f64]) -> Projection {
    let terms = columns.iter().zip(x).flat_map(|(c, x)| entries(c).map(|e| e * x));
    Projection::of(terms.zip(w.iter().cycle()).map(|(t, w)| t * w))
}

/// The first six of a vector over the freedoms, as a twist.
fn twist(v: &[f64]) -> Twist {
    Twist::new(Vec3::new(v[0], v[1], v[2]), Vec3::new(v[3], v[4], v[5]))
}

fn entries(t: &Twist) -> [f64; 6] {
    [t.ang.x, t.ang.y, t.ang.z, t.lin.x, t.lin.y, t.lin.z]
}
