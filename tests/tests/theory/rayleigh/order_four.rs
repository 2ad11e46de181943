//! The discrete Rayleigh system of order 4 in q: orders, structure, and what it refuses.

use dalembert::nalgebra::{SMatrix, SVector, matrix, vector};
use dalembert::rayleigh::{OrderFour, OrderFourError, OrderFourState, PotentialEnergy, RayleighStep};
use dalembert::{Discretise, Gauss, State, rayleigh_system};

type Matrix = SMatrix<f64, 3, 3>;
type Vector = SVector<f64, 3>;

/// V = ¼x⁴ + ½y² + z² + ½ sin(xy) + ⅓xz + ¼yz².
#[derive(Clone, Copy)]
struct Mixed;

/// L and R of it, for the reference.
struct Reference {
    mass: [[f64; 3]; 3],
    damping: [[f64; 3]; 3],
}

#[rayleigh_system(rule = gauss)]
impl Reference {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let [x, y, z] = q;
        let mut sum = -(0.25 * x.powi(4) + 0.5 * y * y + z * z + 0.5 * (x * y).sin());
        sum -= x * z / 3.0 + 0.25 * y * z * z;
        for i in 0..3 {
            for j in 0..3 {
                sum += 0.5 * self.mass[i][j] * v[i] * v[j];
            }
        }
        sum
    }

    fn rayleigh(&self, v: [f64; 3]) -> f64 {
        let mut sum = 0.0;
        for i in 0..3 {
            for j in 0..3 {
                sum += 0.5 * self.damping[i][j] * v[i] * v[j];
            }
        }
        sum
    }
}

impl PotentialEnergy<3> for Mixed {
    fn value(&self, q: &Vector) -> f64 {
        let [x, y, z] = [q[0], q[1], q[2]];
        0.25 * x.powi(4) + 0.5 * y * y + z * z + 0.5 * (x * y).sin() + x * z / 3.0 + 0.25 * y * z * z
    }

    fn gradient(&self, q: &Vector) -> Vector {
        let [x, y, z] = [q[0], q[1], q[2]];
        let c = 0.5 * (x * y).cos();
        vector![x.powi(3) + c * y + z / 3.0, y + c * x + 0.25 * z * z, 2.0 * z + x / 3.0 + 0.5 * y * z]
    }

    fn hessian(&self, q: &Vector) -> Matrix {
        let [x, y, z] = [q[0], q[1], q[2]];
        let (s, c) = (0.5 * (x * y).sin(), 0.5 * (x * y).cos());
        let (xx, xy, yy) = (3.0 * x * x - s * y * y, c - s * x * y, 1.0 - s * x * x);
        matrix![xx, xy, 1.0 / 3.0; xy, yy, 0.5 * z; 1.0 / 3.0, 0.5 * z, 2.0 + 0.5 * y]
    }

    fn third(&self, q: &Vector, w: &Vector) -> Matrix {
        let [x, y] = [q[0], q[1]];
        let (s, c) = (0.5 * (x * y).sin(), 0.5 * (x * y).cos());
        let (xxx, xxy) = (6.0 * x - c * y.powi(3), -2.0 * s * y - c * x * y * y);
        let (xyy, yyy) = (-2.0 * s * x - c * x * x * y, -c * x.powi(3));
        let (a, b) = (xxx * w[0] + xxy * w[1], xxy * w[0] + xyy * w[1]);
        matrix![a, b, 0.0; b, xyy * w[0] + yyy * w[1], 0.5 * w[2]; 0.0, 0.5 * w[2], 0.5 * w[1]]
    }
}

const MASS: Matrix = matrix![1.5, 0.2, 0.0; 0.2, 1.0, 0.1; 0.0, 0.1, 2.0];
const DAMPING: Matrix = matrix![0.5, 0.1, 0.0; 0.1, 0.05, 0.15; 0.0, 0.15, 1.0];
const START: [Vector; 2] = [vector![0.8, -0.4, 0.3], vector![0.3, 0.5, -0.2]];

