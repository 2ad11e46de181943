//! Segments of Gauss rules, the interior points solved for: also those that lead back to where they start, or
//! hardly away from there, and those that are not.

use dalembert::nalgebra::SVector;
use dalembert::step::Flow;
use dalembert::system::Scalar;
use dalembert::{Discrete, Discretise, Gauss, State, StepError, rayleigh_system};
use dalembert_tests::draws::Draws;

/// How far from q0 a segment leads, in units of |q0|, or by a velocity of that size where it is one of
/// ordinary length.
const LENGTHS: [f64; 8] = [0.0, 1e-300, 1e-38, 1e-16, 1e-12, 1e-8, 1e-4, 1.0];

/// Mass, gyroscopic term, friction and force depend on q; the force has no potential. The third coordinate is
/// left alone where `k` is 0, and has then no force at rest.
macro_rules! curved {
    ($curved:ident, $scalar:ident) => {
        #[derive(Clone, Copy, Debug)]
        struct $curved {
            m: [$scalar; 3],
            b: $scalar,
            k: [$scalar; 3],
            r: [$scalar; 2],
            f: [$scalar; 2],
        }

        #[rayleigh_system(rule = gauss)]
        impl $curved {
            fn lagrangian(&self, q: [$scalar; 3], v: [$scalar; 3]) -> $scalar {
                let [x, y, z] = q;
                0.5 * self.m[0] * (1.0 + 0.3 * y * y) * v[0] * v[0]
                    + 0.5 * self.m[1] * (v[1] * v[1] + v[2] * v[2])
                    + self.m[2] * x.cos() * v[0] * v[1]
                    + self.b * x * y * v[1]
                    - self.k[0] * x.cos()
                    - 0.5 * self.k[1] * y * y
                    - self.k[2] * x * x * y * z
            }

            fn rayleigh(&self, q: [$scalar; 3], v: [$scalar; 3]) -> $scalar {
                let between = v[0] - q[0] * v[1];
                0.5 * self.r[0] * (1.0 + q[1] * q[1]) * between * between
                    + 0.25 * self.r[1] * (v[1] - v[2]).powi(4)
            }

            fn force(&self, q: [$scalar; 3], v: [$scalar; 3]) -> [$scalar; 3] {
                [self.f[0] * q[1] + self.f[1] * v[1], -self.f[0] * q[0], 0.0]
            }
        }

        impl $curved {
            fn random(draws: &mut Draws) -> Self {
                let is_coupled = draws.below(2) == 0;
                let mut of = |low, high| draws.between(low, high) as $scalar;
                Self {
                    m: [of(0.5, 2.0), of(0.5, 2.0), of(-0.3, 0.3)],
                    b: of(-0.5, 0.5),
                    k: [of(-1.0, 1.0), of(0.0, 2.0), if is_coupled { of(-0.5, 0.5) } else { 0.0 }],
                    r: [of(0.1, 0.8), of(0.1, 0.8)],
                    f: [of(0.3, 0.8), of(-0.5, 0.5)],
                }
            }
        }
    };
}

curved!(Curved, f64);
curved!(Single, f32);

/// In units of ε: how far the step from (q0, p0) of the segment arrives from q1 and p1.
fn miss<L, const S: usize>(system: &L, draws: &mut Draws, length: f64) -> Result<f64, StepError>
where
    L: Discrete<Gauss<S>, 3> + Flow<Gauss<S>, 3>,
{
    let h = L::Scalar::constant(draws.sign() * draws.scale(1e-3, 0.4));
    let mut within = |size: f64| {
        SVector::<L::Scalar, 3>::from_fn(|_, _| L::Scalar::constant(draws.between(-1.0, 1.0) * size))
    };
    let q0 = within(1.0);
    let q1 = if length < 1.0 { q0 + within(length) } else { q0 + within(1.0) * h };
    let by = system.by(Gauss::<S>, h);
    let k = by.segment(&q0, &q1)?.legendre_derivatives()?.momenta;
    let step = by.step(&State { q: q0, p: k.p0 })?;
    let duration = h.widen().abs();
    let off = [
        (step.state.q - q1).amax().widen() / (q0.amax().widen() + (q1 - q0).amax().widen() + duration),
        (step.state.p - k.p1).amax().widen() / (k.p0.amax().widen() + duration),
    ];
    assert!(off.iter().all(|off| off.is_finite()));
    Ok(off[0].max(off[1]) / L::Scalar::EPSILON.widen())
}

/// Over random systems and segments.
fn every_segment_is_that_of_its_step<const S: usize>(count: usize) {
    let count = if cfg!(debug_assertions) { count / 2 } else { count };
    let mut draws = Draws::new(S as u64);
    let (mut tried, mut worst) = (0, [0.0_f64; 2]);
    for _ in 0..count {
        for length in LENGTHS {
            let system = Curved::random(&mut draws);
            let double = miss::<_, S>(&system, &mut draws, length)
                .unwrap_or_else(|error| panic!("S = {S}, {length:e}, {system:?}: {error}"));
            let system = Single::random(&mut draws);
            let single = miss::<_, S>(&system, &mut draws, length)
                .unwrap_or_else(|error| panic!("S = {S}, {length:e}, {system:?}: {error}"));
            worst = [worst[0].max(double), worst[1].max(single)];
            tried += 2;
        }
    }
    println!("Gauss<{S}>: {tried} segments, off by {:.1} ε in f64, {:.1} ε in f32", worst[0], worst[1]);
    assert!(worst[0] < 100.0 && worst[1] < 100.0, "S = {S}: {worst:?}");
}

