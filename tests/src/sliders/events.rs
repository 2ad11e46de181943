//! From event to event: an element that slides stops where its slip is 0, one that sticks breaks loose where
//! it would have to hold more than its friction. Of all elements whose slip is 0 the accelerations tell
//! which go on: the least of ½aᵀMa − a·F + Σ fₖ|bₖ·a|, over all 3^K ways to go.

use nalgebra::{DMatrix, DVector, SVector, Vector4};

use super::system::{ELEMENTS, MASSES, Sliders, matrix};

/// Terms of the series, and the length of one.
const TERMS: usize = 22;
const LENGTH: f64 = 0.1;
/// Looks at a series for a change.
const LOOKS: usize = 24;
/// What counts as no acceleration of a slip.
const STILL: f64 = 1e-11;

/// How each element goes: 1 and −1 slide, 0 sticks.
pub type Sliding = [i8; ELEMENTS];

/// A motion from event to event.
pub struct Motion<'a> {
    sliders: &'a Sliders,
    /// The time.
    pub time: f64,
    /// The place.
    pub q: Vector4<f64>,
    /// The velocity.
    pub v: Vector4<f64>,
    /// How each element goes.
    pub sliding: Sliding,
    /// The last time at which an element stopped or broke loose.
    pub last_event: f64,
    /// How many such there were.
    pub events: usize,
}

type Series = [Vector4<f64>; TERMS];

impl<'a> Motion<'a> {
    /// From a start.
    #[must_use]
    pub fn new(sliders: &'a Sliders, q: Vector4<f64>, v: Vector4<f64>) -> Self {
        let slips = sliders.slips(&v);
        let sliding = std::array::from_fn(|k| if slips[k] == 0.0 { 0 } else { slips[k].signum() as i8 });
        let mut motion = Self { sliders, time: 0.0, q, v, sliding, last_event: 0.0, events: 0 };
        motion.resolve();
        motion
    }

    /// Whether all elements that have friction stick, and nothing moves.
    #[must_use]
    pub fn rests(&self) -> bool {
        self.v.amax() < 1e-12 && self.goes(&self.q, &self.v) == self.sliding && {
            let a = self.acceleration(&self.q, &self.v, &self.sliding);
            a.amax() < 1e-10
        }
    }

    /// On to a time.
    ///
    /// # Panics
    /// Events without end.
    pub fn advance(&mut self, until: f64) {
        while self.time < until {
            if self.rests() {
                self.time = until;
                return;
            }
            let length = LENGTH.min(until - self.time);
            let series = self.series();
            match self.first_change(&series, length) {
                None => self.go(&series, length),
                Some((after, changed)) => {
                    self.go(&series, after);
                    for k in changed {
                        self.sliding[k] = 0;
                    }
                    self.resolve();
                    self.events += 1;
                    self.last_event = self.time;
                    assert!(self.events < 100_000, "events without end");
                }
            }
        }
    }

    fn go(&mut self, series: &Series, by: f64) {
        (self.q, self.v) = (at(series, by), rate(series, by));
        self.time += by;
        // What sticks, sticks to rounding.
        let apart = self.apart(&self.stuck(&self.sliding));
        if apart.is_empty() {
            return;
        }
        let rows = self.rows(&apart);
        let off = DVector::from_iterator(apart.len(), apart.iter().map(|&k| self.sliders.slips(&self.v)[k]));
        let back = (&rows * rows.transpose()).lu().solve(&off).expect("rows that are apart");
        self.v -= Vector4::from_column_slice((rows.transpose() * back).as_slice());
    }

    /// Sticking elements as they go on from here.
    fn resolve(&mut self) {
        self.sliding = self.goes(&self.q, &self.v);
    }

    /// The force without that of sticking elements.
    fn force(&self, q: &Vector4<f64>, v: &Vector4<f64>, sliding: &Sliding) -> Vector4<f64> {
        let s = self.sliders;
        let mut force = Vector4::from(s.load) - matrix(&s.k) * q - matrix(&s.c) * v;
        for (k, &way) in sliding.iter().enumerate() {
            force -= Vector4::from(s.b[k]) * (s.f[k] * f64::from(way));
        }
        force
    }

    fn rows(&self, elements: &[usize]) -> DMatrix<f64> {
        DMatrix::from_fn(elements.len(), MASSES, |row, i| self.sliders.b[elements[row]][i])
    }

    /// a with bₖ·a = 0 for those elements, of Ma = force − Σ bₖλₖ; and λ.
    fn held_by(&self, force: &Vector4<f64>, elements: &[usize]) -> (Vector4<f64>, DVector<f64>) {
        let inverse = matrix(&self.sliders.m).try_inverse().expect("masses");
        let free = inverse * force;
        let apart = self.apart(elements);
        if apart.is_empty() {
            return (free, DVector::zeros(elements.len()));
        }
        let rows = self.rows(&apart);
        let inverse = DMatrix::from_fn(MASSES, MASSES, |i, j| inverse[(i, j)]);
        let schur = &rows * &inverse * rows.transpose();
        let slip = &rows * DVector::from_column_slice(free.as_slice());
        let impulses = schur.lu().solve(&slip).expect("rows that are apart");
        let held = inverse * rows.transpose() * &impulses;
        let mut bears = DVector::zeros(elements.len());
        for (k, impulse) in apart.iter().zip(impulses.iter()) {
            bears[elements.iter().position(|of| of == k).expect("one of them")] = *impulse;
        }
        (free - Vector4::from_column_slice(held.as_slice()), bears)
    }

