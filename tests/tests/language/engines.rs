//! The two engines of derivatives agree: the same systems, once with derivatives written out and once with
//! num-dual.

/// The systems, with the engine named.
macro_rules! systems {
    ($engine:ident) => {
        use dalembert::rayleigh_system;

        /// The ring potential with drag.
        pub struct Ring {
            pub k: f64,
        }

        #[rayleigh_system(rule = [midpoint, trapezoidal], derivatives = $engine)]
        impl Ring {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let s = q[0] * q[0] + q[1] * q[1];
                0.5 * (v[0] * v[0] + v[1] * v[1]) - s * (s - 1.0).powi(2)
            }

            fn rayleigh(&self, v: [f64; 2]) -> f64 {
                0.5 * self.k * (v[0] * v[0] + v[1] * v[1])
            }
        }

        /// The double pendulum, with friction in its joints.
        pub struct DoublePendulum {
            pub m: [f64; 2],
            pub l: [f64; 2],
            pub g: f64,
            pub c: [f64; 2],
        }

        #[rayleigh_system(rule = [midpoint, trapezoidal], derivatives = $engine)]
        impl DoublePendulum {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let [m1, m2] = self.m;
                let [l1, l2] = self.l;
                let kinetic = 0.5 * (m1 + m2) * l1 * l1 * v[0] * v[0]
                    + 0.5 * m2 * l2 * l2 * v[1] * v[1]
                    + m2 * l1 * l2 * (q[0] - q[1]).cos() * v[0] * v[1];
                let potential = -(m1 + m2) * self.g * l1 * q[0].cos() - m2 * self.g * l2 * q[1].cos();
                kinetic - potential
            }

            fn rayleigh(&self, v: [f64; 2]) -> f64 {
                let relative = v[1] - v[0];
                0.5 * self.c[0] * v[0] * v[0] + 0.5 * self.c[1] * relative * relative
            }
        }

        /// The Fermi–Pasta–Ulam–Tsingou β-chain of eight masses between walls.
        pub struct Chain {
            pub beta: f64,
            pub drag: f64,
        }

        #[rayleigh_system(rule = [midpoint, trapezoidal], derivatives = $engine)]
        impl Chain {
            const N: usize = 8;

            fn lagrangian(&self, q: [f64; Self::N], v: [f64; Self::N]) -> f64 {
                let kinetic = 0.5 * v.iter().map(|v| v * v).sum::<f64>();
                let mut potential = self.spring(q[0]) + self.spring(-q[Self::N - 1]);
                for i in 1..q.len() {
                    potential += self.spring(q[i] - q[i - 1]);
                }
                kinetic - potential
            }

            fn rayleigh(&self, v: [f64; Self::N]) -> f64 {
                0.5 * self.drag * v.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).sum::<f64>()
            }

            /// Energy of a spring.
            fn spring(&self, d: f64) -> f64 {
                let square = d * d;
                0.5 * square + 0.25 * self.beta * square * square
            }
        }

        /// Everything at once: `if`, early return, `abs`, `sqrt`, helpers, loops, a force, R that depends on
        /// q.
        pub struct Medley {
            pub stiff: bool,
            pub weights: [f64; 3],
            pub order: i32,
        }

        #[rayleigh_system(rule = [midpoint, trapezoidal], derivatives = $engine)]
        impl Medley {
            fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
                let mut kinetic = 0.0;
                for (i, v) in v.iter().enumerate() {
                    kinetic += 0.5 * (self.weights[i] + 0.1 * (i as f64) + q[i].sin().powi(2)) * v * v;
                }
                kinetic - self.wall(q[0]) - Self::bowl(q) - if self.stiff { q[2].powi(4) } else { 0.0 }
            }

            fn rayleigh(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
                let near = (-(q[0] * q[0])).exp();
                near * v.iter().fold(0.0, |sum, v| sum + v * v)
                    + self.order as f64 * v[2].powi(2).sqrt().powi(3)
            }

            fn force(&self, q: [f64; 3], v: [f64; 3]) -> [f64; 3] {
                let spin = v[0] * q[1] - v[1] * q[0];
                [-q[1] * spin, q[0] * spin, (q[2] - q[0]).abs().min(2.0)]
            }

            /// A soft wall.
            fn wall(&self, x: f64) -> f64 {
                if x > 0.0 {
                    return 0.0;
                }
                (1.0 + x * x).sqrt() - 1.0
            }

            /// Elementary functions of all coordinates.
            fn bowl(q: [f64; 3]) -> f64 {
                let square = |x: f64| x * x;
                let depth: f64 = q.iter().zip(1..4).map(|(q, i)| square(*q) / f64::from(i)).sum();
                (1.0 + depth).ln() + q[0].hypot(1.0 + q[1] * q[1]) + q[2].atan2(2.0 + q[1])
            }
        }

        /// In single precision.
        #[rayleigh_system(rule = [midpoint, trapezoidal], derivatives = $engine)]
        pub fn single(q: [f32; 2], v: [f32; 2], m: f32, k: [f32; 2]) -> (f32, f32) {
            let potential = k[0] * (1.0 - q[0].cos()) + 0.1 * k[1] * q[1] * q[1] * (q[0] - q[1]);
            (0.5 * m * (v[0] * v[0] + (1.0 + q[0] * q[0]) * v[1] * v[1]) - potential, 0.3 * v[0] * v[0])
        }

        /// Its gradient and Hessian are finite also where x ≤ 0, and 0 there.
        #[rayleigh_system(derivatives = $engine)]
        pub fn half_line(q: [f64; 1], v: [f64; 1]) -> f64 {
            let x = q[0] * v[0];
            0.5 * v[0] * v[0] + if x > 0.0 { x.sqrt() } else { 0.0 }
        }
    };
}

