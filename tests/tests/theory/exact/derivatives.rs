//! Derivatives of the exact objects against central differences of order 6 of what they differentiate, on a
//! system with q-dependent mass, q-dependent Rayleigh function and general force.

use std::sync::LazyLock;

use dalembert::exact::{Exact, ExactSegment};
use dalembert::nalgebra::{SMatrix, SVector, vector};
use dalembert::rayleigh_system;

struct Arm {
    drag: f64,
}

#[rayleigh_system]
impl Arm {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let inertia = 2.0 + q[0].cos();
        0.5 * inertia * v[0] * v[0]
            + 0.4 * (q[0] - q[1]).cos() * v[0] * v[1]
            + 0.7 * v[1] * v[1]
            + q[0].cos()
            + 0.5 * (2.0 * q[1]).cos()
    }

    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        self.drag * (1.0 + 0.5 * q[1] * q[1]) * (0.5 * v[0] * v[0] + 0.1 * v[1].powi(4))
    }

    fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        [0.3 * q[1] * v[1], -0.2 * q[0] * v[0] * v[1] + 0.1 * q[1].sin()]
    }
}

const SYSTEM: Arm = Arm { drag: 0.5 };
const H: f64 = 0.6;
const Q0: SVector<f64, 2> = vector![0.3, -0.5];
const Q1: SVector<f64, 2> = vector![0.7, 0.1];

fn exact() -> Exact<'static, Arm, 2> {
    Exact::new(&SYSTEM)
}

const SPACING: f64 = 0.01;

/// The segments with a coordinate of their ends moved by 1 to 3 spacings, ahead and back: by coordinate,
/// those of q0 first.
static MOVED: LazyLock<[[[ExactSegment<2>; 2]; 3]; 4]> = LazyLock::new(|| {
    let at = |index: usize, shift: f64| {
        let (mut q0, mut q1) = (Q0, Q1);
        if index < 2 {
            q0[index] += shift;
        } else {
            q1[index - 2] += shift;
        }
        exact().segment(q0, q1, H).unwrap()
    };
    std::array::from_fn(|index| {
        std::array::from_fn(|k| [1.0, -1.0].map(|sign| at(index, sign * SPACING * (k + 1) as f64)))
    })
});

/// ∂g/∂q0 and ∂g/∂q1, columns by coordinate.
fn differences(g: impl Fn(&ExactSegment<2>) -> SVector<f64, 2>) -> (SMatrix<f64, 2, 2>, SMatrix<f64, 2, 2>) {
    let weights = [3.0 / 4.0, -3.0 / 20.0, 1.0 / 60.0];
    let column = |index: usize| {
        let sides = MOVED[index].iter().zip(weights);
        sides.fold(SVector::<f64, 2>::zeros(), |sum, ([ahead, back], weight)| {
            sum + (g(ahead) - g(back)) * (weight / SPACING)
        })
    };
    let pair = |first: usize| {
        let columns = [column(first), column(first + 1)];
        SMatrix::from_fn(|i, j| columns[j][i])
    };
    (pair(0), pair(2))
}

fn assert_close(value: &SMatrix<f64, 2, 2>, expected: &SMatrix<f64, 2, 2>, what: &str) {
    let error = (value - expected).amax();
    println!("{what}: {error:.1e}");
    assert!(error < 2e-11, "{what}: {value} expected {expected}, apart {error:.1e}");
}

#[test]
fn first_derivatives_of_the_exact_lagrangian() {
    let segment = exact().segment(Q0, Q1, H).unwrap();
    // The value stands in both components: row 0 of the differences is the gradient.
    let (by_q0, by_q1) = differences(|s| SVector::repeat(s.lagrangian.value));
    assert!((by_q0.row(0).transpose() - segment.lagrangian.d1).amax() < 2e-11, "{by_q0}");
    assert!((by_q1.row(0).transpose() - segment.lagrangian.d2).amax() < 2e-11, "{by_q1}");
    // Positive control: the momenta are not the derivatives, the force makes up the difference.
    assert!((by_q1.row(0).transpose() - segment.p1.value).amax() > 1e-2);
}

#[test]
fn second_derivatives_of_the_exact_lagrangian() {
    let second = exact().second_derivatives(&exact().segment(Q0, Q1, H).unwrap()).unwrap();
    let (d11, d12) = differences(|s| s.lagrangian.d1);
    let (d21, d22) = differences(|s| s.lagrangian.d2);
    assert_close(&second.lagrangian.d11, &d11, "D11 L_d");
    assert_close(&second.lagrangian.d12, &d12, "D12 L_d");
    assert_close(&second.lagrangian.d12.transpose(), &d21, "D21 L_d");
    assert_close(&second.lagrangian.d22, &d22, "D22 L_d");
    assert!(second.lagrangian_error < 1e-11, "{:e}", second.lagrangian_error);
}

#[test]
fn jacobians_of_the_exact_force() {
    let second = exact().second_derivatives(&exact().segment(Q0, Q1, H).unwrap()).unwrap();
    let (minus_d1, minus_d2) = differences(|s| s.force.minus);
    let (plus_d1, plus_d2) = differences(|s| s.force.plus);
    assert_close(&second.force.minus.d1, &minus_d1, "D1 f-");
    assert_close(&second.force.minus.d2, &minus_d2, "D2 f-");
    assert_close(&second.force.plus.d1, &plus_d1, "D1 f+");
    assert_close(&second.force.plus.d2, &plus_d2, "D2 f+");
    // Positive control: the part that the third derivatives make up is far above the tolerance; without it
    // the blocks would be symmetric under exchange, which those of this system are not.
    assert!((plus_d1 + minus_d2.transpose()).amax() > 1e-3);
}

#[test]
fn derivatives_of_the_momenta() {
    let segment = exact().segment(Q0, Q1, H).unwrap();
    let (p0_d1, p0_d2) = differences(|s| s.p0.value);
    let (p1_d1, p1_d2) = differences(|s| s.p1.value);
    assert_close(&segment.p0.d1, &p0_d1, "D1 p0");
    assert_close(&segment.p0.d2, &p0_d2, "D2 p0");
    assert_close(&segment.p1.d1, &p1_d1, "D1 p1");
    assert_close(&segment.p1.d2, &p1_d2, "D2 p1");
    // And by the Legendre transforms, p0 = −D1 L_d − f−, p1 = D2 L_d + f+.
    let second = exact().second_derivatives(&segment).unwrap();
    assert!((segment.p0.d2 + second.lagrangian.d12 + second.force.minus.d2).amax() < 1e-12);
    assert!((segment.p1.d2 - second.lagrangian.d22 - second.force.plus.d2).amax() < 1e-12);
}
