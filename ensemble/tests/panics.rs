//! Members that panic stand in the result, with their numbers, and the others go on.

use dalembert::{Midpoint, State, StepError, rayleigh_system};
use dalembert_ensemble::{Ensemble, MemberError};

/// A spring, whose stiffness there may not be.
struct Springs {
    which: usize,
}

#[rayleigh_system(rule = [midpoint, trapezoidal], derivatives = num_dual)]
impl Springs {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        let k = [1.0, 2.0][self.which];
        0.5 * v[0] * v[0] - 0.5 * k * q[0] * q[0]
    }
}

/// Member 70 has a spring that is not there, and the making of 80 panics.
fn member(number: u64) -> Result<(Springs, State<f64, 1>), StepError> {
    assert!(number != 80, "there is no member 80");
    let which = if number == 70 { 2 } else { (number % 2) as usize };
    Ok((Springs { which }, State { q: [0.1 * number as f64].into(), p: [0.0].into() }))
}

#[test]
fn a_member_that_panics_stands_in_the_result_and_the_others_go_on() {
    let study = || Ensemble::new(member).by(Midpoint, 0.1).steps(100).every(30);
    let alone = study().ends(0..100).unwrap();
    for (number, end) in alone.iter().enumerate() {
        match end {
            Ok(end) => assert!(end.number == number as u64 && end.time > 9.9),
            Err(failure) => {
                assert!([70, 80].contains(&number) && failure.number == number as u64);
                assert!(failure.error == MemberError::Panicked && failure.last.is_some() == (number == 70));
                assert!(failure.to_string().contains(&format!("member {number}")), "{failure}");
            }
        }
    }
    assert_eq!(alone.iter().filter(|end| end.is_err()).count(), 2);
    let to_error = Ensemble::new(member).to_error(1e-3, 1.0).ends(0..100).unwrap();
    for (number, end) in to_error.iter().enumerate() {
        assert_eq!(end.err().map(|failure| failure.error), alone[number].err().map(|failure| failure.error));
    }
}