/// Derivatives written out.
mod expanded {
    systems!(expanded);
}

/// Derivatives by num-dual.
mod num_dual {
    systems!(num_dual);
}

use dalembert::nalgebra::{SMatrix, SVector};
use dalembert::step::{DiscreteRayleigh, NewtonMatrix, Segment};
use dalembert::system::{Derivatives, Direction, Scalar};
use dalembert::{Discretise, Force, Lagrangian, Midpoint, State, Trapezoidal};

/// The largest difference seen, in units of the tolerance of `at`.
struct Difference {
    unit: f64,
    largest: f64,
}

impl Difference {
    fn vectors<S: Scalar, const R: usize, const C: usize>(
        &mut self,
        a: &SMatrix<S, R, C>,
        b: &SMatrix<S, R, C>,
    ) {
        let scale = 1.0 + a.iter().chain(b.iter()).fold(0.0_f64, |scale, x| scale.max(x.widen().abs()));
        for (a, b) in a.iter().zip(b.iter()) {
            let difference = (a.widen() - b.widen()).abs() / (scale * self.unit);
            // A NaN counts as far off.
            self.largest = if difference <= self.largest { self.largest } else { difference };
            assert!(!difference.is_nan(), "NaN");
        }
    }

    fn numbers<S: Scalar>(&mut self, a: S, b: S) {
        self.vectors(&SVector::<S, 1>::new(a), &SVector::<S, 1>::new(b));
    }

    fn derivatives<S: Scalar, const N: usize>(&mut self, a: &Derivatives<S, N>, b: &Derivatives<S, N>) {
        self.numbers(a.value, b.value);
        self.vectors(&a.d1, &b.d1);
        self.vectors(&a.d2, &b.d2);
        self.vectors(&a.d11, &b.d11);
        self.vectors(&a.d12, &b.d12);
        self.vectors(&a.d22, &b.d22);
    }
}

/// Points spread over [−1, 1], the same for every run.
fn points<S: Scalar, const N: usize>() -> impl Iterator<Item = (SVector<S, N>, SVector<S, N>)> {
    (0..40_u32).map(|k| {
        let spread = |i: usize, shift: f64| {
            let phase = f64::from(k) * 0.754_877_666 + i as f64 * 0.569_840_291 + shift;
            S::constant(2.0 * phase.fract() - 1.0)
        };
        (SVector::from_fn(|i, _| spread(i, 0.1)), SVector::from_fn(|i, _| spread(i, 0.4)))
    })
}

