//! Systems in any units: where a run starts, no sound one is refused, and a wrong derivative is told where
//! differences can tell it.

use dalembert::step::Flow;
use dalembert::system::{Compared, Derivatives, GeneratedDiffers, Structure, verification};
use dalembert::{Lagrangian, Midpoint, State, StepError, Trapezoidal, rayleigh_system};
use nalgebra::SVector;

use super::Spread;

/// A particle and a cart in a field of waves and steps of the length `l`, the energy `e` and the time `tau`.
macro_rules! in_units {
    ($name:ident of $scalar:ident within $decades:literal) => {
        pub mod $name {
            use super::*;

            #[derive(Clone, Copy, Debug)]
            pub struct Waves {
                pub m: [$scalar; 2],
                pub l: $scalar,
                pub e: $scalar,
                pub tau: $scalar,
                pub k: $scalar,
                pub c: $scalar,
                pub table: [$scalar; 4],
            }

            #[rayleigh_system(derivatives = expanded, rule = [midpoint, trapezoidal])]
            impl Waves {
                fn lagrangian(&self, q: [$scalar; 2], v: [$scalar; 2]) -> $scalar {
                    let (x, y) = (q[0] / self.l, q[1] / self.l);
                    let mut height = self.table[3];
                    for i in 0..3 {
                        let a = i as $scalar - 1.0;
                        if y >= a && y < a + 1.0 {
                            height = self.table[i] + (self.table[i + 1] - self.table[i]) * (y - a);
                        }
                    }
                    0.5 * self.m[0] * v[0] * v[0] + 0.5 * self.m[1] * v[1] * v[1]
                        - self.e * (1.0 - x.cos())
                        - self.e * (height + 0.5 * y * y)
                        - 0.5 * self.k * (q[0] - q[1]) * (q[0] - q[1])
                }

                fn rayleigh(&self, v: [$scalar; 2]) -> $scalar {
                    let w = v[1] * self.tau / self.l;
                    0.5 * self.c * v[0] * v[0] + self.e / self.tau * ((1.0 + w * w).sqrt() - 1.0)
                }

                fn force(&self, q: [$scalar; 2], v: [$scalar; 2]) -> [$scalar; 2] {
                    [self.e / self.l * (q[0] / self.l + 0.3).sin(), -self.c * v[1]]
                }
            }

            /// The functions of one system, the derivatives of L of another.
            struct Mixed {
                written: Waves,
                derivatives: Waves,
            }

            type Vector = SVector<$scalar, 2>;

            impl Lagrangian<2> for Mixed {
                type Scalar = $scalar;
                const STRUCTURE: Structure = <Waves as Lagrangian<2>>::STRUCTURE;

                fn lagrangian(&self, q: &Vector, v: &Vector) -> $scalar {
                    Lagrangian::lagrangian(&self.written, q, v)
                }

                fn lagrangian_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<$scalar, 2> {
                    self.derivatives.lagrangian_derivatives(q, v)
                }

                fn verify_slopes(&self, q: &Vector, v: &Vector) -> Result<(), GeneratedDiffers> {
                    verification::lagrangian_slope(self, q, v)
                }
            }

            /// Units, and how far each constant is from 1 in them.
            fn random(random: &mut Spread, units: Units) -> (Waves, State<$scalar, 2>, $scalar) {
                let sign = |random: &mut Spread| if random.next() < 0.5 { -1.0 } else { 1.0 };
                // Farther out what three constants and a square make underflows in a derivative, and not in
                // the function: the derivative is then wrong, and refused.
                let decades = match units {
                    Units::Everything => $decades,
                    Units::Anything => $decades / 4.0,
                    Units::Consistent => $decades / 6.0,
                };
                let scale = |random: &mut Spread| 10.0_f64.powf(decades * (2.0 * random.next() - 1.0));
                let near_one = |random: &mut Spread| 0.2 + 1.6 * random.next();
                let (l, e, tau) = (scale(random), scale(random), scale(random));
                let units = match units {
                    Units::Everything | Units::Anything => [(); 6].map(|()| scale(random)),
                    Units::Consistent => {
                        let m = e * (tau / l).powi(2);
                        [m, m, e / l / l, m / tau, l, m * l / tau]
                    }
                };
                let [m0, m1, k, c, length, momentum] = units;
                let of = |scale: f64| scale as $scalar;
                let waves = Waves {
                    m: [of(m0 * near_one(random)), of(m1 * near_one(random))],
                    l: of(l),
                    e: of(e),
                    tau: of(tau),
                    k: of(k * near_one(random)),
                    c: of(c * near_one(random)),
                    table: [(); 4].map(|()| of(near_one(random))),
                };
                let entry = |scale: f64, random: &mut Spread| {
                    let kind = random.next();
                    let near = if kind < 0.2 {
                        0.0
                    } else if kind < 0.4 {
                        10.0_f64.powf(-8.0 * random.next())
                    } else {
                        near_one(random)
                    };
                    of(scale * near * sign(random))
                };
                let q = Vector::new(entry(length, random), entry(length, random));
                let p = Vector::new(entry(momentum, random), entry(momentum, random));
                let h = of(tau * 10.0_f64.powf(1.0 - 4.0 * random.next()));
                (waves, State { q, p }, h)
            }

            /// How many of so many sound starts are refused: by slopes, momenta, and second derivatives.
            pub fn refused(units: Units, count: usize) -> [usize; 3] {
                let mut source = Spread(31);
                let mut refused = [0; 3];
                for _ in 0..count {
                    let (waves, start, h) = random(&mut source, units);
                    let slopes = start.verify(&waves);
                    let momenta = Flow::<Midpoint, 2>::verify_momenta(&waves, &start, h)
                        .and_then(|()| Flow::<Trapezoidal, 2>::verify_momenta(&waves, &start, h))
                        .map_err(StepError::from);
                    for (i, verdict) in [slopes, momenta].into_iter().enumerate() {
                        if let Err(StepError::GeneratedDiffers { compared, .. }) = verdict {
                            let i = if compared == Compared::SecondDerivative { 2 } else { i };
                            if refused[i] < 3 {
                                println!("{waves:?} at {start:?}, h = {h:e}: {verdict:?}");
                            }
                            refused[i] += 1;
                        }
                    }
                }
                refused
            }

            /// Of so many starts, those at which the derivatives of another system are told: another wave,
            /// by a share of itself.
            pub fn told(units: Units, count: usize, share: f64) -> usize {
                let mut source = Spread(32);
                let is_told = |_: &usize| {
                    let (written, start, _) = random(&mut source, units);
                    let changed = 1.0 + share as $scalar;
                    let derivatives = Waves { e: written.e * changed, ..written };
                    start.verify(&Mixed { written, derivatives }).is_err()
                };
                (0..count).filter(is_told).count()
            }
        }
    };
}

