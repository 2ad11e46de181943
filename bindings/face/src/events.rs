//! Event functions that the block of a system states, however many there are.

use dalembert::Lagrangian;
use dalembert::nalgebra::SVector;
use dalembert::system::{EventFunctions, Scalar};

/// The type of the values of all event functions of V: `[S; K]`, or `()` where there are none.
pub trait Events<V: Lagrangian<N>, const N: usize>: 'static {
    /// The values at (q, v).
    fn values(system: &V, q: &SVector<V::Scalar, N>, v: &SVector<V::Scalar, N>) -> impl AsRef<[V::Scalar]>;
}

impl<V: Lagrangian<N>, const N: usize> Events<V, N> for () {
    fn values(_: &V, _: &SVector<V::Scalar, N>, _: &SVector<V::Scalar, N>) -> impl AsRef<[V::Scalar]> {
        []
    }
}

impl<S, V, const N: usize, const K: usize> Events<V, N> for [S; K]
where
    S: Scalar,
    V: EventFunctions<N, K, Scalar = S>,
{
    fn values(system: &V, q: &SVector<S, N>, v: &SVector<S, N>) -> impl AsRef<[S]> {
        system.events(q, v)
    }
}