/// Compares all that the traits offer for L and for the discrete system of rule `R`.
fn compare<A, B, R, const N: usize>(a: &A, b: &B) -> f64
where
    A: DiscreteRayleigh<R, N>,
    B: DiscreteRayleigh<R, N, Scalar = A::Scalar>,
{
    let mut difference = Difference { unit: 64.0 * A::Scalar::EPSILON.widen(), largest: 0.0 };
    let constant = A::Scalar::constant;
    let h = constant(0.15);
    let minus = Direction { first: constant(-0.3), second: constant(1.1) };
    let plus = Direction { first: constant(0.2), second: constant(0.7) };
    for (q, v) in points::<A::Scalar, N>() {
        difference.derivatives(&a.lagrangian_derivatives(&q, &v), &b.lagrangian_derivatives(&q, &v));
        difference.derivatives(&a.rayleigh_derivatives(&q, &v), &b.rayleigh_derivatives(&q, &v));
        let (la, lb) = (a.lagrangian_gradient(&q, &v), b.lagrangian_gradient(&q, &v));
        difference.numbers(la.value, lb.value);
        difference.vectors(&la.d1, &lb.d1);
        difference.vectors(&la.d2, &lb.d2);
        let (ra, rb) = (a.rayleigh_gradient(&q, &v), b.rayleigh_gradient(&q, &v));
        difference.vectors(&ra.d1, &rb.d1);
        difference.vectors(&ra.d2, &rb.d2);
        for (va, vb) in [
            (a.lagrangian_variations(&q, &v, minus, plus), b.lagrangian_variations(&q, &v, minus, plus)),
            (a.rayleigh_variations(&q, &v, minus, plus), b.rayleigh_variations(&q, &v, minus, plus)),
        ] {
            difference.vectors(&va.minus, &vb.minus);
            difference.vectors(&va.plus, &vb.plus);
            difference.vectors(&va.mixed, &vb.mixed);
        }
        let (ka, kb) = (a.step_kernel(&Segment { q0: q, v, h }), b.step_kernel(&Segment { q0: q, v, h }));
        difference.vectors(&ka.p0, &kb.p0);
        difference.vectors(&ka.matrix.dense(), &kb.matrix.dense());
        let (ma, mb) = (a.momenta(&Segment { q0: q, v, h }), b.momenta(&Segment { q0: q, v, h }));
        difference.vectors(&ma.p0, &mb.p0);
        difference.vectors(&ma.p1, &mb.p1);
        let q1 = q + v * h;
        difference.derivatives(
            &a.discrete_lagrangian_derivatives(&Segment::between(&q, &q1, h)),
            &b.discrete_lagrangian_derivatives(&Segment::between(&q, &q1, h)),
        );
        let (fa, fb) = (
            a.discrete_force(&Segment::between(&q, &q1, h)),
            b.discrete_force(&Segment::between(&q, &q1, h)),
        );
        difference.vectors(&fa.minus, &fb.minus);
        difference.vectors(&fa.plus, &fb.plus);
    }
    difference.largest
}

/// Both rules.
macro_rules! agree {
    ($system:ident { $($fields:tt)* }, $n:literal) => {
        let (a, b) = (expanded::$system { $($fields)* }, num_dual::$system { $($fields)* });
        let midpoint = compare::<_, _, Midpoint, $n>(&a, &b);
        let trapezoidal = compare::<_, _, Trapezoidal, $n>(&a, &b);
        assert!(midpoint <= 1.0, "midpoint: {midpoint} times the tolerance");
        assert!(trapezoidal <= 1.0, "trapezoidal: {trapezoidal} times the tolerance");
    };
}

#[test]
fn ring() {
    agree!(Ring { k: 0.3 }, 2);
}

#[test]
fn double_pendulum() {
    agree!(DoublePendulum { m: [1.0, 0.7], l: [1.0, 0.8], g: 9.81, c: [0.05, 0.03] }, 2);
}

#[test]
fn chain() {
    agree!(Chain { beta: 0.7, drag: 0.02 }, 8);
}

#[test]
fn medley() {
    agree!(Medley { stiff: true, weights: [1.0, 0.6, 2.0], order: 2 }, 3);
    agree!(Medley { stiff: false, weights: [1.0, 0.6, 2.0], order: 1 }, 3);
}

#[test]
fn single_precision() {
    agree!(Single { m: 1.3, k: [0.7, 1.1] }, 2);
}

/// The control: parameters that differ by one part in 10⁹ are told apart.
#[test]
fn a_small_difference_is_seen() {
    let (a, b) = (expanded::Ring { k: 0.3 }, num_dual::Ring { k: 0.3 * (1.0 + 1e-9) });
    let difference = compare::<_, _, Midpoint, 2>(&a, &b);
    assert!(difference > 1.0, "{difference}");
}