    /// Those of the elements whose rows do not follow from the ones before: they hold the others, too.
    fn apart(&self, elements: &[usize]) -> Vec<usize> {
        let (mut found, mut basis) = (Vec::new(), Vec::<Vector4<f64>>::new());
        for &k in elements {
            let row = Vector4::from(self.sliders.b[k]);
            // Twice is enough.
            let left = [(); 2]
                .iter()
                .fold(row, |left, ()| basis.iter().fold(left, |left, unit| left - unit * unit.dot(&left)));
            if left.norm() > 1e-9 * row.norm() {
                basis.push(left.normalize());
                found.push(k);
            }
        }
        found
    }

    fn held(&self, force: &Vector4<f64>, elements: &[usize]) -> Vector4<f64> {
        self.held_by(force, elements).0
    }

    /// Elements with friction that stick.
    fn stuck(&self, sliding: &Sliding) -> Vec<usize> {
        (0..ELEMENTS).filter(|&k| sliding[k] == 0 && self.sliders.f[k] > 0.0).collect()
    }

    fn acceleration(&self, q: &Vector4<f64>, v: &Vector4<f64>, sliding: &Sliding) -> Vector4<f64> {
        let stuck = self.stuck(sliding);
        self.held(&self.force(q, v, sliding), &stuck)
    }

    /// How elements go that stick now.
    fn goes(&self, q: &Vector4<f64>, v: &Vector4<f64>) -> Sliding {
        let (s, mut sliding) = (self.sliders, self.sliding);
        let open = self.stuck(&sliding);
        let force = self.force(q, v, &sliding);
        let slip = |k: usize, a: &Vector4<f64>| Vector4::from(s.b[k]).dot(a);
        let objective = |a: &Vector4<f64>| {
            let friction: f64 = open.iter().map(|&k| s.f[k] * slip(k, a).abs()).sum();
            0.5 * a.dot(&(matrix(&s.m) * a)) - a.dot(&force) + friction
        };
        let mut least = (f64::INFINITY, Vector4::zeros());
        for code in 0..3_usize.pow(open.len() as u32) {
            let (mut pushed, mut stuck) = (force, Vec::new());
            for (place, &k) in open.iter().enumerate() {
                match code / 3_usize.pow(place as u32) % 3 {
                    0 => stuck.push(k),
                    way => pushed -= Vector4::from(s.b[k]) * (s.f[k] * (2.0 * way as f64 - 3.0)),
                }
            }
            let a = self.held(&pushed, &stuck);
            let value = objective(&a);
            // Of ways that are as good the one that sticks most stands first.
            if value < least.0 - 1e-15 * (1.0 + value.abs()) {
                least = (value, a);
            }
        }
        for k in open {
            let slip = slip(k, &least.1);
            sliding[k] = if slip.abs() < STILL { 0 } else { slip.signum() as i8 };
        }
        sliding
    }

    /// The coefficients of q over the time from here, while elements go on as they do.
    fn series(&self) -> Series {
        let (s, mut series) = (self.sliders, [Vector4::zeros(); TERMS]);
        (series[0], series[1]) = (self.q, self.v);
        let stuck = self.stuck(&self.sliding);
        series[2] = self.acceleration(&self.q, &self.v, &self.sliding) * 0.5;
        for j in 1..TERMS - 2 {
            let force = -matrix(&s.k) * series[j] - matrix(&s.c) * series[j + 1] * (j + 1) as f64;
            series[j + 2] = self.held(&force, &stuck) / ((j + 1) * (j + 2)) as f64;
        }
        series
    }

    /// The first change within a series: when, and of which elements.
    fn first_change(&self, series: &Series, length: f64) -> Option<(f64, Vec<usize>)> {
        let mut before = 0.0;
        for look in 1..=LOOKS {
            let after = length * look as f64 / LOOKS as f64;
            if !self.changed(series, after).is_empty() {
                let (mut low, mut high) = (before, after);
                while high - low > 1e-15 * (1.0 + high) {
                    let middle = 0.5 * (low + high);
                    if middle <= low || middle >= high {
                        break;
                    }
                    if self.changed(series, middle).is_empty() { low = middle } else { high = middle }
                }
                return Some((high, self.changed(series, high)));
            }
            before = after;
        }
        None
    }

    /// Elements that go on otherwise than they do at a time of the series.
    fn changed(&self, series: &Series, time: f64) -> Vec<usize> {
        let (q, v) = (at(series, time), rate(series, time));
        let slips: SVector<f64, ELEMENTS> = self.sliders.slips(&v);
        let stopped = |&k: &usize| self.sliding[k] != 0 && slips[k] * f64::from(self.sliding[k]) < 0.0;
        let mut changed: Vec<usize> = (0..ELEMENTS).filter(stopped).collect();
        let stuck = self.stuck(&self.sliding);
        let bears = self.held_by(&self.force(&q, &v, &self.sliding), &stuck).1;
        // Forces within their limits are proof enough.
        let may_break = stuck.iter().zip(bears.iter()).any(|(&k, force)| force.abs() > self.sliders.f[k]);
        if may_break && changed.is_empty() {
            let goes = self.goes(&q, &v);
            changed.extend((0..ELEMENTS).filter(|&k| self.sliding[k] == 0 && goes[k] != 0));
        }
        changed
    }
}

fn at(series: &Series, time: f64) -> Vector4<f64> {
    series.iter().rev().fold(Vector4::zeros(), |sum, term| sum * time + term)
}

fn rate(series: &Series, time: f64) -> Vector4<f64> {
    let terms = series.iter().enumerate().skip(1).rev();
    terms.fold(Vector4::zeros(), |sum, (k, term)| sum * time + term * k as f64)
}
