//! The systems of the study, each written twice: L and R for the attribute, their slopes by hand for the
//! reference.
//!
//! ```text
//! L(q, v) = s l(x, u),   R(v) = s t r(u),   x = length q,   u = speed v
//! ```
//!
//! l and r are of order 1; s, length, speed and t are units, of any size.

use dalembert::rayleigh_system;

use super::equations::{Reference, Slopes, Vector};
use dalembert_tests::rounded::Rounded;

/// Units of action, length, velocity and time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    /// s.
    pub action: f64,
    /// x/q.
    pub length: f64,
    /// u/v.
    pub speed: f64,
    /// What r is multiplied by.
    pub rate: f64,
}

/// A system of the study with its two parameters.
pub trait Studied<const N: usize>: Reference<N> + Copy + std::fmt::Debug {
    /// What it is called in the tables.
    const NAME: &'static str;
    /// Coordinates from where x is drawn.
    const RANGE: [f64; 2];

    /// With the parameters `a` of l and `c` of r.
    fn new(a: f64, c: f64, units: Units) -> Self;
}

macro_rules! study {
    ($(
        $(#[$doc:meta])*
        $name:ident $(+ $by_dual:ident)? ($n:literal, $title:literal, $range:expr, [$($rule:ident),*])
        l = |$x:ident, $u:ident, $a:ident| $l:expr;
        r = |$w:ident, $c:ident| $r:expr;
        slopes = |$sx:ident, $su:ident, $sa:ident, $sc:ident| $slopes:expr;
    )*) => {$(
        system! {
            $(#[$doc])*
            $name($n, $title, $range, [$($rule),*], expanded)
            l = |$x, $u, $a| $l;
            r = |$w, $c| $r;
            slopes = |$sx, $su, $sa, $sc| $slopes;
        }
        $(system! {
            /// The system above, by dual numbers.
            $by_dual($n, concat!($title, ", by dual numbers"), $range, [midpoint, trapezoidal, gauss], num_dual)
            l = |$x, $u, $a| $l;
            r = |$w, $c| $r;
            slopes = |$sx, $su, $sa, $sc| $slopes;
        })?
    )*};
}

macro_rules! system {
    (
        $(#[$doc:meta])*
        $name:ident($n:literal, $title:expr, $range:expr, [$($rule:ident),*], $engine:ident)
        l = |$x:ident, $u:ident, $a:ident| $l:expr;
        r = |$w:ident, $c:ident| $r:expr;
        slopes = |$sx:ident, $su:ident, $sa:ident, $sc:ident| $slopes:expr;
    ) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $name {
            a: f64,
            c: f64,
            action: f64,
            length: f64,
            speed: f64,
            rate: f64,
        }

        #[rayleigh_system(rule = [$($rule),*], derivatives = $engine)]
        impl $name {
            fn lagrangian(&self, q: [f64; $n], v: [f64; $n]) -> f64 {
                self.action * Self::l(q.map(|q| q * self.length), v.map(|v| v * self.speed), self.a)
            }

            fn rayleigh(&self, v: [f64; $n]) -> f64 {
                self.action * self.rate * Self::r(v.map(|v| v * self.speed), self.c)
            }

            fn l($x: [f64; $n], $u: [f64; $n], $a: f64) -> f64 {
                $l
            }

            fn r($w: [f64; $n], $c: f64) -> f64 {
                $r
            }
        }

        impl Reference<$n> for $name {
            fn slopes(&self, q: &Vector<$n>, v: &Vector<$n>) -> Slopes<$n> {
                let exact = Rounded::exact;
                let ($sx, $su) = (q.map(|q| q * self.length), v.map(|v| v * self.speed));
                let ($sa, $sc) = (exact(self.a), exact(self.c));
                let (force, momentum, drag): (Vector<$n>, Vector<$n>, Vector<$n>) = $slopes;
                let of = |slopes: Vector<$n>, units: &[f64]| slopes.map(|slope| in_units(slope, units));
                Slopes {
                    force: of(force, &[self.action, self.length]),
                    momentum: of(momentum, &[self.action, self.speed]),
                    drag: of(drag, &[self.action, self.speed, self.rate]),
                }
            }

            fn mass_and_damping(&self) -> [Rounded; 2] {
                let mass = Rounded::exact(self.action) * self.speed * self.speed;
                [mass, mass * self.rate * self.c]
            }
        }

        impl Studied<$n> for $name {
            const NAME: &'static str = $title;
            const RANGE: [f64; 2] = $range;

            fn new(a: f64, c: f64, units: Units) -> Self {
                let Units { action, length, speed, rate } = units;
                Self { a, c, action, length, speed, rate }
            }
        }
    };
}

/// A slope in its `units`, with what underflows if it is multiplied by some of them before the others.
fn in_units(slope: Rounded, units: &[f64]) -> Rounded {
    let [first, others @ ..] = units else { return slope };
    let product = others.iter().fold(Rounded::exact(*first), |product, unit| product * *unit);
    let largest: f64 = units.iter().map(|unit| unit.max(1.0)).product();
    let mut scaled = product * slope;
    scaled.error += largest * f64::MIN_POSITIVE * f64::EPSILON;
    scaled
}

/// |u|², for the reference.
fn square<const N: usize>(u: &Vector<N>) -> Rounded {
    u.iter().map(|u| *u * *u).sum()
}

/// The slope of c√(u² + 10⁻⁴), dry friction made smooth.
fn dry<const N: usize>(u: &Vector<N>, c: Rounded) -> Vector<N> {
    u.map(|u| c * u / (u * u + 1e-4).sqrt())
}

/// 24(2x⁻¹³ − x⁻⁷)a/6 … of 4a(x⁻¹² − x⁻⁶).
fn lennard_jones(x: Rounded, a: Rounded) -> Rounded {
    let sixth = x.power(6).recip();
    a * (sixth * sixth * 48.0 + -(sixth * 24.0)) / x
}

study! {
    /// ½u² − ½ax², linear damping.
    Harmonic(1, "oscillator", [-3.0, 3.0], [midpoint, trapezoidal, one_sided, gauss, fitted, fitted_trapezoidal])
    l = |x, u, a| 0.5 * u[0] * u[0] - 0.5 * a * x[0] * x[0];
    r = |u, c| 0.5 * c * u[0] * u[0];
    slopes = |x, u, a, c| ([-(a * x[0])], [u[0]], [c * u[0]]);

    /// A mass between two springs, whose forces cancel at 0.
    Springs + SpringsByDual(1, "between two springs", [-1.5, 1.5], [midpoint, trapezoidal, one_sided, gauss])
    l = |x, u, a| {
        let (left, right) = (x[0] + a, x[0] - a);
        0.5 * u[0] * u[0] - 0.5 * a * (left * left + right * right)
    };
    r = |u, c| 0.5 * c * u[0] * u[0];
    slopes = |x, u, a, c| ([-(a * (x[0] + a)) - a * (x[0] - a)], [u[0]], [c * u[0]]);

    /// A bob over three magnets, whose forces cancel at 0 and wherever it comes to rest.
    Magnets + MagnetsByDual(2, "three magnets", [-1.5, 1.5], [midpoint, trapezoidal, one_sided, gauss])
    l = |x, u, a| {
        let mut sum = 0.5 * (u[0] * u[0] + u[1] * u[1]);
        for [mx, my] in [[1.0, 0.0], [-0.5, 0.75], [-0.5, -0.75]] {
            let (d, e) = (x[0] - mx, x[1] - my);
            sum += a / (d * d + e * e + 0.25).sqrt();
        }
        sum - 0.5 * (x[0] * x[0] + x[1] * x[1])
    };
    r = |u, c| 0.5 * c * (u[0] * u[0] + u[1] * u[1]);
    slopes = |x, u, a, c| {
        let mut force = x.map(|x| -x);
        for [mx, my] in [[1.0, 0.0], [-0.5, 0.75], [-0.5, -0.75]] {
            let d = [x[0] + -mx, x[1] + -my];
            let cube = (square(&d) + 0.25).sqrt().power(3);
            force = [force[0] - a * d[0] / cube, force[1] - a * d[1] / cube];
        }
        (force, u, u.map(|u| c * u))
    };

    /// A chain of four springs with dampers between.
    Chain + ChainByDual(4, "chain of springs", [-3.0, 3.0], [midpoint, trapezoidal, one_sided, gauss])
    l = |x, u, a| {
        let mut sum = 0.5 * (u[0] * u[0] + u[1] * u[1] + u[2] * u[2] + u[3] * u[3]) - 0.5 * a * x[0] * x[0];
        for i in 1..4 {
            let d = x[i] - x[i - 1];
            sum -= 0.5 * a * d * d;
        }
        sum
    };
    r = |u, c| {
        let mut sum = 0.0;
        for i in 1..4 {
            let d = u[i] - u[i - 1];
            sum += 0.5 * c * d * d;
        }
        sum
    };
    slopes = |x, u, a, c| {
        let (mut force, mut drag) = ([Rounded::ZERO; 4], [Rounded::ZERO; 4]);
        force[0] = -(a * x[0]);
        for i in 1..4 {
            let (pull, damp) = (a * (x[i] - x[i - 1]), c * (u[i] - u[i - 1]));
            (force[i], force[i - 1]) = (force[i] - pull, force[i - 1] + pull);
            (drag[i], drag[i - 1]) = (drag[i] + damp, drag[i - 1] - damp);
        }
        (force, u, drag)
    };

    /// ½u² − ¼ax⁴, cubic drag made smooth by its power: r = cu⁴/4.
    Quartic(1, "quartic, drag u³", [-3.0, 3.0], [midpoint, trapezoidal, one_sided, gauss])
    l = |x, u, a| 0.5 * u[0] * u[0] - 0.25 * a * x[0].powi(4);
    r = |u, c| 0.25 * c * u[0].powi(4);
    slopes = |x, u, a, c| ([-(a * x[0].power(3))], [u[0]], [c * u[0].power(3)]);

    /// The ring of Marsden and West, s(s − 1)².
    Ring + RingByDual(2, "ring", [-1.5, 1.5], [midpoint, trapezoidal, one_sided, gauss, fitted, fitted_trapezoidal])
    l = |x, u, a| {
        let s = x[0] * x[0] + x[1] * x[1];
        0.5 * (u[0] * u[0] + u[1] * u[1]) - a * s * (s - 1.0) * (s - 1.0)
    };
    r = |u, c| 0.5 * c * (u[0] * u[0] + u[1] * u[1]);
    slopes = |x, u, a, c| {
        let s = square(&x);
        let d = (s + -1.0) * (s + -1.0) + s * (s + -1.0) * 2.0;
        (x.map(|x| -(a * d * x * 2.0)), u, u.map(|u| c * u))
    };

    /// A pendulum.
    Pendulum + PendulumByDual(1, "pendulum", [-7.0, 7.0], [midpoint, trapezoidal, one_sided, gauss, fitted, fitted_trapezoidal])
    l = |x, u, a| 0.5 * u[0] * u[0] + a * x[0].cos();
    r = |u, c| 0.5 * c * u[0] * u[0];
    slopes = |x, u, a, c| ([-(a * x[0].sin_cos().0)], [u[0]], [c * u[0]]);

    /// A double pendulum, whose masses depend on the angles.
    DoublePendulum + DoublePendulumByDual(2, "double pendulum", [-3.0, 3.0], [midpoint, trapezoidal, one_sided, gauss])
    l = |x, u, a| {
        u[0] * u[0] + 0.5 * u[1] * u[1] + u[0] * u[1] * (x[0] - x[1]).cos()
            + a * (2.0 * x[0].cos() + x[1].cos())
    };
    r = |u, c| 0.5 * c * (u[0] * u[0] + u[1] * u[1]);
    slopes = |x, u, a, c| {
        let (sine, cosine) = (x[0] - x[1]).sin_cos();
        let turn = u[0] * u[1] * sine;
        let force = [-(a * x[0].sin_cos().0 * 2.0) - turn, turn - a * x[1].sin_cos().0];
        (force, [u[0] * 2.0 + u[1] * cosine, u[1] + u[0] * cosine], u.map(|u| c * u))
    };

    /// Lennard-Jones, 4a(x⁻¹² − x⁻⁶).
    LennardJones + LennardJonesByDual(1, "Lennard-Jones", [0.6, 3.0], [midpoint, trapezoidal, one_sided, gauss, fitted, fitted_trapezoidal])
    l = |x, u, a| 0.5 * u[0] * u[0] - 4.0 * a * (x[0].powi(-12) - x[0].powi(-6));
    r = |u, c| 0.5 * c * u[0] * u[0];
    slopes = |x, u, a, c| ([lennard_jones(x[0], a)], [u[0]], [c * u[0]]);

    /// Three of them on a line, the first to a wall.
    Atoms(3, "Lennard-Jones line", [0.7, 2.0], [midpoint, trapezoidal, one_sided, gauss])
    l = |x, u, a| {
        let mut sum = 0.5 * (u[0] * u[0] + u[1] * u[1] + u[2] * u[2])
            - 4.0 * a * (x[0].powi(-12) - x[0].powi(-6));
        for i in 1..3 {
            let d = x[i] + 1.2 * x[i - 1];
            sum -= 4.0 * a * (d.powi(-12) - d.powi(-6));
        }
        sum
    };
    r = |u, c| 0.5 * c * (u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    slopes = |x, u, a, c| {
        let mut force = [lennard_jones(x[0], a), Rounded::ZERO, Rounded::ZERO];
        for i in 1..3 {
            let push = lennard_jones(x[i] + x[i - 1] * 1.2, a);
            force[i] = force[i] + push;
            force[i - 1] = force[i - 1] + push * 1.2;
        }
        (force, u, u.map(|u| c * u))
    };

    /// e^{−ax}.
    Exponential(1, "exponential", [-5.0, 10.0], [midpoint, trapezoidal, one_sided, gauss, fitted, fitted_trapezoidal])
    l = |x, u, a| 0.5 * u[0] * u[0] - (-(a * x[0])).exp();
    r = |u, c| 0.5 * c * u[0] * u[0];
    slopes = |x, u, a, c| ([a * (-(a * x[0])).exp()], [u[0]], [c * u[0]]);

    /// Toda's lattice, e^{x₀ − x₁} + e^{x₁ − x₂}.
    Toda + TodaByDual(3, "Toda lattice", [-3.0, 3.0], [midpoint, trapezoidal, one_sided, gauss, fitted, fitted_trapezoidal])
    l = |x, u, a| {
        0.5 * (u[0] * u[0] + u[1] * u[1] + u[2] * u[2]) - a * ((x[0] - x[1]).exp() + (x[1] - x[2]).exp())
    };
    r = |u, c| 0.5 * c * (u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    slopes = |x, u, a, c| {
        let (one, two) = (a * (x[0] - x[1]).exp(), a * (x[1] - x[2]).exp());
        ([-one, one - two, two], u, u.map(|u| c * u))
    };

    /// Morse, a(1 − e^{−x})².
    Morse(1, "Morse", [-1.5, 5.0], [midpoint, trapezoidal, one_sided, gauss])
    l = |x, u, a| {
        let d = 1.0 - (-x[0]).exp();
        0.5 * u[0] * u[0] - a * d * d
    };
    r = |u, c| 0.5 * c * u[0] * u[0];
    slopes = |x, u, a, c| {
        let e = (-x[0]).exp();
        ([-(a * (-e + 1.0) * e * 2.0)], [u[0]], [c * u[0]])
    };

    /// Two Morse bonds with dry friction made smooth.
    MorseDry(2, "Morse, dry friction", [-1.0, 3.0], [midpoint, trapezoidal, one_sided, gauss])
    l = |x, u, a| {
        let (d, e) = (1.0 - (-x[0]).exp(), 1.0 - (x[0] - x[1]).exp());
        0.5 * (u[0] * u[0] + u[1] * u[1]) - a * (d * d + e * e)
    };
    r = |u, c| c * ((u[0] * u[0] + 1e-4).sqrt() + (u[1] * u[1] + 1e-4).sqrt());
    slopes = |x, u, a, c| {
        let (one, two) = ((-x[0]).exp(), (x[0] - x[1]).exp());
        let (one, two) = (a * (-one + 1.0) * one * 2.0, a * (-two + 1.0) * two * 2.0);
        ([two - one, -two], u, dry(&u, c))
    };

    /// Kepler's problem in the plane.
    Kepler(2, "Kepler, plane", [-2.0, 2.0], [midpoint, trapezoidal, one_sided, gauss, fitted, fitted_trapezoidal])
    l = |x, u, a| 0.5 * (u[0] * u[0] + u[1] * u[1]) + a / (x[0] * x[0] + x[1] * x[1]).sqrt();
    r = |u, c| 0.5 * c * (u[0] * u[0] + u[1] * u[1]);
    slopes = |x, u, a, c| {
        let r = square(&x).sqrt();
        (x.map(|x| -(a * x / r.power(3))), u, u.map(|u| c * u))
    };

    /// In space, with quadratic air drag.
    KeplerDrag + KeplerDragByDual(3, "Kepler, space, air", [-2.0, 2.0], [midpoint, trapezoidal, one_sided, gauss])
    l = |x, u, a| {
        0.5 * (u[0] * u[0] + u[1] * u[1] + u[2] * u[2])
            + a / (x[0] * x[0] + x[1] * x[1] + x[2] * x[2]).sqrt()
    };
    r = |u, c| c * (u[0] * u[0] + u[1] * u[1] + u[2] * u[2]).sqrt().powi(3) / 3.0;
    slopes = |x, u, a, c| {
        let (r, speed) = (square(&x).sqrt(), square(&u).sqrt());
        (x.map(|x| -(a * x / r.power(3))), u, u.map(|u| c * speed * u))
    };

    /// A soft and a stiff spring, 10⁶ apart, coupled by a quartic.
    Stiff(2, "stiff pair", [-1.0, 1.0], [midpoint, trapezoidal, one_sided, gauss])
    l = |x, u, a| {
        let d = x[1] - x[0];
        0.5 * (u[0] * u[0] + u[1] * u[1]) - 0.5 * a * x[0] * x[0] - 0.5e6 * x[1] * x[1]
            - 0.25 * d * d * d * d
    };
    r = |u, c| 0.5 * c * (u[0] * u[0] + 1e3 * u[1] * u[1]);
    slopes = |x, u, a, c| {
        let pull = (x[1] - x[0]).power(3);
        ([pull - a * x[0], -(x[1] * 1e6) - pull], u, [c * u[0], c * u[1] * 1e3])
    };

    /// Fermi, Pasta, Ulam and Tsingou: four masses, quartic springs.
    Fermi(4, "FPUT chain", [-1.5, 1.5], [midpoint, trapezoidal, one_sided, gauss])
    l = |x, u, a| {
        let mut sum = 0.5 * (u[0] * u[0] + u[1] * u[1] + u[2] * u[2] + u[3] * u[3]) - 0.5 * x[0] * x[0];
        for i in 1..4 {
            let d = x[i] - x[i - 1];
            sum -= 0.5 * d * d + 0.25 * a * d * d * d * d;
        }
        sum
    };
    r = |u, c| 0.5 * c * (u[0] * u[0] + u[1] * u[1] + u[2] * u[2] + u[3] * u[3]);
    slopes = |x, u, a, c| {
        let mut force = [-x[0], Rounded::ZERO, Rounded::ZERO, Rounded::ZERO];
        for i in 1..4 {
            let d = x[i] - x[i - 1];
            let pull = d + a * d.power(3);
            (force[i], force[i - 1]) = (force[i] - pull, force[i - 1] + pull);
        }
        (force, u, u.map(|u| c * u))
    };

    /// Kepler in polar coordinates: a mass that depends on x.
    Polar + PolarByDual(2, "Kepler, polar", [0.2, 3.0], [midpoint, trapezoidal, one_sided, gauss])
    l = |x, u, a| 0.5 * (u[0] * u[0] + x[0] * x[0] * u[1] * u[1]) + a / x[0];
    r = |u, c| 0.5 * c * (u[0] * u[0] + u[1] * u[1]);
    slopes = |x, u, a, c| {
        let force = [x[0] * u[1] * u[1] - a / (x[0] * x[0]), Rounded::ZERO];
        (force, [u[0], x[0] * x[0] * u[1]], u.map(|u| c * u))
    };

    /// Gravity with quadratic air drag in the plane.
    Shot(2, "gravity, air", [-3.0, 3.0], [midpoint, trapezoidal, one_sided, gauss])
    l = |x, u, a| 0.5 * (u[0] * u[0] + u[1] * u[1]) - a * x[1] - 0.0 * x[0];
    r = |u, c| {
        let square = u[0] * u[0] + u[1] * u[1];
        c * square * square.sqrt() / 3.0
    };
    slopes = |x, u, a, c| {
        let (_, speed) = (x, square(&u).sqrt());
        ([Rounded::ZERO, -a], u, u.map(|u| c * speed * u))
    };

    /// A spring with dry friction made smooth, four coordinates.
    Blocks(4, "blocks, dry friction", [-2.0, 2.0], [midpoint, trapezoidal, one_sided, gauss])
    l = |x, u, a| {
        let kinetic = 0.5 * (u[0] * u[0] + u[1] * u[1] + u[2] * u[2] + u[3] * u[3]);
        let (d, e, f) = (x[1] - x[0], x[2] - x[1], x[3] - x[2]);
        kinetic - 0.5 * a * (x[0] * x[0] + d * d + e * e + f * f)
    };
    r = |u, c| {
        c * ((u[0] * u[0] + 1e-4).sqrt() + (u[1] * u[1] + 1e-4).sqrt() + (u[2] * u[2] + 1e-4).sqrt()
            + (u[3] * u[3] + 1e-4).sqrt())
    };
    slopes = |x, u, a, c| {
        let mut force = [-(a * x[0]), Rounded::ZERO, Rounded::ZERO, Rounded::ZERO];
        for i in 1..4 {
            let pull = a * (x[i] - x[i - 1]);
            (force[i], force[i - 1]) = (force[i] - pull, force[i - 1] + pull);
        }
        (force, u, dry(&u, c))
    };

    /// A centrifugal barrier, ½ax² + x⁻².
    Barrier(1, "barrier, drag u³", [0.05, 3.0], [midpoint, trapezoidal, one_sided, gauss])
    l = |x, u, a| 0.5 * u[0] * u[0] - 0.5 * a * x[0] * x[0] - 1.0 / (x[0] * x[0]);
    r = |u, c| 0.25 * c * u[0].powi(4);
    slopes = |x, u, a, c| ([x[0].power(3).recip() * 2.0 - a * x[0]], [u[0]], [c * u[0].power(3)]);

    /// A momentum that saturates, u/√(1 + u²).
    Saturating(1, "saturating mass", [-3.0, 3.0], [midpoint, trapezoidal, one_sided, gauss])
    l = |x, u, a| (1.0 + u[0] * u[0]).sqrt() - 0.5 * a * x[0] * x[0];
    r = |u, c| 0.5 * c * u[0] * u[0];
    slopes = |x, u, a, c| ([-(a * x[0])], [u[0] / (u[0] * u[0] + 1.0).sqrt()], [c * u[0]]);

    /// A momentum u + u³ on a pendulum's potential.
    Steep(1, "mass u + u³", [-3.0, 3.0], [midpoint, trapezoidal, one_sided, gauss])
    l = |x, u, a| 0.5 * u[0] * u[0] + 0.25 * u[0].powi(4) + a * x[0].cos();
    r = |u, c| 0.5 * c * u[0] * u[0];
    slopes = |x, u, a, c| ([-(a * x[0].sin_cos().0)], [u[0] + u[0].power(3)], [c * u[0]]);
}