#[test]
fn force_has_the_same_derivatives() {
    let (a, b) = (
        expanded::Medley { stiff: true, weights: [1.0, 0.6, 2.0], order: 2 },
        num_dual::Medley { stiff: true, weights: [1.0, 0.6, 2.0], order: 2 },
    );
    let mut difference = Difference { unit: 64.0 * f64::EPSILON, largest: 0.0 };
    let direction = Direction { first: 0.4, second: -1.2 };
    for (q, v) in points::<f64, 3>() {
        let (fa, fb) = (a.force_derivatives(&q, &v), b.force_derivatives(&q, &v));
        difference.vectors(&fa.value, &fb.value);
        difference.vectors(&fa.d1, &fb.d1);
        difference.vectors(&fa.d2, &fb.d2);
        let ((va, ma), (vb, mb)) =
            (a.force_variation(&q, &v, direction), b.force_variation(&q, &v, direction));
        difference.vectors(&va, &vb);
        difference.vectors(&ma, &mb);
    }
    assert!(difference.largest <= 1.0, "{}", difference.largest);
}

#[test]
fn a_rejected_branch_leaves_no_trace_in_either_engine() {
    let (a, b) = (expanded::HalfLine {}, num_dual::HalfLine {});
    for q in [0.0, -0.5] {
        let (q, v) = (SVector::from([q]), SVector::from([0.25]));
        for l in [a.lagrangian_derivatives(&q, &v), b.lagrangian_derivatives(&q, &v)] {
            assert_eq!((l.value, l.d1[0], l.d2[0]), (0.5 * 0.25 * 0.25, 0.0, 0.25));
            assert_eq!((l.d11[0], l.d12[0], l.d22[0]), (0.0, 0.0, 1.0));
        }
    }
}

#[test]
fn trajectories_stay_together() {
    let (a, b) = (
        expanded::DoublePendulum { m: [1.0, 0.7], l: [1.0, 0.8], g: 9.81, c: [0.05, 0.03] },
        num_dual::DoublePendulum { m: [1.0, 0.7], l: [1.0, 0.8], g: 9.81, c: [0.05, 0.03] },
    );
    let mut state_a = State::from_velocity(&a, [0.8, -0.4], [0.0, 0.5]).unwrap();
    let mut state_b = State::from_velocity(&b, [0.8, -0.4], [0.0, 0.5]).unwrap();
    for _ in 0..200 {
        state_a = a.by(Midpoint, 0.01).step(&state_a).unwrap().state;
        state_b = b.by(Midpoint, 0.01).step(&state_b).unwrap().state;
    }
    assert!((state_a.q - state_b.q).amax() < 1e-12, "{} and {}", state_a.q, state_b.q);
}

/// Or-patterns that bind, by each engine.
macro_rules! cases_by_each_engine {
    ($($name:ident by $engine:ident of $scalar:ident),*) => {$(
        mod $name {
            pub enum Law {
                Linear($scalar),
                Cubic { k: $scalar },
                A($scalar),
                Off,
            }

            pub struct Spring {
                pub law: Law,
                pub k: ($scalar, $scalar),
            }

            #[dalembert::rayleigh_system(derivatives = $engine)]
            impl Spring {
                fn lagrangian(&self, q: [$scalar; 1], v: [$scalar; 1]) -> $scalar {
                    let k = match self.law {
                        Law::Linear(k) | Law::Cubic { k } => k,
                        Law::A(k) => 2.0 * k,
                        Law::Off => 0.0,
                    };
                    let x = match (q[0] > 0.0, v[0] > 0.0, self.k) {
                        (true, _, (x, _)) | (_, true, (_, x)) => x,
                        _ => 1.0,
                    };
                    0.5 * v[0] * v[0] - 0.5 * k * x * q[0] * q[0]
                }
            }

            pub fn springs() -> [Spring; 4] {
                [Law::Linear(0.5), Law::Cubic { k: 1.5 }, Law::A(0.75), Law::Off]
                    .map(|law| Spring { law, k: (3.0, 5.0) })
            }
        }
    )*};
}
cases_by_each_engine!(
    cases_auto by auto of f64,
    cases_expanded by expanded of f64,
    cases_num_dual by num_dual of f64,
    cases_single by expanded of f32
);

