//! A step that fails has written nothing, whatever its method remembers: no copy of the memory is kept to be
//! put back.

use core::mem::MaybeUninit;
use core::ptr::null_mut;

use dalembert::{Gauss, Midpoint, OneSided, Trapezoidal, rayleigh_system};
use dalembert_c::Status;
use dalembert_c::face::Fields;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::bytes;

/// Runs of 30 steps of each system; 100 with optimisation.
const RUNS: u32 = match () {
    () if cfg!(miri) => 1,
    () if cfg!(debug_assertions) => 25,
    () => 100,
};

/// How many of random steps fail, and how many do not.
macro_rules! failures_by {
    ($($prefix:ident $system:ident $([$driven:ident])?: $n:literal, $rule:ident, $method:ty;)*) => { $(
        dalembert_c::parameters! {
            /// Masses on quartic springs, with drag; the first is pushed.
            pub struct $system {
                /// Drag.
                pub c: f64,
            }
        }

        #[rayleigh_system(rule = $rule)]
        impl $system {
            fn lagrangian(&self, q: [f64; $n], v: [f64; $n]) -> f64 {
                let mut energy = -0.25 * q[0].powi(4);
                for i in 0..$n {
                    energy += 0.5 * v[i] * v[i];
                }
                for i in 1..$n {
                    energy -= 0.25 * (q[i] - q[i - 1]).powi(4);
                }
                energy
            }

            fn rayleigh(&self, v: [f64; $n]) -> f64 {
                v.iter().map(|v| 0.5 * self.c * v * v).sum()
            }

            $(
                #[doc = stringify!($driven)]
                fn force(&self, q: [f64; $n], _v: [f64; $n], u: [f64; 1]) -> [f64; $n] {
                    let mut force = q.map(|q| -0.1 * q);
                    force[0] += u[0];
                    force
                }
            )?
        }

        dalembert_c::c_api! { $prefix: $system, rule: $method }

        #[allow(non_snake_case)]
        fn $prefix(random: &mut StdRng) -> [u32; 2] {
            let mut memory = MaybeUninit::<$prefix::CMemory>::zeroed();
            let (size, layout, at) = (size_of_val(&memory), $prefix::HEADER.layout, memory.as_mut_ptr());
            let (start, rest) = ([0.1; $n], [0.0; $n]);
            let started = unsafe { $prefix::init_with(at, size, layout, &$system { c: 0.1 }.given(), 0.1, &start, &rest) };
            assert_eq!(started, Status::Ok);
            let mut counts = [0; 2];
            for i in 0..30 {
                // From another state now and then, the first step among them; some lie beyond any root or
                // number.
                if random.random_bool(0.4) {
                    let largest = if random.random_bool(0.5) { 1.0 } else { 300.0 };
                    let size = 10_f64.powf(random.random_range(0.0..largest));
                    let [q, p] = [(); 2].map(|()| [(); $n].map(|()| size * random.random_range(-1.0..1.0)));
                    assert_eq!(unsafe { $prefix::set_state(at, &q, &p) }, Status::Ok);
                }
                if random.random_bool(0.2) {
                    let h = 10_f64.powf(random.random_range(-2.0..2.0));
                    assert_eq!(unsafe { $prefix::set_step_size(at, h) }, Status::Ok);
                }
                $(
                    let $driven = [if random.random_bool(0.2) { 1e300 } else { random.random_range(-1.0..1.0) }];
                )?
                let before = bytes(&memory);
                let status = unsafe { $prefix::step(at, $(&$driven,)? null_mut()) };
                let failed = status != Status::Ok;
                counts[usize::from(failed)] += 1;
                // The control: a step that is taken shows in the bytes.
                assert!(cfg!(miri) || failed == (bytes(&memory) == before), "{}, step {i}: {status:?}", stringify!($prefix));
            }
            counts
        }
    )*

    #[test]
    fn a_step_that_fails_has_written_nothing() {
        let mut random = StdRng::seed_from_u64(18);
        $(
            let mut counts = [0; 2];
            for _ in 0..RUNS {
                let [taken, failed] = $prefix(&mut random);
                counts = [counts[0] + taken, counts[1] + failed];
            }
            assert!(cfg!(miri) || counts.iter().all(|&count| count > 2 * RUNS), "{}: {counts:?}", stringify!($prefix));
        )*
    } };
}

failures_by! {
    history Spring2 [DrivenSpring2]: 2, midpoint, Midpoint;
    kept_matrix Spring4 [DrivenSpring4]: 4, midpoint, Midpoint;
    explicit Spring3 [DrivenSpring3]: 3, trapezoidal, Trapezoidal;
    stages Stages2 [DrivenStages2]: 2, gauss, Gauss<3>;
    one_sided OneSided2: 2, one_sided, OneSided;
}
