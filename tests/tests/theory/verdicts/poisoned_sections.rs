//! Families with values and slopes that are not finite, or too large to say anything: Hamilton–Jacobi
//! reports.

use dalembert::ScalarField;
use dalembert::hamilton_jacobi::{ConfigurationMap, Outcome, Residual, SolutionReport};
use dalembert::nalgebra::{SMatrix, SVector, vector};
use dalembert::{Discretise, Midpoint};
use dalembert_tests::damped_oscillator::{Affine, CompleteSolution, DAMPED, Quadratic, trajectory};

const H: f64 = 0.25;

/// Values that no verdict may rest on.
const POISON: [f64; 5] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e200, -1e308];

/// A generating function with some of what it gives replaced.
#[derive(Clone, Copy)]
struct Function {
    function: Quadratic,
    value: Option<f64>,
    slope: Option<f64>,
    bend: Option<f64>,
}

impl ScalarField<1> for Function {
    type Scalar = f64;

    fn value(&self, q: &SVector<f64, 1>) -> f64 {
        self.value.unwrap_or_else(|| self.function.value(q))
    }

    fn gradient(&self, q: &SVector<f64, 1>) -> SVector<f64, 1> {
        self.slope.map_or_else(|| self.function.gradient(q), |slope| vector![slope])
    }

    fn hessian(&self, q: &SVector<f64, 1>) -> SMatrix<f64, 1, 1> {
        self.bend.map_or_else(|| self.function.hessian(q), SMatrix::from_element)
    }
}

/// A map with its image or its slope replaced.
#[derive(Clone, Copy)]
struct Map {
    map: Affine,
    image: Option<f64>,
    slope: Option<f64>,
}

impl ConfigurationMap<1> for Map {
    type Scalar = f64;

    fn image(&self, q: &SVector<f64, 1>) -> SVector<f64, 1> {
        self.image.map_or_else(|| self.map.image(q), |image| vector![image])
    }

    fn jacobian(&self, q: &SVector<f64, 1>) -> SMatrix<f64, 1, 1> {
        self.slope.map_or_else(|| self.map.jacobian(q), SMatrix::from_element)
    }
}

fn solution() -> CompleteSolution {
    CompleteSolution::new(&DAMPED, H, 0.3, 0.7)
}

fn family() -> Vec<Function> {
    let functions = solution().family(4);
    functions
        .into_iter()
        .map(|function| Function { function, value: None, slope: None, bend: None })
        .collect()
}

fn maps() -> Vec<Map> {
    (0..4).map(|k| Map { map: solution().map(k), image: None, slope: None }).collect()
}

fn reports(
    family: &[Function],
    maps: &[Map],
    samples: &[SVector<f64, 1>],
    relative: f64,
) -> Vec<SolutionReport<1>> {
    let theory = DAMPED.by(Midpoint, H).hamilton_jacobi().with_tolerance(relative);
    let reports = [
        theory.check_sections(family, samples),
        theory.check_generating_functions(family, samples),
        theory.check_solution(maps, family, samples),
    ];
    reports.into_iter().filter_map(Result::ok).collect()
}

const RELATIVE: f64 = 256.0 * f64::EPSILON;

fn samples() -> Vec<SVector<f64, 1>> {
    vec![vector![0.4], vector![-0.9], vector![0.1]]
}

fn holds(outcome: &Outcome<1>) -> bool {
    outcome.is_ok_and(|residual| residual.holds())
}

#[test]
fn no_poisoned_family_is_a_solution() {
    // Positive control.
    let clean = reports(&family(), &maps(), &samples(), RELATIVE);
    assert!(clean.len() == 3 && clean.iter().all(|report| report.is_solution() && holds(&report.work)));
    assert!(clean.iter().all(|report| report.to_string().contains("problem: a solution")));

    let mut tried = 0;
    for k in 0..4 {
        for poison in POISON {
            for part in 0..4 {
                let (mut family, mut maps) = (family(), maps());
                match part {
                    0 => family[k].slope = Some(poison),
                    1 => family[k].bend = Some(poison),
                    2 => maps[k].image = Some(poison),
                    _ => maps[k].slope = Some(poison),
                }
                let reports = reports(&family, &maps, &samples(), RELATIVE);
                for (which, report) in reports.iter().enumerate() {
                    // Of γ_0 alone the slope is compared with nothing; maps are those of `check_solution`
                    // alone.
                    let concerned = match part {
                        0 => true,
                        1 => k > 0,
                        2 => which == 2,
                        _ => false,
                    };
                    let text = report.to_string();
                    if concerned {
                        tried += 1;
                        assert!(!report.is_solution(), "k = {k}, {poison}, part {part}: {report}");
                        assert!(!text.contains("problem: a solution"), "{text}");
                    }
                    // Whatever the poison reaches.
                    let lines = [&report.plus, &report.work, &report.no_work, &report.closed_work];
                    for outcome in lines.into_iter().filter_map(|outcome| outcome.as_ref().ok()) {
                        let finite = outcome.size.is_finite() && outcome.tolerance.is_finite();
                        assert!(finite || !outcome.holds(), "{text}");
                    }
                }
            }
        }
    }
    println!("{tried} poisoned reports");
    assert!(tried > 80);
}

#[test]
fn a_slope_that_leaves_nothing_of_the_section_says_nothing() {
    for bend in [1e14, 1e17, 1e30] {
        let mut family = family();
        family[1].bend = Some(bend);
        for report in reports(&family, &maps(), &samples(), RELATIVE) {
            assert!(!report.is_solution(), "{bend}: {report}");
        }
    }
    // Positive control: a slope of ordinary size that is wrong changes the tolerance, but no verdict on the
    // sections themselves.
    let mut family = family();
    family[1].bend = Some(3.0);
    assert!(reports(&family, &maps(), &samples(), RELATIVE).iter().all(SolutionReport::is_solution));
}

