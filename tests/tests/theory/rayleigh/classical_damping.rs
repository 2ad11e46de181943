//! C M⁻¹V″(q) symmetric for all q: the system is a product of systems with C = 2aM each, and the exact motion
//! has an R_d for every h, nonlinear or not. So have rules whose steps are then conformally symplectic; Gauss
//! rules of two stages and more, and compositions of the midpoint rule, only where V is quadratic.

use dalembert::derivative::LegendreDerivatives;
use dalembert::exact::Exact;
use dalembert::nalgebra::vector;
use dalembert::rayleigh::RayleighStep;
use dalembert::step::{Flow, Momenta};
use dalembert::{
    Composition, Discretise, FittedTrapezoidal, Gauss, Midpoint, Splitting, State, Trapezoidal,
    rayleigh_system,
};

/// Two coordinates damped alike, and one by itself: M = diag(m), C = diag(2a₁m₁, 2a₁m₂, 2a₂m₃). `bond`
/// couples the two to the third, so that CM⁻¹V″ is symmetric no more.
#[derive(Clone, Copy, Debug)]
struct Product {
    m: [f64; 3],
    a: [f64; 2],
    quartic: f64,
    bond: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss, fitted_trapezoidal])]
impl Product {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let kinetic = self.m[0] * v[0] * v[0] + self.m[1] * v[1] * v[1] + self.m[2] * v[2] * v[2];
        let springs = 2.0 * q[0] * q[0] - 1.4 * q[0] * q[1] + q[1] * q[1] + 1.5 * q[2] * q[2];
        0.5 * (kinetic - springs)
            - self.quartic * ((q[0] - 0.5 * q[1]).powi(4) + q[2].powi(4))
            - self.bond * q[1] * q[2]
    }

    fn rayleigh(&self, v: [f64; 3]) -> f64 {
        self.a[0] * (self.m[0] * v[0] * v[0] + self.m[1] * v[1] * v[1]) + self.a[1] * self.m[2] * v[2] * v[2]
    }
}

const PRODUCT: Product = Product { m: [1.0, 1.7, 0.8], a: [0.35, 0.9], quartic: 1.5, bond: 0.0 };
const QUADRATIC: Product = Product { quartic: 0.0, ..PRODUCT };
const BOUND: Product = Product { bond: 0.6, ..PRODUCT };

fn exact(system: &Product, h: f64) -> RayleighStep {
    let ends = (vector![0.6, -0.4, 0.3], vector![0.65, -0.2, 0.4]);
    let segment = Exact::new(system).segment(ends.0, ends.1, h).unwrap();
    let legendre = LegendreDerivatives {
        momenta: Momenta { p0: segment.p0.value, p1: segment.p1.value },
        p0_by_q0: segment.p0.d1,
        p0_by_q1: segment.p0.d2,
        p1_by_q0: segment.p1.d1,
        p1_by_q1: segment.p1.d2,
    };
    RayleighStep::of(&[legendre.step_matrix().unwrap()], Some(1e-12)).unwrap()
}

fn of<M>(system: &Product, method: M, h: f64) -> RayleighStep
where
    Product: Flow<M, 3, Scalar = f64>,
{
    let state = State { q: vector![0.6, -0.4, 0.3], p: vector![0.5, 0.2, -0.7] };
    system.by(method, h).rayleigh_step(&[state]).unwrap()
}

#[test]
fn the_exact_motion_and_conformally_symplectic_rules_have_an_r_d_nonlinear_or_not() {
    assert!(exact(&PRODUCT, 0.3).is_rayleigh() && !exact(&BOUND, 0.3).is_rayleigh());
    for h in [0.1, 0.4] {
        for system in [&PRODUCT, &QUADRATIC] {
            assert!(of(system, Trapezoidal, h).is_rayleigh());
            assert!(of(system, FittedTrapezoidal, h).is_rayleigh());
            assert!(of(system, Splitting::blanes_moan_4(), h).is_rayleigh());
            assert!(of(system, Splitting::blanes_moan_6(), h).is_rayleigh());
            assert!(of(system, Composition::kahan_li_6(Trapezoidal), h).is_rayleigh());
        }
        // Control: bound together, only rules of order 2 have one.
        assert!(!of(&BOUND, Splitting::blanes_moan_6(), h).is_rayleigh());
        assert!(of(&BOUND, Trapezoidal, h).is_rayleigh() && of(&BOUND, Midpoint, h).is_rayleigh());
    }
}

#[test]
fn gauss_rules_have_one_only_where_the_potential_is_quadratic() {
    for h in [0.1, 0.4] {
        assert!(of(&QUADRATIC, Gauss::<2>, h).is_rayleigh() && of(&QUADRATIC, Gauss::<3>, h).is_rayleigh());
        assert!(of(&QUADRATIC, Composition::kahan_li_6(Midpoint), h).is_rayleigh());
        assert!(!of(&PRODUCT, Gauss::<2>, h).is_rayleigh() && !of(&PRODUCT, Gauss::<3>, h).is_rayleigh());
        assert!(!of(&PRODUCT, Composition::kahan_li_6(Midpoint), h).is_rayleigh());
        assert!(of(&PRODUCT, Gauss::<1>, h).is_rayleigh());
    }
    // What is missing is of the method's own error: it falls faster than the h⁴ of the exact motion of
    // `BOUND`.
    let asymmetry = |system: &Product, h: f64| of(system, Gauss::<2>, h).at_start.value.abs();
    let fall = |system: &Product| (asymmetry(system, 0.1) / asymmetry(system, 0.05)).log2();
    assert!(fall(&PRODUCT) > 5.5 && (fall(&BOUND) - 4.0).abs() < 0.3, "{} {}", fall(&PRODUCT), fall(&BOUND));
}
