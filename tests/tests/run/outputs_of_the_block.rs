//! Outputs that the block of a system states: the function itself, and what its traits have of it.

use dalembert::system::{Described, OutputFunctions};
use dalembert::{Discretise, Lagrangian, Midpoint, State, StepError, rayleigh_system};

/// A mass on a spring, pushed; outputs of all that there is.
struct Cart {
    k: f64,
}

#[rayleigh_system]
impl Cart {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - 0.5 * self.k * q[0] * q[0]
    }

    fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 2]) -> [f64; 1] {
        [u[0] + u[1]]
    }

    /// Three of them.
    ///
    /// - `y[1]` power: of the first push. Unit: W
    fn outputs(&self, q: [f64; 1], v: [f64; 1], u: [f64; 2], t: f64) -> [f64; 3] {
        // No lowering of this body: it branches, calls, and counts.
        let mut sum = 0.0;
        for push in u {
            sum += push.max(0.0);
        }
        [self.k * q[0], u[0] * v[0], if t < 1.0 { sum } else { t.floor() }]
    }
}

/// With an input that its outputs do not take.
struct Pushed;

#[rayleigh_system(derivatives = num_dual)]
impl Pushed {
    fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0]
    }

    fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
        u
    }

    fn outputs(&self, q: [f64; 1], v: [f64; 1]) -> [f64; 2] {
        [2.0 * q[0], 3.0 * v[0]]
    }
}

/// The time that its outputs take is all that it takes.
struct Timed;

#[rayleigh_system]
impl Timed {
    fn lagrangian(&self, _q: [f32; 2], v: [f32; 2]) -> f32 {
        0.5 * (v[0] * v[0] + v[1] * v[1])
    }

    fn outputs(&self, q: [f32; 2], _v: [f32; 2], t: f32) -> [f32; 1] {
        [q[0] * q[1] * t]
    }
}

/// Without any.
struct Free;

#[rayleigh_system]
impl Free {
    fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0]
    }
}

#[test]
fn a_view_has_the_values_of_the_function() {
    let cart = Cart { k: 4.0 };
    let of = |u, t| OutputFunctions::<1, 3>::outputs(&cart.driven(u, t), &[0.5].into(), &[-3.0].into());
    assert_eq!(of([2.0, -1.0], 0.5), [2.0, -6.0, 2.0]);
    assert_eq!(of([2.0, -1.0], 7.5), [2.0, -6.0, 7.0]);
    assert_eq!(of([-1.0, 8.0], 0.5), [2.0, 3.0, 8.0]);
    assert_eq!(of([-1.0, 8.0], 0.5), cart.outputs([0.5], [-3.0], [-1.0, 8.0], 0.5));
    let later =
        |system: &DrivenCart<'_>| OutputFunctions::<1, 3>::outputs(system, &[0.5].into(), &[-3.0].into());
    assert_eq!(cart.driven([2.0, -1.0], 0.5).later(7.0, later), [2.0, -6.0, 7.0], "the time goes on");
}

#[test]
fn what_needs_no_input_stands_on_the_system_and_on_its_view() {
    let values = [[1.0, 6.0]; 2];
    let (q, v) = ([0.5].into(), [2.0].into());
    assert_eq!(
        [OutputFunctions::<1, 2>::outputs(&Pushed, &q, &v), Pushed.driven([9.0]).outputs(&q, &v)],
        values
    );
    assert_eq!(Timed.at_time(3.0).outputs(&[2.0, 5.0].into(), &[0.0; 2].into()), [30.0]);
}

#[test]
fn they_are_described_with_their_documentation() {
    const { assert!(<Cart as Described<1>>::OUTPUTS == 3 && <Pushed as Described<1>>::OUTPUTS == 2) };
    const { assert!(<Timed as Described<2>>::OUTPUTS == 1 && <Free as Described<1>>::OUTPUTS == 0) };
    let told = <Cart as Described<1>>::OUTPUTS_TOLD;
    assert_eq!(told, [" Three of them.", "", " - `y[1]` power: of the first push. Unit: W"]);
    assert!(
        <Pushed as Described<1>>::OUTPUTS_TOLD.is_empty() && <Free as Described<1>>::OUTPUTS_TOLD.is_empty()
    );
}

/// Steps are those of a system without outputs, to the last bit.
#[test]
fn no_step_asks_for_them() -> Result<(), StepError> {
    struct Panics;

    #[rayleigh_system]
    impl Panics {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            0.5 * v[0] * v[0] - q[0].powi(4)
        }
        fn outputs(&self, _q: [f64; 1], _v: [f64; 1]) -> [f64; 1] {
            panic!("asked for")
        }
    }

    #[rayleigh_system]
    fn alike(q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0].powi(4)
    }

    let start = State { q: [1.0].into(), p: [0.25].into() };
    let end = Panics.by(Midpoint, 0.1).run(start).nth(20).unwrap()?.state;
    assert_eq!(end, Alike {}.by(Midpoint, 0.1).run(start).nth(20).unwrap()?.state);
    let asked = std::panic::catch_unwind(|| OutputFunctions::<1, 1>::outputs(&Panics, &end.q, &end.p));
    assert!(asked.is_err(), "the control");
    Ok(())
}
