//! A coordinate without mass: its velocity is what friction makes it, as in Rust.

use core::mem::{MaybeUninit, size_of};
use core::ptr::null_mut;

use dalembert::{Gauss, rayleigh_system};
use dalembert_c::Status;
use dalembert_c::face::Fields;

dalembert_c::parameters! {
    /// A mass on a spring that ends in a dashpot.
    pub struct Maxwell {
        /// Masses of both.
        pub m: [f64; 2],
        /// Stiffness.
        pub k: f64,
        /// Damping.
        pub c: f64,
    }
}

#[rayleigh_system(rule = gauss)]
impl Maxwell {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let kinetic = 0.5 * (self.m[0] * v[0] * v[0] + self.m[1] * v[1] * v[1]);
        kinetic - 0.5 * self.k * (q[0] - q[1]) * (q[0] - q[1])
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.c * v[1] * v[1]
    }
}

dalembert_c::c_api! { maxwell: Maxwell, rule: Gauss<4> }

/// At t = 5 from (1, 0), by the matrix exponential; without damping nothing determines the velocity.
#[test]
fn a_spring_and_a_dashpot_in_series() {
    let (size, layout) = (size_of::<maxwell::CMemory>(), maxwell::HEADER.layout);
    let mut memory = MaybeUninit::<maxwell::CMemory>::zeroed();
    let mut init = |c| unsafe {
        let parameters = Maxwell { m: [1.0, 0.0], k: 4.0, c };
        maxwell::init_with(
            memory.as_mut_ptr(),
            size,
            layout,
            &parameters.given(),
            0.1,
            &[1.0, 0.0],
            &[0.0, 0.0],
        )
    };
    assert_eq!(init(0.0), Status::DegenerateLagrangian);
    assert_eq!(init(3.0), Status::Ok);
    let (mut q, mut p, mut v) = ([0.0; 2], [0.0; 2], [0.0; 2]);
    for _ in 0..50 {
        assert_eq!(unsafe { maxwell::step(memory.as_mut_ptr(), null_mut()) }, Status::Ok);
    }
    assert_eq!(unsafe { maxwell::state(memory.as_ptr(), &mut q, &mut p) }, Status::Ok);
    assert_eq!(unsafe { maxwell::velocity(memory.as_ptr(), &mut v) }, Status::Ok);
    let off = [q[0] + 0.035_715_576_430_8, q[1] + 8.355_759_448_77e-5, v[1] + 0.047_509_358_448_4];
    assert!(off.iter().all(|off| off.abs() < 1e-12), "{off:?}");
}
