//! A carried section stays closed iff the pull-back of d f_d vanishes: the closedness defect QᵀP − PᵀQ
//! against differences of the flow, against the criterion for a Rayleigh force, and 0 without force or for
//! n = 1.

use dalembert::hamilton_jacobi::{Characteristic, Frame};
use dalembert::nalgebra::{SMatrix, SVector, vector};
use dalembert::{Discrete, Discretise, Midpoint, ScalarField, Trapezoidal, rayleigh_system};
use dalembert_tests::damped_oscillator::{CompleteSolution, DAMPED};

struct Well {
    friction: f64,
    curl: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl Well {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * v[0] * v[0] + 0.9 * v[1] * v[1]
            - q[0] * q[0]
            - 0.7 * q[1] * q[1]
            - q[0] * q[0] * q[1]
            - 0.3 * q[1].powi(4)
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        self.friction * (0.5 * v[0] * v[0] + 0.8 * v[1] * v[1])
    }

    fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        [self.curl * q[1], -self.curl * (q[0] + v[1])]
    }
}

/// S_0 = ½ qᵀ M q + l·q + q0³/6.
struct Start;

impl ScalarField<2> for Start {
    type Scalar = f64;

    fn value(&self, q: &SVector<f64, 2>) -> f64 {
        0.1 * q[0] * q[0] - 0.2 * q[0] * q[1] + 0.4 * q[0] - 0.1 * q[1] + q[0].powi(3) / 6.0
    }

    fn gradient(&self, q: &SVector<f64, 2>) -> SVector<f64, 2> {
        vector![0.2 * q[0] - 0.2 * q[1] + 0.4 + 0.5 * q[0] * q[0], -0.2 * q[0] - 0.1]
    }

    fn hessian(&self, q: &SVector<f64, 2>) -> SMatrix<f64, 2, 2> {
        SMatrix::from_row_slice(&[0.2 + q[0], -0.2, -0.2, 0.0])
    }
}

const LABEL: SVector<f64, 2> = vector![0.5, -0.4];
const H: f64 = 0.15;
const STEPS: usize = 30;

fn carried<R: Copy, L>(system: &L, rule: R, label: SVector<f64, 2>) -> Characteristic<f64, 2>
where
    L: Discrete<R, 2, Scalar = f64>,
{
    system.by(rule, H).hamilton_jacobi().carry(&Start, &label, STEPS).unwrap()
}

/// QᵀP − PᵀQ.
fn defect(frame: &Frame<f64, 2>) -> SMatrix<f64, 2, 2> {
    frame.q.tr_mul(&frame.p) - frame.p.tr_mul(&frame.q)
}

fn largest_defect(characteristic: &Characteristic<f64, 2>) -> f64 {
    characteristic.frames.iter().fold(0.0, |largest, frame| largest.max(defect(frame).amax()))
}

fn check_frames<R: Copy, L>(system: &L, rule: R)
where
    L: Discrete<R, 2, Scalar = f64>,
{
    let characteristic = carried(system, rule, LABEL);
    let width = 1e-5;
    for j in 0..2 {
        let mut shift: SVector<f64, 2> = vector![0.0, 0.0];
        shift[j] = width;
        let [after, before] = [LABEL + shift, LABEL - shift].map(|label| carried(system, rule, label));
        for k in 0..=STEPS {
            let frame = &characteristic.frames[k];
            let q = (after.states[k].q - before.states[k].q) / (2.0 * width);
            let p = (after.states[k].p - before.states[k].p) / (2.0 * width);
            assert!(
                (q - frame.q.column(j)).amax() < 1e-7 && (p - frame.p.column(j)).amax() < 1e-7,
                "k = {k}"
            );
        }
    }
}

#[test]
fn the_frame_is_the_derivative_by_the_label() {
    let system = Well { friction: 0.5, curl: 0.6 };
    check_frames(&system, Midpoint);
    check_frames(&system, Trapezoidal);
}

#[test]
fn without_force_the_section_stays_closed() {
    let system = Well { friction: 0.0, curl: 0.0 };
    let characteristic = carried(&system, Midpoint, LABEL);
    let report = system.by(Midpoint, H).hamilton_jacobi().characteristics_report(&[characteristic]).unwrap();
    assert!(report.closed.unwrap().holds() && report.balance.unwrap().holds(), "{report}");
}

