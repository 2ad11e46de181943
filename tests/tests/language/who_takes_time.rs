//! Any function of the block may take the time, or not, beside any other that does.

use dalembert::nalgebra::vector;
use dalembert::step::DiscreteParameters;
use dalembert::system::{Constrained, EventFunctions, OutputFunctions, Rayleigh};
use dalembert::{Lagrangian, Midpoint, rayleigh_system};

/// Of a system whose steps have derivatives by one parameter.
fn is_stepped(_: &impl DiscreteParameters<Midpoint, 3, 1>) {}

/// A system whose functions take the time where a name stands for it, and do not read it; what it shows by
/// the view that they give it.
macro_rules! system {
    (
        $name:ident: L [$($l:ident)?] R [$($r:ident)?] f [$($u:ident: $count:literal)? $(, $f:ident)?]
        g [$($g:ident)?] psi [$($psi:ident)?] events [$($e:ident)?] outputs [$($y:ident)?]; $($view:tt)*
    ) => {
        struct $name {
            m: f64,
            c: f64,
        }

        #[rayleigh_system(parameters = [m])]
        impl $name {
            fn lagrangian(&self, q: [f64; 3], v: [f64; 3] $(, $l: f64)?) -> f64 {
                0.5 * self.m * (v[0] * v[0] + v[1] * v[1]) + 0.1 * v[2] * v[2] - q[1]
            }

            fn rayleigh(&self, v: [f64; 3] $(, $r: f64)?) -> f64 {
                0.5 * self.c * (v[0] * v[0] + v[2] * v[2])
            }

            fn force(&self, q: [f64; 3], _v: [f64; 3] $(, $u: [f64; $count])? $(, $f: f64)?) -> [f64; 3] {
                [0.3, 0.0, 0.2 * q[0]]
            }

            fn constraints(&self, q: [f64; 3] $(, $g: f64)?) -> [f64; 1] {
                [q[0] * q[0] + q[1] * q[1] - 1.0]
            }

            fn velocity_constraints(&self, q: [f64; 3], v: [f64; 3] $(, $psi: f64)?) -> [f64; 1] {
                [v[2] - 0.5 * q[1] * v[0]]
            }

            fn events(&self, q: [f64; 3], _v: [f64; 3] $(, $e: f64)?) -> [f64; 1] {
                [q[0] - 0.5]
            }

            fn outputs(&self, q: [f64; 3], v: [f64; 3] $(, $y: f64)?) -> [f64; 1] {
                [q[2] * v[1]]
            }
        }

        impl $name {
            /// All that a step asks for at (q, v), and what the block says there.
            fn shown() -> Vec<f64> {
                let system = Self { m: 1.3, c: 0.2 };
                let view = system $($view)*;
                let (q, v) = (vector![0.6, 0.8, 0.3], vector![0.4, -0.3, 0.5]);
                is_stepped(&view);
                let l = view.lagrangian_derivatives(&q, &v);
                let r = view.rayleigh_derivatives(&q, &v);
                let (values, gradients) = view.constraint_gradients(&q);
                let (rates, by_q) = view.constraint_rates(&q, &v);
                let ends = l.d1.iter().chain(&l.d22).chain(&r.d2).chain(&r.d22);
                let held = values.iter().chain(&gradients).chain(&rates).chain(&by_q);
                let said = EventFunctions::events(&view, &q, &v).into_iter().chain(OutputFunctions::outputs(&view, &q, &v));
                ends.chain(held).copied().chain(said).collect()
            }
        }
    };
}

// Of any two functions each takes the time with and without the other, with an input and without one.
system! { HeldA: L [] R [] f [] g [] psi [] events [] outputs [];  }
system! { HeldB: L [] R [] f [] g [_t] psi [_t] events [_t] outputs [_t]; .at_time(0.7) }
system! { HeldC: L [] R [_t] f [, _t] g [] psi [] events [_t] outputs [_t]; .at_time(0.7) }
system! { HeldD: L [] R [_t] f [, _t] g [_t] psi [_t] events [] outputs []; .at_time(0.7) }
system! { HeldE: L [_t] R [] f [, _t] g [] psi [_t] events [] outputs [_t]; .at_time(0.7) }
system! { HeldF: L [_t] R [] f [, _t] g [_t] psi [] events [_t] outputs []; .at_time(0.7) }
system! { HeldG: L [_t] R [_t] f [] g [] psi [_t] events [_t] outputs []; .at_time(0.7) }
system! { HeldH: L [_t] R [_t] f [] g [_t] psi [] events [] outputs [_t]; .at_time(0.7) }
system! { DrivenA: L [] R [] f [_u: 1] g [] psi [] events [] outputs []; .driven([0.1]) }
system! { DrivenB: L [] R [] f [_u: 1] g [_t] psi [_t] events [_t] outputs [_t]; .driven([0.1], 0.7) }
system! { DrivenC: L [] R [_t] f [_u: 1, _t] g [] psi [] events [_t] outputs [_t]; .driven([0.1], 0.7) }
system! { DrivenD: L [] R [_t] f [_u: 1, _t] g [_t] psi [_t] events [] outputs []; .driven([0.1], 0.7) }
system! { DrivenE: L [_t] R [] f [_u: 1, _t] g [] psi [_t] events [] outputs [_t]; .driven([0.1], 0.7) }
system! { DrivenF: L [_t] R [] f [_u: 1, _t] g [_t] psi [] events [_t] outputs []; .driven([0.1], 0.7) }
system! { DrivenG: L [_t] R [_t] f [_u: 1] g [] psi [_t] events [_t] outputs []; .driven([0.1], 0.7) }
system! { DrivenH: L [_t] R [_t] f [_u: 1] g [_t] psi [] events [] outputs [_t]; .driven([0.1], 0.7) }

#[test]
fn any_function_may_take_the_time() {
    let plain = HeldA::shown();
    assert!(plain.iter().all(|number| number.is_finite()) && plain.contains(&1.3));
    let others = [
        HeldB::shown(),
        HeldC::shown(),
        HeldD::shown(),
        HeldE::shown(),
        HeldF::shown(),
        HeldG::shown(),
        HeldH::shown(),
        DrivenA::shown(),
        DrivenB::shown(),
        DrivenC::shown(),
        DrivenD::shown(),
        DrivenE::shown(),
        DrivenF::shown(),
        DrivenG::shown(),
        DrivenH::shown(),
    ];
    for (index, shown) in others.iter().enumerate() {
        assert_eq!(*shown, plain, "{index}");
    }
}