/// How the constants of a system are drawn.
#[derive(Clone, Copy, Debug)]
pub enum Units {
    /// Each over all decades for itself.
    Everything,
    /// Each over a quarter of them.
    Anything,
    /// Of lengths, energies and times that belong together.
    Consistent,
}

in_units!(double of f64 within 300.0);
in_units!(single of f32 within 36.0);

#[test]
fn no_unit_refuses_a_sound_start() {
    let count = if cfg!(debug_assertions) { 4_000 } else { 100_000 };
    for units in [Units::Consistent, Units::Anything, Units::Everything] {
        let refused = [double::refused(units, count), single::refused(units, count)];
        println!("{units:?}: of {count} starts each, {refused:?} are refused in f64 and f32");
        for [slopes, momenta, second] in refused {
            assert_eq!(momenta, 0);
            match units {
                Units::Consistent => assert_eq!([slopes, second], [0, 0]),
                // Of √(1 + w²) at w = 1e10 and beyond the second derivative is rounding: with
                // `debug_assertions` that is told.
                Units::Anything => assert!(slopes == 0 && 20 * second < count),
                Units::Everything => assert!(1000 * slopes < count && 20 * second < count),
            }
        }
    }
}

/// The control.
#[test]
fn another_wave_is_told_in_its_own_units() {
    let count = 1_000;
    let told = [0.0, 0.01, 0.5].map(|share| {
        [double::told(Units::Consistent, count, share), single::told(Units::Consistent, count, share)]
    });
    println!("off by 0, 0.01 and a half: {told:?} of {count} starts are told, in f64 and f32");
    assert_eq!(told[0], [0, 0]);
    assert!(told[1][0] > 300 && told[2][0] > 300 && told[2][1] > 300, "{told:?}");
}