fn system(h: f64) -> OrderFour<Mixed, 3> {
    OrderFour::new(MASS, DAMPING, Mixed, h).unwrap()
}

/// q and v at t = 2, by a Gauss rule of order 16.
fn reference() -> [Vector; 2] {
    let rows = |of: &Matrix| std::array::from_fn(|i| std::array::from_fn(|j| of[(i, j)]));
    let system = Reference { mass: rows(&MASS), damping: rows(&DAMPING) };
    let start = State::from_velocity(&system, START[0], START[1]).unwrap();
    let end = system.by(Gauss::<8>, 0.1).run(start).nth(19).unwrap().unwrap().state;
    [end.q, end.velocity(&system).unwrap()]
}

/// Errors of q and v at t = 2 by so many steps.
fn errors(steps: usize, shifted: bool, [q, v]: &[Vector; 2]) -> [f64; 2] {
    let system = system(2.0 / steps as f64);
    let mut state = system.start(START[0], START[1]);
    if !shifted {
        state.p = MASS * START[1];
    }
    for _ in 0..steps {
        state = system.step(&state).unwrap();
    }
    [(state.q - q).amax(), (system.velocity(&state).unwrap() - v).amax()]
}

#[test]
fn q_and_the_velocity_are_of_order_four() {
    let reference = reference();
    let orders = |shifted: bool| {
        let [coarse, fine] = [40, 80].map(|steps| errors(steps, shifted, &reference));
        [0, 1].map(|i| (coarse[i] / fine[i]).log2())
    };
    let [of_q, of_v] = orders(true);
    assert!((of_q - 4.0).abs() < 0.1 && (of_v - 4.0).abs() < 0.1, "{of_q} {of_v}");
    // Positive control: from the momentum M v itself both are of order 2.
    let [of_q, of_v] = orders(false);
    assert!((of_q - 2.0).abs() < 0.1 && (of_v - 2.0).abs() < 0.1, "{of_q} {of_v}");
}

#[test]
fn the_derivatives_are_those_of_the_formulas() {
    let (system, q0, q1) = (system(0.3), START[0], START[0] + vector![0.1, -0.2, 0.15]);
    let at = system.momenta(&q0, &q1);
    // L_d ± R_d along each coordinate.
    let moved = |q: &Vector, i: usize, e: f64| {
        let mut q = *q;
        q[i] += e;
        q
    };
    let e = 1e-5;
    for i in 0..3 {
        let plus = |e| {
            let q0 = moved(&q0, i, e);
            system.discrete_lagrangian(&q0, &q1) + system.discrete_rayleigh(&q0, &q1)
        };
        let minus = |e| {
            let q1 = moved(&q1, i, e);
            system.discrete_lagrangian(&q0, &q1) - system.discrete_rayleigh(&q0, &q1)
        };
        assert!((at.momenta.p0[i] + (plus(e) - plus(-e)) / (2.0 * e)).abs() < 1e-9);
        assert!((at.momenta.p1[i] - (minus(e) - minus(-e)) / (2.0 * e)).abs() < 1e-9);
        for (by_start, by_q) in [(true, [at.p0_by_q0, at.p1_by_q0]), (false, [at.p0_by_q1, at.p1_by_q1])] {
            let ends = |e| match by_start {
                true => system.momenta(&moved(&q0, i, e), &q1).momenta,
                false => system.momenta(&q0, &moved(&q1, i, e)).momenta,
            };
            let (up, down) = (ends(e), ends(-e));
            for (found, difference) in by_q.iter().zip([up.p0 - down.p0, up.p1 - down.p1]) {
                assert!((found.column(i) - difference / (2.0 * e)).amax() < 1e-8);
            }
        }
    }
}

