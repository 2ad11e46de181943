//! Reference motions by another method: Dormand–Prince 8(5,3) of the crate `differential-equations`, on
//! accelerations derived on paper.

use differential_equations::prelude::{ExplicitRungeKutta, IVP, ODE};
use nalgebra::{SMatrix, SVector};

use crate::by_hand::ByHand;

/// Local relative and absolute tolerance; the global error stays below 1e-12 on the tests' short motions.
const TOLERANCE: f64 = 1e-14;

/// (q, v) at `time` of the motion that starts at (q, v).
///
/// # Panics
/// If the method gives up.
pub fn motion<S: ByHand<N>, const N: usize>(
    system: &S,
    q: [f64; N],
    v: [f64; N],
    time: f64,
) -> ([f64; N], [f64; N]) {
    let start = SMatrix::<f64, N, 2>::from_columns(&[SVector::from(q), SVector::from(v)]);
    let motion = Motion(system);
    let solution = IVP::ode(&motion, 0.0, time, start)
        .method(ExplicitRungeKutta::dop853().max_steps(usize::MAX))
        .rtol(TOLERANCE)
        .atol(TOLERANCE)
        .solve()
        .expect("the reference method reaches the end");
    let end = solution.y.last().expect("the reference method gives the end");
    (end.column(0).into_owned().into(), end.column(1).into_owned().into())
}

/// The equations of motion for the matrix with the columns q and v.
struct Motion<'a, S>(&'a S);

impl<S: ByHand<N>, const N: usize> ODE<f64, SMatrix<f64, N, 2>> for Motion<'_, S> {
    fn diff(&self, _time: f64, y: &SMatrix<f64, N, 2>, rate: &mut SMatrix<f64, N, 2>) {
        let (q, v) = (y.column(0).into_owned(), y.column(1).into_owned());
        rate.set_column(0, &v);
        rate.set_column(1, &SVector::from(self.0.acceleration(q.into(), v.into())));
    }
}
