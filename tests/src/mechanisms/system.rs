//! Mechanisms as systems: the text that the attribute differentiates.

use super::{Shape, Values};

/// A mechanism of N coordinates with M constraints, made of [`mechanism!`](crate::mechanism).
pub trait Mechanism<const N: usize, const M: usize>: Sized {
    /// What it is made of.
    const SHAPE: Shape;

    /// The mechanism with these numbers.
    fn of(values: &Values) -> Self;
}

/// Declares a mechanism, with its [`Shape`] besides: coordinates of a body, of which the first ones, those of
/// space, are a place, and one more is the angle of a bar. Joints and forces are numbered in the order of
/// their kinds here. The text is written out for each of them: no loop over data is left to the attribute.
#[macro_export]
macro_rules! mechanism {
    (
        $(#[$doc:meta])*
        $name:ident: $n:literal coordinates, $per:literal of a body in $space:literal, $m:literal joints, $f:literal forces,
        square [$(($a:literal: $ai:literal $aj:literal))*]
        length [$(($b:literal: $bi:literal $bj:literal))*]
        ground [$(($c:literal: $ci:literal))*]
        plane [$(($d:literal: $di:literal))*]
        hinge [$(($e:literal $e1:literal: $ei:literal $ej:literal))*]
        pin [$(($p:literal $p1:literal: $pi:literal))*]
        spring [$(($s:literal: $si:literal $sj:literal))*]
        tether [$(($t:literal: $ti:literal))*]
        twist [$(($w:literal: $wi:literal $wj:literal))*]
    ) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $name {
            mass: [f64; $n],
            drag: [f64; $n],
            cubic: [f64; $n],
            gravity: [f64; 3],
            joints: [[f64; 7]; $m],
            forces: [[f64; 6]; $f],
        }

        impl $crate::mechanisms::Mechanism<$n, $m> for $name {
            const SHAPE: $crate::mechanisms::Shape = {
                use $crate::mechanisms::{Force, Joint, Shape};
                Shape {
                    name: stringify!($name),
                    per_body: $per,
                    space: $space,
                    joints: &[
                        $(Joint::Square($ai, $aj),)*
                        $(Joint::Length($bi, $bj),)*
                        $(Joint::Ground($ci),)*
                        $(Joint::Plane($di),)*
                        $(Joint::HingeAlong($ei, $ej), Joint::HingeAcross($ei, $ej),)*
                        $(Joint::PinAlong($pi), Joint::PinAcross($pi),)*
                    ],
                    forces: &[
                        $(Force::Spring($si, $sj),)*
                        $(Force::Tether($ti),)*
                        $(Force::Twist($wi, $wj),)*
                    ],
                }
            };

            fn of(values: &$crate::mechanisms::Values) -> Self {
                Self {
                    mass: core::array::from_fn(|i| values.mass[i]),
                    drag: core::array::from_fn(|i| values.drag[i]),
                    cubic: core::array::from_fn(|i| values.cubic[i]),
                    gravity: values.gravity,
                    joints: core::array::from_fn(|k| values.joints[k].numbers()),
                    forces: core::array::from_fn(|k| values.forces[k].numbers()),
                }
            }
        }

        #[dalembert::rayleigh_system(rule = [midpoint, trapezoidal], derivatives = expanded)]
        impl $name {
            fn lagrangian(&self, q: [f64; $n], v: [f64; $n]) -> f64 {
                let mut l = 0.0;
                for i in 0..$n {
                    l += 0.5 * self.mass[i] * v[i] * v[i];
                }
                for i in 0..$n / $per {
                    for k in 0..$space {
                        l += self.mass[$per * i + k] * self.gravity[k] * q[$per * i + k];
                    }
                }
                $(
                    let mut square = 0.0;
                    for k in 0..$space {
                        square += (q[$per * $si + k] - q[$per * $sj + k]).powi(2);
                    }
                    l -= 0.5 * self.forces[$s][0] * (square.sqrt() - self.forces[$s][1]).powi(2);
                )*
                $(
                    let mut square = 0.0;
                    for k in 0..$space {
                        square += (q[$per * $ti + k] - self.forces[$t][3 + k]).powi(2);
                    }
                    l -= 0.5 * self.forces[$t][0] * square + 0.25 * self.forces[$t][1] * square * square;
                )*
                $(
                    let twist = q[$per * $wi + 2] - q[$per * $wj + 2] - self.forces[$w][1];
                    l -= 0.5 * self.forces[$w][0] * twist * twist;
                )*
                l
            }

            fn rayleigh(&self, q: [f64; $n], v: [f64; $n]) -> f64 {
                let mut r = 0.0;
                for i in 0..$n {
                    r += 0.5 * self.drag[i] * v[i] * v[i] + 0.25 * self.cubic[i] * v[i].powi(4);
                }
                $(
                    let mut square = 0.0;
                    let mut rate = 0.0;
                    for k in 0..$space {
                        let d = q[$per * $si + k] - q[$per * $sj + k];
                        square += d * d;
                        rate += d * (v[$per * $si + k] - v[$per * $sj + k]);
                    }
                    r += 0.5 * self.forces[$s][2] * rate * rate / square;
                )*
                $(
                    r += 0.5 * self.forces[$w][2] * (v[$per * $wi + 2] - v[$per * $wj + 2]).powi(2);
                )*
                r
            }

            fn constraints(&self, q: [f64; $n]) -> [f64; $m] {
                [
                    $({
                        let mut square = 0.0;
                        for k in 0..$space {
                            square += (q[$per * $ai + k] - q[$per * $aj + k]).powi(2);
                        }
                        self.joints[$a][0] * 0.5 * (square - self.joints[$a][1] * self.joints[$a][1])
                    },)*
                    $({
                        let mut square = 0.0;
                        for k in 0..$space {
                            square += (q[$per * $bi + k] - q[$per * $bj + k]).powi(2);
                        }
                        self.joints[$b][0] * (square.sqrt() - self.joints[$b][1])
                    },)*
                    $({
                        let mut square = 0.0;
                        for k in 0..$space {
                            square += (q[$per * $ci + k] - self.joints[$c][4 + k]).powi(2);
                        }
                        self.joints[$c][0] * 0.5 * (square - self.joints[$c][1] * self.joints[$c][1])
                    },)*
                    $({
                        let mut sum = -self.joints[$d][1];
                        for k in 0..$space {
                            sum += q[$per * $di + k] * self.joints[$d][4 + k];
                        }
                        self.joints[$d][0] * sum
                    },)*
                    $(
                        self.joints[$e][0]
                            * (q[$per * $ei] + self.joints[$e][2] * q[$per * $ei + 2].cos()
                                - q[$per * $ej]
                                - self.joints[$e][3] * q[$per * $ej + 2].cos()),
                        self.joints[$e1][0]
                            * (q[$per * $ei + 1] + self.joints[$e1][2] * q[$per * $ei + 2].sin()
                                - q[$per * $ej + 1]
                                - self.joints[$e1][3] * q[$per * $ej + 2].sin()),
                    )*
                    $(
                        self.joints[$p][0]
                            * (q[$per * $pi] + self.joints[$p][2] * q[$per * $pi + 2].cos() - self.joints[$p][4]),
                        self.joints[$p1][0]
                            * (q[$per * $pi + 1] + self.joints[$p1][2] * q[$per * $pi + 2].sin() - self.joints[$p1][5]),
                    )*
                ]
            }
        }
    };
}
