//! Functions of a system's block whose values alone are asked for, however many numbers they return.

use dalembert::Lagrangian;
use dalembert::nalgebra::SVector;
use dalembert::system::{EventFunctions, OutputFunctions, Scalar};

macro_rules! of_block {
    ($($(#[$doc:meta])* $name:ident: $of_trait:ident, $function:ident;)*) => { $(
        $(#[$doc])*
        pub trait $name<V: Lagrangian<N>, const N: usize>: 'static {
            /// The values at (q, v).
            fn values(system: &V, q: &SVector<V::Scalar, N>, v: &SVector<V::Scalar, N>) -> impl AsRef<[V::Scalar]>;
        }

        impl<V: Lagrangian<N>, const N: usize> $name<V, N> for () {
            fn values(_: &V, _: &SVector<V::Scalar, N>, _: &SVector<V::Scalar, N>) -> impl AsRef<[V::Scalar]> {
                []
            }
        }

        impl<S, V, const N: usize, const K: usize> $name<V, N> for [S; K]
        where
            S: Scalar,
            V: $of_trait<N, K, Scalar = S>,
        {
            fn values(system: &V, q: &SVector<S, N>, v: &SVector<S, N>) -> impl AsRef<[S]> {
                system.$function(q, v)
            }
        }
    )* };
}

of_block! {
    /// The type of the values of all event functions of V: `[S; K]`, or `()` where there are none.
    Events: EventFunctions, events;
    /// The type of the values of all outputs of V: `[S; K]`, or `()` where there are none.
    Outputs: OutputFunctions, outputs;
}
