//! The library of vectors and matrices that states and derivatives are of,
//! [nalgebra](https://docs.rs/nalgebra), with its [`vector!`] and [`matrix!`]: those of nalgebra itself name
//! a crate `nalgebra`, which a crate that depends on dalembert alone has not.
//!
//! ```
//! use dalembert::nalgebra::{Matrix2, Vector3, matrix, vector};
//!
//! const V: Vector3<f64> = vector![1.0, 2.0, 3.0];
//! const M: Matrix2<f64> = matrix![1.0, 2.0;
//!                                 3.0, 4.0];
//! assert_eq!((V[2], M[(0, 1)], M[(1, 0)]), (3.0, 2.0, 3.0));
//! ```

#[doc(no_inline)]
pub use ::nalgebra::*;

/// A vector of its entries, `vector![1.0, 2.0]`: an `SVector`, also of constants.
#[doc(hidden)]
#[macro_export]
macro_rules! __vector {
    ($($entry:expr),* $(,)?) => {
        $crate::nalgebra::SMatrix::from_array_storage($crate::nalgebra::ArrayStorage([[$($entry),*]]))
    };
}

/// A matrix row by row, `matrix![1.0, 2.0; 3.0, 4.0]`: an `SMatrix`, also of constants.
#[doc(hidden)]
#[macro_export]
macro_rules! __matrix {
    ($($($entry:expr),+);+ $(;)?) => {
        $crate::nalgebra::SMatrix::from_array_storage($crate::nalgebra::ArrayStorage(
            $crate::nalgebra::columns([$([$($entry),+]),+]),
        ))
    };
}

#[doc(inline)]
pub use {__matrix as matrix, __vector as vector};

/// The columns of a matrix given by its rows.
#[doc(hidden)]
#[must_use]
pub const fn columns<T: Copy, const R: usize, const C: usize>(rows: [[T; C]; R]) -> [[T; R]; C] {
    let mut columns = [[rows[0][0]; R]; C];
    let mut i = 0;
    while i < R {
        let mut j = 0;
        while j < C {
            columns[j][i] = rows[i][j];
            j += 1;
        }
        i += 1;
    }
    columns
}