#[test]
fn cases_that_bind_are_those_of_every_engine() {
    macro_rules! check {
        ($($name:ident),*) => {$(
            for (q, v, x) in [(0.5, -1.0, 3.0), (-0.5, 1.0, 5.0), (-0.5, -1.0, 1.0)] {
                for (spring, k) in $name::springs().iter().zip([0.5, 1.5, 1.5, 0.0]) {
                    let seen = spring.lagrangian_derivatives(&SVector::from([q]), &SVector::from([v]));
                    assert_eq!([seen.value, seen.d1[0], seen.d11[(0, 0)]], [
                        0.5 * v * v - 0.5 * k * x * q * q,
                        -k * x * q,
                        -k * x,
                    ]);
                }
            }
        )*};
    }
    check!(cases_auto, cases_expanded, cases_num_dual, cases_single);
}

/// Places that loops and swaps change, blocks that `break` ends, by each engine.
macro_rules! places_by_each_engine {
    ($($name:ident by $engine:ident of $scalar:ident),*) => {$(
        mod $name {
            pub struct Places {
                pub k: [$scalar; 3],
            }

            #[dalembert::rayleigh_system(derivatives = $engine)]
            impl Places {
                fn lagrangian(&self, q: [$scalar; 2], v: [$scalar; 2]) -> $scalar {
                    let mut x = q;
                    x.swap(0, 1);
                    let (mut a, mut b) = (v[0], x[0]);
                    std::mem::swap(&mut a, &mut b);
                    // a = q1, b = v0, x = [q1, q0]
                    for (i, x) in x.iter_mut().enumerate() {
                        *x *= (i + 1) as $scalar;
                        if *x > 100.0 {
                            *x = 0.0;
                        }
                    }
                    let mut table = [[0.0; 2]; 2];
                    for row in table.iter_mut() {
                        for (entry, x) in row.iter_mut().zip(x) {
                            *entry += x * x;
                        }
                    }
                    for entry in &mut table[1] {
                        *entry *= 0.5;
                    }
                    let stiffness = 'found: {
                        for k in [1.0, 2.0, 3.0] {
                            if q[0] < k - 1.5 {
                                break 'found k * q[0];
                            }
                        }
                        7.0
                    };
                    let fixed = 'a: {
                        let mut n = 0;
                        loop {
                            n += 1;
                            if n == 3 {
                                break 'a n as $scalar;
                            }
                        }
                    };
                    let k: [$scalar; 3] = self.k;
                    let product = k.map(|k| k * q[1]).into_iter().reduce(|a, b| a * b).unwrap();
                    let most = [q[0], q[1]].into_iter().reduce($scalar::max).unwrap_or(0.0);
                    a * b + table[0][1] + table[1][0] + stiffness * fixed + product + most * v[1]
                }
            }
        }
    )*};
}
places_by_each_engine!(
    places_auto by auto of f64,
    places_expanded by expanded of f64,
    places_num_dual by num_dual of f64,
    places_single by expanded of f32
);

#[test]
fn places_and_blocks_are_those_of_every_engine() {
    // q0 < 0.5: the second constant is found; q1 < q0.
    let (q, v) = ([0.25, -0.5], [1.5, 2.0]);
    // q1 v0 + 4 q0² + q1²/2 + 3·2 q0 + 6 q1³ + q0 v1
    let value = -0.75 + 4.0 * 0.0625 + 0.125 + 6.0 * 0.25 - 6.0 * 0.125 + 0.5;
    let by_q = [8.0 * 0.25 + 6.0 + 2.0, 1.5 - 0.5 + 18.0 * 0.25];
    macro_rules! check {
        ($($name:ident),*) => {$(
            let system = $name::Places { k: [1.0, 2.0, 3.0] };
            let seen = system.lagrangian_derivatives(&SVector::from(q.map(|x| x as _)), &SVector::from(v.map(|x| x as _)));
            assert_eq!([seen.value, seen.d1[0], seen.d1[1]].map(f64::from), [value, by_q[0], by_q[1]]);
            assert_eq!([seen.d2[0], seen.d2[1], seen.d11[(1, 1)]].map(f64::from), [-0.5, 0.25, 1.0 + 36.0 * -0.5]);
        )*};
    }
    check!(places_auto, places_expanded, places_num_dual, places_single);
    assert!(matches!(places_auto::Places::STRUCTURE.engine, dalembert::system::Engine::Expanded));
}