#[test]
fn friction_opens_it_and_a_curl_more_so_and_the_balance_holds() {
    let friction = Well { friction: 0.5, curl: 0.0 };
    let curl = Well { friction: 0.0, curl: 0.6 };
    for (system, least) in [(&friction, 1e-3), (&curl, 0.1)] {
        let characteristic = carried(system, Midpoint, LABEL);
        assert!(largest_defect(&characteristic) > least, "{}", largest_defect(&characteristic));
        let report =
            system.by(Midpoint, H).hamilton_jacobi().characteristics_report(&[characteristic]).unwrap();
        assert!(!report.closed.unwrap().holds() && report.balance.unwrap().holds(), "{report}");
    }
    // Positive control of the balance: frames of another system have none.
    let characteristic = carried(&curl, Midpoint, LABEL);
    let report =
        friction.by(Midpoint, H).hamilton_jacobi().characteristics_report(&[characteristic]).unwrap();
    assert!(!report.balance.unwrap().holds(), "{report}");
}

/// Rayleigh: after one step the defect is 2 (B DF − DFᵀ Bᵀ), B = D1D2 R_d(q, F(q)).
#[test]
fn for_a_rayleigh_force_it_is_the_antisymmetric_part_of_d1d2r_df() {
    let system = Well { friction: 0.5, curl: 0.0 };
    let theory = system.by(Midpoint, H).hamilton_jacobi();
    for label in [LABEL, vector![-0.9, 0.3]] {
        let characteristic = theory.carry(&Start, &label, 1).unwrap();
        let [from, to] = [&characteristic.states[0].q, &characteristic.states[1].q];
        let segment = system.by(Midpoint, H).segment(from, to).unwrap();
        let r = segment.discrete_rayleigh_derivatives().unwrap();
        let product = r.d12 * characteristic.frames[1].q;
        let expected = (product - product.transpose()) * 2.0;
        let defect = defect(&characteristic.frames[1]);
        assert!((defect - expected).amax() < 1e-14, "{defect}{expected}");
        assert!(defect.amax() > 1e-5, "{defect}");
    }
    // The check of candidates says the same: no W_k exists, by as much.
    let report = theory.check_sections(&[Start, Start], &[LABEL]).unwrap();
    assert!(report.closed_sections.unwrap().holds() && !report.closed_work.unwrap().holds(), "{report}");
    let defect = defect(&theory.carry(&Start, &LABEL, 1).unwrap().frames[1])[(0, 1)];
    assert!((report.closed_work.unwrap().size - defect.abs()).abs() < 1e-14, "{report}");
}

#[test]
fn with_one_degree_of_freedom_every_section_is_closed() {
    let theory = DAMPED.by(Midpoint, 0.25).hamilton_jacobi();
    let s0 = CompleteSolution::new(&DAMPED, 0.25, -0.4, 0.7).function(0);
    let characteristic = theory.carry(&s0, &vector![0.8], 200).unwrap();
    let report = theory.characteristics_report(&[characteristic]).unwrap();
    assert_eq!(report.closed.unwrap().size, 0.0, "{report}");
}

/// Uncoupled isotropic damping: D1D2R_d DF_k is symmetric though there is friction.
#[test]
fn proportional_friction_on_an_uncoupled_well_keeps_it_closed() {
    struct Uncoupled;
    #[rayleigh_system]
    impl Uncoupled {
        fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
            0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.6 * (q[0] * q[0] + q[1] * q[1])
        }
        fn rayleigh(&self, v: [f64; 2]) -> f64 {
            0.2 * (v[0] * v[0] + v[1] * v[1])
        }
    }
    let characteristic = carried(&Uncoupled, Midpoint, LABEL);
    let theory = Uncoupled.by(Midpoint, H).hamilton_jacobi();
    let report = theory.characteristics_report(&[characteristic]).unwrap();
    assert!(report.closed.unwrap().holds(), "{report}");
    let report = theory.check_sections(&[Start, Start], &[LABEL]).unwrap();
    assert!(report.closed_work.unwrap().holds() && !report.no_work.unwrap().holds(), "{report}");
}
