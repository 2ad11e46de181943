//! Ensembles: many trajectories of systems that `#[rayleigh_system]` generates, in parallel, each of them bit
//! by bit the one that `system.by(method, h).run(start)` makes.
//!
//! A **member** is a system and a start, a function of its number and of nothing else. So any member can be
//! computed anywhere, alone or among others, once or again, and is the same.
//!
//! ```
//! use dalembert::{Splitting, State, rayleigh_system};
//! use dalembert_ensemble::Ensemble;
//! use rand::{RngExt, SeedableRng};
//! use rand_chacha::ChaCha8Rng;
//!
//! #[rayleigh_system(rule = trapezoidal)]
//! fn ring(q: [f64; 2], v: [f64; 2], r: f64) -> (f64, f64) {
//!     let s = q[0] * q[0] + q[1] * q[1];
//!     let speed = v[0] * v[0] + v[1] * v[1];
//!     (0.5 * speed - s * (s - 1.0) * (s - 1.0), 0.5 * r * speed)
//! }
//!
//! let members = |number| {
//!     // One stream of random numbers for each member.
//!     let mut random = ChaCha8Rng::seed_from_u64(1);
//!     random.set_stream(number);
//!     let system = Ring { r: random.random_range(0.01..0.1) };
//!     let start = State::from_velocity(&system, [0.0, 1.2], [random.random_range(-0.5..0.5), 0.0])?;
//!     Ok((system, start))
//! };
//! let ensemble = Ensemble::new(members).by(Splitting::blanes_moan_6(), 0.1).steps(100);
//!
//! let ends = ensemble.ends(0..1000)?;
//! assert!(ends.iter().all(Result::is_ok));
//!
//! // Member 700, alone, and as a trajectory.
//! assert_eq!(ensemble.ends(700..701)?[0], ends[700]);
//! let (system, start) = members(700)?;
//! let mut run = dalembert::Discretise::by(&system, Splitting::blanes_moan_6(), 0.1).run(start);
//! assert_eq!(run.nth(99).unwrap()?.state, ends[700].unwrap().state);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! **What is kept** is said each time: the [`ends`](Study::ends), a reduction to numbers of one's own
//! ([`reduce`](Study::reduce)), or files (feature `parquet`: `parts`). Nothing else is: memory does not grow
//! with the number of members, but for what is asked to be kept of each. A reduction holds at most 16 384
//! members a thread, each with its system, start and value; files hold two parts besides.
//!
//! **A member that fails** stands in the result as a [`Failure`], with its error and its last good state; the
//! others go on.
//!
//! **Lanes.** A system whose attribute says `lanes = explicit`, `lanes = midpoint`, or `lanes = gauss` for
//! Gauss rules, is stepped many members at a time by [`in_lanes`](Study::in_lanes), in the widest
//! instructions of the machine, chosen when the program runs. Products and sums are rounded as they are
//! alone: that changes no bit either. The lane of a member that is done is given to the next.
//!
//! **Events.** The run of each member may be watched for events, and ended by them, one by one or in lanes:
//! [`watch`](Study::watch).
//!
//! **Inputs and time.** A view is a member as well, in lanes too; each member has an input and a time of its
//! own:
//!
//! ```
//! use dalembert::{Splitting, State, rayleigh_system};
//! use dalembert_ensemble::Ensemble;
//! use rand::{RngExt, SeedableRng};
//! use rand_chacha::ChaCha8Rng;
//!
//! struct Arm {
//!     friction: f64,
//! }
//!
//! #[rayleigh_system(rule = trapezoidal, lanes = explicit)]
//! impl Arm {
//!     fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
//!         0.5 * v[0] * v[0] + q[0].cos()
//!     }
//!
//!     fn rayleigh(&self, v: [f64; 1]) -> f64 {
//!         0.5 * self.friction * v[0] * v[0]
//!     }
//!
//!     fn force(&self, _q: [f64; 1], _v: [f64; 1], torque: [f64; 1]) -> [f64; 1] {
//!         torque
//!     }
//! }
//!
//! // One arm under 10 000 torques.
//! let torque = |number| {
//!     let mut random = ChaCha8Rng::seed_from_u64(1);
//!     random.set_stream(number);
//!     [random.random_range(-0.5..0.5)]
//! };
//! let (arm, rest) = (Arm { friction: 1.0 }, State { q: [0.0].into(), p: [0.0].into() });
//! let study = Ensemble::new(|number| Ok((arm.driven(torque(number)), rest)))
//!     .by(Splitting::blanes_moan_6(), 0.2)
//!     .steps(200)
//!     .in_lanes();
//! for (number, end) in (0..).zip(study.ends(0..10_000)?) {
//!     let [torque] = torque(number);
//!     assert!((end.unwrap().state.q[0] - torque.asin()).abs() < 1e-6);
//! }
//!
//! // Arms of their own as well: a view borrows its arm, so that they are made before.
//! let arms: Vec<Arm> = (0..100).map(|k| Arm { friction: 0.5 + 0.01 * f64::from(k) }).collect();
//! let study = Ensemble::new(|number| Ok((arms[number as usize].driven(torque(number)), rest)))
//!     .by(Splitting::blanes_moan_6(), 0.2)
//!     .steps(200);
//! assert!(study.ends(0..100)?.iter().all(Result::is_ok));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! An input that is held through the whole run may as well be a field of the system.
//!
//! **Threads** are rayon's: all cores, or those of the pool that a study is run in
//! (`ThreadPool::install`). How many there are changes no bit.

mod lanes;
mod member;
#[cfg(feature = "parquet")]
pub mod parts;
mod progress;
mod stepping;
mod study;
mod watched;

pub use lanes::SideBySide;
pub use member::{End, Failure, MemberError, Record};
pub use progress::{Cancelled, Progress};
pub use stepping::{OneByOne, Plan, Slot, Stepping, ToError, one_by_one};
pub use study::{Ends, Ensemble, Outcome, Study};
pub use watched::{OfOneSize, Watched};