#[test]
fn the_step_has_an_r_d_and_the_step_of_the_velocity_has_none() {
    let system = system(0.4);
    let state = system.start(START[0], START[1]);
    let a = system.step_matrix(&state).unwrap();
    assert!(RayleighStep::of(&[a], Some(1e-11)).unwrap().is_rayleigh());
    // As a map of (q, Mv), of order 4, it is none: the barrier. ∂(Mv)/∂(q, p) = (shift′, 1).
    let next = system.step(&state).unwrap();
    let shift = |q: &Vector| DAMPING * MASS.try_inverse().unwrap() * Mixed.hessian(q) * (0.4 * 0.4 / 12.0);
    let (before, after) = (shift(&state.q), shift(&next.q));
    let mut of_velocity = a;
    of_velocity.q_by_q = a.q_by_q - a.q_by_p * before;
    of_velocity.p_by_p = a.p_by_p + after * a.q_by_p;
    let found = RayleighStep::of(&[of_velocity], Some(1e-11)).unwrap();
    assert!(!found.at_start.vanishes() && !found.at_end.vanishes(), "{found}");
}

/// Yoshida's three steps, of c h each, with the momenta handed on, or (q, v).
fn composed(steps: usize, hands_velocities: bool, [q, _]: &[Vector; 2]) -> f64 {
    let c = 1.0 / (2.0 - 2_f64.powf(0.2));
    let h = 2.0 / steps as f64;
    let parts = [c, 1.0 - 2.0 * c, c].map(|c| system(c * h));
    let mut state = parts[0].start(START[0], START[1]);
    for _ in 0..steps {
        for (k, part) in parts.iter().enumerate() {
            let from = &parts[(k + 2) % 3];
            let own: OrderFourState<3> = part.start(state.q, from_velocity(from, &state));
            let mut next = own;
            if !hands_velocities {
                next.p = state.p;
            }
            state = part.step(&next).unwrap();
        }
    }
    (state.q - q).amax()
}

/// The velocity of a state of `of`, or of the first state.
fn from_velocity(of: &OrderFour<Mixed, 3>, state: &OrderFourState<3>) -> Vector {
    of.velocity(state).unwrap_or(START[1])
}

#[test]
fn a_composition_that_hands_its_momenta_on_is_of_order_two() {
    let reference = reference();
    let order = |hands: bool, steps: usize| {
        (composed(steps, hands, &reference) / composed(2 * steps, hands, &reference)).log2()
    };
    let handed = order(false, 40);
    assert!((handed - 2.0).abs() < 0.15, "{handed}");
    let shifted_back = order(true, 10);
    assert!((shifted_back - 6.0).abs() < 0.4, "{shifted_back}");
}

#[test]
fn hypotheses_that_fail_have_names() {
    let of = |mass, damping, h| OrderFour::new(mass, damping, Mixed, h).map(drop);
    let mut skew = DAMPING;
    skew[(0, 1)] += 0.1;
    let mut indefinite = MASS;
    indefinite[(0, 0)] = -1.0;
    assert_eq!(of(MASS, skew, 0.1), Err(OrderFourError::Damping));
    assert_eq!(of(indefinite, DAMPING, 0.1), Err(OrderFourError::Mass));
    assert_eq!(of(MASS + skew, DAMPING, 0.1), Err(OrderFourError::Mass));
    assert_eq!(of(MASS, DAMPING, 0.0), Err(OrderFourError::StepSize { h: 0.0 }));
    assert_eq!(of(MASS, DAMPING, -0.1), Ok(()));
    let (own, other) = (system(0.1), system(0.05));
    let state = own.start(START[0], START[1]);
    let expected = OrderFourError::AnotherStepSize { of_state: 0.1, h: 0.05 };
    assert_eq!(other.step(&state).map(drop), Err(expected));
    assert_eq!(other.velocity(&state).map(drop), Err(expected));
    assert!(own.step(&state).is_ok());
}
