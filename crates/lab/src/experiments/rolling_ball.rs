//! A ball thrown over a plane: it slides until its lowest point rests, then rolls.
//!
//! The friction μ m g points against the slip u = v − R ω × ẑ of the lowest point, and its torque turns with it, so that
//! for a solid ball u̇ = −(7/2) μ g û: its direction stays (Coriolis 1835), and
//!
//!   t* = 2 |u₀|/(7 μ g),   x(t*) = v₀ t* − ½ μ g û₀ t*²,   v(t ≥ t*) = v₀ − (2/7) u₀,   energy lost = m u₀²/7
//!
//! Without spin that is v = (5/7) v₀ after 2 v₀/(7 μ g); with spin about the direction of flight the path is a parabola that
//! ends in a straight line. The contact point lies half a penetration above the plane, 5 µm of 0.1 m here.

use crate::bench::{Bench, Rig};
use crate::scene::{GRAVITY, ball_robot, stiff_contact};
use crate::{Chart, Experiment, Figure, LabError, Options, Outcome};
use contact::Shape;
use sim::{Base, Integrator};
use spatial::{Twist, Vec3};

/// The entry in the catalogue.
pub const EXPERIMENT: Experiment = Experiment {
    name: "rolling-ball",
    question: "When does a sliding ball roll, how fast, how straight, and does it creep?",
    run,
};

const MASS: f64 = 1.0;
const RADIUS: f64 = 0.1;
const MU: f64 = 0.3;
const STIFFNESS: f64 = 1e6;

/// A throw: speed and spin at the start.
#[derive(Clone, Copy, Debug)]
struct Throw {
    v: Vec3,
    omega: Vec3,
}

impl Throw {
    /// Slip of the lowest point at the start, m/s.
    fn slip(&self) -> Vec3 {
        self.v - RADIUS * self.omega.cross(&Vec3::z())
    }

    /// When rolling begins, s.
    fn time(&self) -> f64 {
        2.0 * self.slip().norm() / (7.0 * MU * GRAVITY)
    }

    /// Velocity once it rolls, m/s.
    fn final_velocity(&self) -> Vec3 {
        self.v - 2.0 / 7.0 * self.slip()
    }

    /// Where the ball is at `t`, m.
    fn position(&self, t: f64) -> Vec3 {
        let sliding = t.min(self.time());
        let braked = self.v * sliding - 0.5 * MU * GRAVITY * sliding * sliding * self.slip().normalize();
        braked + self.final_velocity() * (t - sliding)
    }

    /// Energy that friction takes, J.
    fn loss(&self) -> f64 {
        MASS * self.slip().norm_squared() / 7.0
    }
}

fn run(options: &Options) -> Result<Outcome, LabError> {
    let step = options.step.unwrap_or(1e-4);
    let mut outcome = Outcome::default();
    let straight = Throw { v: Vec3::new(1.0, 0.0, 0.0), omega: Vec3::zeros() };
    let hook = Throw { v: Vec3::new(1.0, 0.0, 0.0), omega: Vec3::new(12.0, -3.0, 0.0) };
    let flight = fly(&straight, step, 0.5)?;
    let theory = straight.final_velocity().x;
    outcome.figures.extend([
        Figure::relative("time until it rolls, 2 v₀/(7 μ g)", flight.time, straight.time(), "s", 1e-3),
        Figure::relative("speed once it rolls, 5/7 v₀", flight.velocity.x, theory, "m/s", 1e-4),
        Figure::relative("energy that friction takes, m v₀²/7", flight.loss, straight.loss(), "J", 1e-3),
        Figure::at_most("aside of a straight throw, over the way", flight.place.y / flight.place.x, 1e-12, "1"),
    ]);
    let hooked = fly(&hook, step, 0.5)?;
    let off = (hooked.velocity - hook.final_velocity()).norm();
    outcome.figures.extend([
        Figure::relative("hook: time until it rolls", hooked.time, hook.time(), "s", 1e-3),
        Figure::at_most("hook: velocity off v₀ − 2/7 u₀", off, 1e-4, "m/s"),
        Figure::relative("hook: aside after 0.5 s", hooked.place.y, hook.position(hooked.at).y, "m", 1e-3),
    ]);
    add_rolling(&mut outcome, &straight, step, options)?;
    add_charts(&mut outcome, &[("straight", straight, flight), ("hook", hook, hooked)]);
    outcome.run = record(&hook, step)?;
    Ok(outcome)
}

fn build(throw: &Throw, step: f64, integrator: Integrator) -> Result<Rig, LabError> {
    let mut bench = Bench::new(EXPERIMENT.name, step).gravity([0.0, 0.0, -GRAVITY]).integrator(integrator);
    bench.add_floor();
    let ball = bench.add_vehicle("ball", &ball_robot(MASS, RADIUS), Base::Free);
    bench.add_shape(Some(ball), 0, Shape::Ball { radius: RADIUS });
    bench.pair("floor", "ball", stiff_contact(MU));
    let mut rig = bench.build()?;
    rig.place(ball, [0.0, 0.0, RADIUS - MASS * GRAVITY / STIFFNESS], [0.0; 3]);
    rig.throw(&[Twist::new(throw.omega, throw.v)]);
    Ok(rig)
}