#[test]
fn samples_and_tolerances_that_say_nothing_get_no_yes() {
    // Without shift every linear family has p = 0 at q = 0, right or wrong.
    let mut wrong: Vec<Function> = family();
    for function in &mut wrong {
        function.function = Quadratic { s: function.function.s + 0.3, lambda: 0.0, constant: 0.0 };
    }
    let mut nothing: Vec<Vec<SVector<f64, 1>>> = vec![vec![], vec![vector![0.0]; 3]];
    for poison in POISON {
        nothing.push(vec![vector![poison]]);
        nothing.push(vec![vector![0.4], vector![poison]]);
    }
    for samples in &nothing {
        for report in reports(&wrong, &maps(), samples, RELATIVE) {
            assert!(!report.is_solution(), "{samples:?}: {report}");
        }
    }
    for relative in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 1.0, 1e10, f64::MAX] {
        for report in reports(&wrong, &maps(), &samples(), relative) {
            assert!(!report.is_solution(), "{relative}: {report}");
        }
    }
    // Positive control: the samples that say something reject it by its residual.
    for report in reports(&wrong, &maps(), &samples(), RELATIVE) {
        let plus = report.plus.unwrap();
        assert!(!report.is_solution() && plus.telling > 0 && plus.size > 1e3 * plus.tolerance, "{report}");
    }
}

#[test]
fn residuals_that_are_not_finite_do_not_hold() {
    let residual = |size, tolerance, telling| Residual {
        size,
        tolerance,
        step: 0,
        q: vector![0.0],
        places: 1,
        telling,
        silent: 0,
    };
    for poison in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for other in [0.0, 1.0, f64::MAX, f64::INFINITY, f64::NAN] {
            assert!(!residual(poison, other, 1).holds() && !residual(other, poison, 1).holds());
            assert!(!residual(poison, other, 1).to_string().contains("holds"));
        }
    }
    assert!(!residual(0.0, 0.0, 0).holds() && residual(0.0, 0.0, 0).to_string().contains("SAYS NOTHING"));
    assert!(residual(1e-16, 1e-15, 1).holds() && !residual(1e-14, 1e-15, 1).holds());
}

#[test]
fn reports_along_poisoned_configurations_have_no_equation_that_holds() {
    let theory = DAMPED.by(Midpoint, H).hamilton_jacobi();
    let clean = trajectory(&DAMPED, H, 0.4, 0.3, 5);
    let outcomes = |q: &[SVector<f64, 1>]| -> Vec<Outcome<1>> {
        let hamilton = theory.hamilton_equations(q).unwrap();
        let rayleigh = theory.hamilton_equations_rayleigh(q).unwrap();
        let mut outcomes = Vec::new();
        for report in [hamilton, rayleigh] {
            for pair in [
                report.right_configuration,
                report.right_momentum,
                report.left_configuration,
                report.left_momentum,
            ] {
                outcomes.extend([pair.printed, pair.corrected]);
            }
        }
        if let Ok(along) = theory.along_trajectory(q) {
            outcomes.extend([along.trajectory, along.net_force, along.right_plus, along.left_minus]);
            for pair in [along.right_minus, along.left_plus, along.example_minus] {
                outcomes.extend([pair.printed, pair.corrected]);
            }
        }
        if let Ok(printed) = theory.as_printed(&family(), q) {
            outcomes.extend([
                printed.trajectory,
                printed.net_force,
                printed.gamma_minus,
                printed.gamma_plus,
                printed.right_equation,
                printed.left_equation,
                printed.action_increment,
                printed.lemma_plus,
                printed.lemma_minus,
                printed.backward_flow,
            ]);
        }
        outcomes
    };
    // Positive control: on a trajectory the corrected equations hold.
    assert!(outcomes(&clean).iter().filter(|outcome| holds(outcome)).count() > 10);
    for poison in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e200] {
        for place in 0..4 {
            let mut q = clean[..4].to_vec();
            q[place] = vector![poison];
            for outcome in outcomes(&q) {
                // A poison that only rounds, 1e200, may leave an equation that still holds in its own terms.
                assert!(!holds(&outcome) || poison == 1e200, "{poison} at {place}: {outcome:?}");
                if let Ok(residual) = outcome {
                    let finite = residual.size.is_finite() && residual.tolerance.is_finite();
                    assert!(finite || !residual.holds());
                }
            }
        }
    }
    assert!(outcomes(&[]).iter().all(|outcome| !holds(outcome)));
    assert!(theory.right_equation_everywhere(&family(), &[]).is_err());
    let report = theory.right_equation_everywhere(&family(), &[vector![f64::NAN]]).unwrap();
    assert!(!holds(&report.right_equation) && !holds(&report.derivative) && !holds(&report.unforced));
    assert!(!holds(&report.forced));
    // No characteristic, no verdict: neither closed, nor free of caustics.
    let report = theory.characteristics_report(&[]).unwrap();
    assert!(!holds(&report.closed) && !holds(&report.balance));
    assert!(!report.to_string().contains("no caustic"), "{report}");
    for part in 0..2 {
        for poison in [f64::NAN, f64::INFINITY] {
            let mut function = family()[0];
            if part == 0 {
                function.slope = Some(poison)
            } else {
                function.bend = Some(poison)
            }
            for steps in [0, 3] {
                assert!(theory.carry(&function, &vector![0.4], steps).is_err(), "{poison} {part} {steps}");
            }
        }
    }
    assert!(theory.carry(&family()[0], &vector![0.4], 3).is_ok());
}
