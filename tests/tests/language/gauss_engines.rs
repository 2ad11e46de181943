//! The stages that the macro writes in lanes are those that num-dual gives one by one, for every kind of
//! operation.

#![expect(clippy::neg_cmp_op_on_partial_ord, reason = "lanes must decide negated comparisons as numbers do")]

use dalembert::nalgebra::vector;
use dalembert::system::{Blank, ForcedLagrangian, Lanes};
use dalembert::{Discretise, Force, Gauss, State};

/// One system for each engine, with selections, masks, functions of one and of two numbers, and numbers among
/// their arguments.
macro_rules! systems {
    ($engine:ident, $scalar:ident) => {
        use dalembert::rayleigh_system;

        pub struct Everything {
            pub a: $scalar,
            pub b: $scalar,
            pub is_open: bool,
        }

        #[rayleigh_system(rule = gauss, derivatives = $engine)]
        impl Everything {
            fn lagrangian(&self, q: [$scalar; 2], v: [$scalar; 2]) -> $scalar {
                let kinetic = 0.5 * (1.5 + q[1].sin() * 0.3) * v[0].powi(2)
                    + 0.2 * q[0].cos() * v[0] * v[1]
                    + 0.5 * (1.0 + 0.1 * q[0].powi(4)) * v[1] * v[1];
                let wall = if q[0] > self.a { (q[0] - self.a).powi(3) } else { 0.1 * q[0] };
                let gate = if self.is_open { q[1].exp() } else { q[1] };
                let corner =
                    if q[0] < 0.1 && !(q[1] >= 0.2) || v[0] != v[0] { q[0] * q[1] } else { 0.3 * q[1] };
                let bounded = q[1].min(0.15).max(-0.4) + q[0].clamp(-0.2, 0.7);
                let pairs =
                    self.b.powf(q[0]) + (2.0 + q[1]).powf(1.7) + q[1].atan2(2.0 + q[0]) + q[0].hypot(self.b);
                let others = q[0].tanh()
                    + (2.0 + q[1]).ln()
                    + (1.5 + q[0]).sqrt()
                    + q[1].mul_add(self.a, 0.3).abs()
                    + (0.4 * q[0]).tan();
                kinetic - 0.3 * (wall + gate + corner + bounded + pairs + others) - q[0] * q[0] - q[1] * q[1]
            }

            fn rayleigh(&self, q: [$scalar; 2], v: [$scalar; 2]) -> $scalar {
                0.1 * (1.0 + q[0] * q[0]) * v[0] * v[0] + 0.05 * v[1].powi(2)
            }

            fn force(&self, q: [$scalar; 2], v: [$scalar; 2]) -> [$scalar; 2] {
                [0.2 * v[1].copysign(q[0]), 0.0]
            }
        }
    };
}

mod expanded {
    systems!(expanded, f64);
}
mod num_dual {
    systems!(num_dual, f64);
}
mod single {
    systems!(expanded, f32);
}

fn lanes(values: [f64; 5]) -> Lanes<f64, 5> {
    Lanes(values)
}

#[test]
fn lanes_agree_with_num_dual() {
    for is_open in [false, true] {
        let (one, other) = (
            expanded::Everything { a: 0.25, b: 1.3, is_open },
            num_dual::Everything { a: 0.25, b: 1.3, is_open },
        );
        // On both sides of every condition.
        let q = [lanes([0.05, 0.3, -0.25, 0.8, 0.2]), lanes([-0.5, 0.17, 0.3, 0.1, -0.1])];
        let v = [lanes([0.4, -1.2, 0.3, 0.0, 2.0]), lanes([-0.3, 0.8, 1.1, 0.5, -0.7])];
        let momenta = |rate: &[Lanes<f64, 5>; 2]| [rate[0] * 0.3 + 0.7, rate[1] * -0.2 + 0.4];
        let (a, b) = (
            one.stages(&mut Blank::blank(), &q, &v, momenta),
            other.stages(&mut Blank::blank(), &q, &v, momenta),
        );
        for (a, b) in [(a.rate, b.rate), (a.residual, b.residual), (a.correction, b.correction)] {
            for coordinate in 0..2 {
                for lane in 0..5 {
                    let (a, b) = (a[coordinate].0[lane], b[coordinate].0[lane]);
                    assert!((a - b).abs() <= 4e-15 * (1.0 + b.abs()), "{coordinate} {lane}: {a} {b}");
                }
            }
        }
        // Positive control: another field is seen.
        let altered = expanded::Everything { a: 0.25, b: 1.3 + 1e-9, is_open };
        assert!(
            (altered.stages(&mut Blank::blank(), &q, &v, momenta).rate[0].0[0] - a.rate[0].0[0]).abs()
                > 1e-11
        );
        assert_eq!(Force::force(&one, &vector![0.3, 0.1], &vector![0.2, -0.4])[1], 0.0);
    }
}

#[test]
fn steps_agree_with_num_dual_and_in_single_precision() {
    let (one, other, single) = (
        expanded::Everything { a: 0.25, b: 1.3, is_open: true },
        num_dual::Everything { a: 0.25, b: 1.3, is_open: true },
        single::Everything { a: 0.25, b: 1.3, is_open: true },
    );
    let start = State::from_velocity(&one, [0.5, -0.6], [0.3, 0.4]).unwrap();
    let a = one.by(Gauss::<4>, 0.1).step(&start).unwrap().state;
    let b = other.by(Gauss::<4>, 0.1).step(&start).unwrap().state;
    assert!((a.q - b.q).amax() < 1e-15 && (a.p - b.p).amax() < 2e-15, "{a:?} {b:?}");
    let start = State::from_velocity(&single, [0.5_f32, -0.6], [0.3_f32, 0.4]).unwrap();
    let c = single.by(Gauss::<4>, 0.1).step(&start).unwrap().state;
    assert!(
        (c.q.cast::<f64>() - a.q).amax() < 5e-7 && (c.p.cast::<f64>() - a.p).amax() < 1e-6,
        "{c:?} {a:?}"
    );
}