#[test]
fn random_segments_are_those_of_their_steps() {
    every_segment_is_that_of_its_step::<1>(20);
    every_segment_is_that_of_its_step::<2>(40);
    every_segment_is_that_of_its_step::<3>(20);
    every_segment_is_that_of_its_step::<4>(10);
}

/// Pushed by g, and by a wind that pushes the more the faster it goes, k > 0.
#[rayleigh_system(rule = gauss)]
impl Blown {
    fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.m * v[0] * v[0]
    }

    fn force(&self, _q: [f64; 1], v: [f64; 1]) -> [f64; 1] {
        [self.g + self.k * v[0] * v[0]]
    }
}

struct Blown {
    m: f64,
    g: f64,
    k: f64,
}

impl Blown {
    /// p0 and p1 of `Gauss<2>` at the mean velocity v̄. The stages v̄ ± w satisfy sk w² + 2mw + s(g + kv̄²) =
    /// 0 with s = h/√3: where m² < s²k(g + kv̄²) there are none.
    fn momenta(&self, mean: f64, h: f64) -> Option<[f64; 2]> {
        let s = h / 3.0_f64.sqrt();
        let constant = s * (self.g + self.k * mean * mean);
        let square = self.m * self.m - s * self.k * constant;
        let w = -constant / (self.m + (square >= 0.0).then(|| square.sqrt())?);
        let rates = [mean + w, mean - w].map(|v| self.g + self.k * v * v);
        let p0 = self.m * (mean + w) - h * (0.25 * rates[0] + (0.25 - 3.0_f64.sqrt() / 6.0) * rates[1]);
        Some([p0, p0 + 0.5 * h * (rates[0] + rates[1])])
    }
}

#[test]
fn segments_that_are_not_have_no_momenta() {
    let mut draws = Draws::new(5);
    let (all, mut count) = (if cfg!(debug_assertions) { 80 } else { 200 }, [0; 2]);
    for _ in 0..all {
        for length in LENGTHS {
            let (m, k, h) =
                (draws.scale(0.1, 10.0), draws.scale(0.1, 10.0), draws.sign() * draws.scale(0.01, 1.0));
            let q0 = draws.between(-1.0, 1.0);
            let q1 = if length < 1.0 { q0 + length * draws.between(-1.0, 1.0) } else { q0 + 0.1 * h * m };
            let mean = (q1 - q0) / h;
            // The share of s²k(g + kv̄²) in m², on both sides of 1.
            let share = draws.scale(0.01, 100.0);
            let system = Blown { m, k, g: share * 3.0 * m * m / (h * h * k) - k * mean * mean };
            let found = system.by(Gauss::<2>, h).segment(&[q0].into(), &[q1].into());
            let found = found.and_then(|segment| segment.legendre_derivatives()).map(|k| k.momenta);
            let what = format!("m = {m}, k = {k}, h = {h}, v̄ = {mean}, {share}: {found:?}");
            match (system.momenta(mean, h), found) {
                (Some([p0, p1]), Ok(found)) => {
                    let (a, b) = (found.p0[0], found.p1[0]);
                    // Near the fold w moves as the root of the distance does.
                    let tolerance =
                        64.0 * f64::EPSILON / (1.0 - share).sqrt() * (p0.abs() + p1.abs() + m * mean.abs());
                    assert!((a - p0).abs() < tolerance && (b - p1).abs() < tolerance, "{what}, {p0} {p1}");
                    count[0] += 1;
                }
                (None, Err(StepError::NoRealSolution { .. })) => count[1] += 1,
                (is, _) => panic!("{what}, {is:?}"),
            }
        }
    }
    println!("{count:?}");
    assert!(count.iter().all(|&count| 2 * count > 5 * all));
}

#[rayleigh_system(rule = gauss)]
fn spring(q: [f64; 1], v: [f64; 1], m: f64, k: f64) -> f64 {
    0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0]
}

/// A turn by the angle θ of `Gauss<2>` leads from q back to q with p0 = mωq tan(θ/2), where tan(θ/2) is
/// (z/2)/(1 − z²/12) with z = ωh; at z² = 12 every q is led to −q.
#[test]
fn a_spring_returns_to_where_it_starts() {
    let mut draws = Draws::new(6);
    for _ in 0..200 {
        let (m, h, z) = (draws.scale(0.01, 100.0), draws.scale(1e-3, 1e3), draws.scale(1e-3, 30.0));
        let (omega, q) = (z / h, draws.sign() * draws.scale(1e-3, 1e3));
        let spring = Spring { m, k: m * omega * omega };
        let expected = m * omega * q * (0.5 * z) / (1.0 - z * z / 12.0);
        let segment = spring.by(Gauss::<2>, h).segment(&[q].into(), &[q].into()).unwrap();
        let found = segment.legendre_derivatives().unwrap().momenta;
        let tolerance = 64.0 * f64::EPSILON * (1.0 + z * z / (12.0 - z * z).abs()) * expected.abs();
        assert!(
            (found.p0[0] - expected).abs() < tolerance && (found.p1[0] + expected).abs() < tolerance,
            "m = {m}, h = {h}, z = {z}, q = {q}: {found:?} {expected}"
        );
        let spring = Spring { m, k: 12.0 * m / (h * h) };
        let none = spring.by(Gauss::<2>, h).segment(&[q].into(), &[q].into());
        assert!(none.is_err(), "m = {m}, h = {h}, q = {q}: {:?}", none.unwrap().legendre_derivatives());
    }
}