/// Slip of the contact point, m/s; it lies midway between the plane and the ball's lowest point.
fn slip(rig: &Rig) -> Vec3 {
    let twist = rig.world.kinematics(0).vel[0];
    let arm = 0.5 * (rig.position(0).z + RADIUS);
    let slip = twist.lin - arm * twist.ang.cross(&Vec3::z());
    Vec3::new(slip.x, slip.y, 0.0)
}

/// Kinetic energy, J.
fn kinetic(rig: &Rig) -> f64 {
    let twist = rig.world.kinematics(0).vel[0];
    0.5 * MASS * (twist.lin.norm_squared() + 0.4 * RADIUS * RADIUS * twist.ang.norm_squared())
}

/// What a throw showed.
#[derive(Clone, Debug)]
struct Flight {
    time: f64,
    velocity: Vec3,
    place: Vec3,
    at: f64,
    loss: f64,
    path: Vec<(f64, f64)>,
    speed: Vec<(f64, f64)>,
    slip: Vec<(f64, f64)>,
}

/// Throws the ball and follows it for `duration`.
fn fly(throw: &Throw, step: f64, duration: f64) -> Result<Flight, LabError> {
    let mut rig = build(throw, step, Integrator::ImplicitMidpoint)?;
    let (along, start) = (throw.slip().normalize(), kinetic(&rig));
    let mut flight = Flight {
        time: f64::NAN,
        velocity: Vec3::zeros(),
        place: Vec3::zeros(),
        at: 0.0,
        loss: 0.0,
        path: Vec::new(),
        speed: Vec::new(),
        slip: Vec::new(),
    };
    let mut last = throw.slip().norm();
    while rig.time() < duration {
        rig.advance()?;
        let now = slip(&rig).dot(&along);
        if flight.time.is_nan() && now <= 0.0 {
            flight.time = rig.time() - step * now / (now - last);
        }
        last = now;
        let place = rig.position(0);
        flight.path.push((place.x, place.y));
        flight.speed.push((rig.time(), rig.velocity(0).norm()));
        flight.slip.push((rig.time(), now));
    }
    (flight.velocity, flight.place, flight.at) = (rig.velocity(0), rig.position(0), rig.time());
    flight.loss = start - kinetic(&rig);
    Ok(flight)
}

/// Thrown in rolling it goes on rolling once its depth has settled: nothing is lost, nothing pulls, nothing slips but what a
/// step's finite turn makes of rolling, (h ω)²/6 of the speed.
fn add_rolling(outcome: &mut Outcome, throw: &Throw, step: f64, options: &Options) -> Result<(), LabError> {
    let (v, step) = (throw.final_velocity(), 10.0 * step);
    let rolling = Throw { v, omega: Vec3::z().cross(&v) / RADIUS };
    let duration = if options.quick { 2.0 } else { 20.0 };
    for (name, integrator) in
        [("implicit Euler", Integrator::ImplicitEuler), ("implicit midpoint", Integrator::ImplicitMidpoint)]
    {
        let mut rig = build(&rolling, step, integrator)?;
        rig.run((0.5 / step) as u64, |_| {})?;
        let (start, mut slipped, mut pull) = (rig.velocity(0).x, 0.0, 0.0_f64);
        while rig.time() < duration + 0.5 {
            rig.advance()?;
            slipped += slip(&rig).x * step / duration;
            pull = pull.max(rig.friction_force().norm());
        }
        let lost = 1.0 - rig.velocity(0).x / start;
        let finite_turn = (step * start / RADIUS).powi(2) / 6.0;
        let name = format!("rolling for {duration} s, {name} at {:.0e} s", step);
        outcome.figures.extend([
            Figure::at_most(format!("{name}: speed lost"), lost, 1e-11, "1"),
            Figure::at_most(format!("{name}: largest friction force"), pull, 1e-8, "N"),
            Figure::at_most(format!("{name}: slip over speed"), slipped / start, finite_turn, "1"),
        ]);
    }
    Ok(())
}

fn add_charts(outcome: &mut Outcome, throws: &[(&str, Throw, Flight)]) {
    let thin = |points: &[(f64, f64)]| points.iter().copied().step_by(25).collect::<Vec<_>>();
    let mut path = Chart { equal_scales: true, ..Chart::new("Path of the ball, 0.5 s", "x, m", "y, m") };
    let mut speed = Chart::new("Speed and slip", "time, s", "m/s");
    for (name, throw, flight) in throws {
        let times = (0..=100).map(|k| 0.005 * f64::from(k));
        let exact: Vec<_> = times.map(|t| throw.position(t)).map(|p| (p.x, p.y)).collect();
        path = path.theory(format!("{name}, closed form"), exact).line(*name, thin(&flight.path));
        speed = speed
            .line(format!("speed, {name}"), thin(&flight.speed))
            .line(format!("slip, {name}"), thin(&flight.slip))
            .marks(format!("5/7 of it, {name}"), vec![(throw.time(), throw.final_velocity().norm())]);
    }
    outcome.charts.extend([path, speed]);
}

fn record(throw: &Throw, step: f64) -> Result<Option<(record::Log, record::Scene)>, LabError> {
    let mut rig = build(throw, step, Integrator::ImplicitMidpoint)?;
    let mut film = rig.film((0.005 / step).ceil() as u64);
    film.shoot(&rig.world);
    while rig.time() < 0.5 {
        rig.advance()?;
        film.shoot(&rig.world);
    }
    film.develop(&rig)
}
