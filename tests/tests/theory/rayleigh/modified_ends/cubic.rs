//! The modified field of a step to first order in V‴, and the linear equations for L₃ and R₃.
//!
//! Of V = ½qᵀKq + (ε/6)V‴(q, q, q) a step is z ↦ Az + εB(z, z), its modified field Yz + εb(z, z): linear
//! equations for b. It is a Rayleigh system to first order in ε if and only if cubic L₃(q, v), R₃(q, v) solve
//! d/dt ∂L₃/∂v − ∂L₃/∂q + ∂R₃/∂v = −M̃g along the linear motion, q̈ = … + εg(q, q̇).

use dalembert::nalgebra::{DMatrix, DVector};

pub type Matrix = DMatrix<f64>;

/// A quadratic map z ↦ (zᵀQ₀z, zᵀQ₁z, …), Qᵢ symmetric.
#[derive(Clone)]
pub struct Quadratic(pub Vec<Matrix>);

impl Quadratic {
    fn plus(&self, other: &Self, factor: f64) -> Self {
        Self(self.0.iter().zip(&other.0).map(|(a, b)| a + b * factor).collect())
    }

    /// z ↦ Q(Pz).
    fn at(&self, p: &Matrix) -> Self {
        Self(self.0.iter().map(|q| p.transpose() * q * p).collect())
    }

    /// z ↦ S Q(z).
    fn under(&self, s: &Matrix) -> Self {
        let size = self.0[0].nrows();
        let row = |i: usize| {
            self.0.iter().enumerate().fold(Matrix::zeros(size, size), |sum, (j, q)| sum + q * s[(i, j)])
        };
        Self((0..s.nrows()).map(row).collect())
    }

    /// z ↦ DQ(z)·Yz.
    fn along(&self, y: &Matrix) -> Self {
        Self(self.0.iter().map(|q| q * y + (q * y).transpose()).collect())
    }

    /// DQ·Yz − YQ, the bracket with the linear field Yz.
    fn bracket(&self, y: &Matrix) -> Self {
        self.along(y).plus(&self.under(y), -1.0)
    }

    /// Components `rows`.
    fn part(&self, rows: std::ops::Range<usize>) -> Self {
        Self(self.0[rows].to_vec())
    }

    /// The coefficients of zᵢzⱼ, i ≤ j, of each component.
    fn coefficients(&self) -> DVector<f64> {
        let of = |q: &Matrix| {
            let n = q.nrows();
            let pairs = (0..n).flat_map(move |i| (i..n).map(move |j| (i, j)));
            pairs.map(|(i, j)| if i == j { q[(i, i)] } else { q[(i, j)] + q[(j, i)] }).collect::<Vec<_>>()
        };
        DVector::from_vec(self.0.iter().flat_map(of).collect())
    }
}

/// V‴, by its slices.
pub type Cubic = Vec<Matrix>;

/// M, C and V.
#[derive(Clone)]
pub struct System {
    pub m: Matrix,
    pub c: Matrix,
    pub k: Matrix,
    pub third: Cubic,
}

/// The step.
#[derive(Clone, Copy, Debug)]
pub enum Method {
    /// The rule of these nodes and weights on the straight line.
    Nodes(&'static [(f64, f64)]),
    /// The control: the motion itself, through the same equations for b.
    Exact,
}

/// q̈ = −M̃⁻¹(K̃q + C̃v) + εg(q, v).
pub struct Modified {
    /// (q, v) ↦ (v, q̈) at ε = 0.
    pub rate: Matrix,
    /// M̃g.
    pub force: Quadratic,
}

/// The rows of `upper` above those of `lower`.
fn stacked(upper: &Matrix, lower: &Matrix) -> Matrix {
    let n = upper.nrows();
    let entry = |i, j| if i < n { upper[(i, j)] } else { lower[(i - n, j)] };
    Matrix::from_fn(n + lower.nrows(), upper.ncols(), entry)
}

/// [left, right].
fn beside(left: &Matrix, right: &Matrix) -> Matrix {
    stacked(&left.transpose(), &right.transpose()).transpose()
}

impl System {
    pub fn n(&self) -> usize {
        self.m.nrows()
    }

    /// −½V‴(q, q) on (q, p).
    fn pull(&self) -> Quadratic {
        let n = self.n();
        let none = Matrix::zeros(2 * n, 2 * n);
        let mut parts = vec![none.clone(); n];
        for slice in &self.third {
            let mut part = none.clone();
            part.view_mut((0, 0), (n, n)).copy_from(&(slice * -0.5));
            parts.push(part);
        }
        Quadratic(parts)
    }

    /// The step z ↦ Az + εB(z, z).
    fn step(&self, method: Method, h: f64) -> (Matrix, Quadratic) {
        let n = self.n();
        let zero = Matrix::zeros(n, n);
        let inverse = self.m.clone().try_inverse().unwrap();
        let x = stacked(&beside(&zero, &inverse), &beside(&-&self.k, &(-&self.c * &inverse)));
        match method {
            // p0 = (M/h + C/2)d + h Σ bᵢ(1 − cᵢ)∇V(qᵢ), p1 = (M/h − C/2)d − h Σ bᵢcᵢ∇V(qᵢ), d = q1 − q0.
            Method::Nodes(nodes) => {
                let mean = |f: fn(f64) -> f64| nodes.iter().map(|(c, b)| b * f(*c)).sum::<f64>() * h;
                let (ahead, back) = (&self.m / h + &self.c * 0.5, &self.m / h - &self.c * 0.5);
                let (first, both, last) =
                    (mean(|c| (1.0 - c) * (1.0 - c)), mean(|c| c * (1.0 - c)), mean(|c| c * c));
                let solve = (&ahead + &self.k * both).try_inverse().unwrap();
                let q0 = beside(&Matrix::identity(n, n), &zero);
                let q1 = beside(&(&solve * (ahead - &self.k * first)), &solve);
                let end = back - &self.k * last;
                let p1 = &end * &q1 - (&self.m / h - &self.c * 0.5 + &self.k * both) * &q0;
                let pull = self.pull().part(n..2 * n);
                let none = Quadratic(vec![Matrix::zeros(2 * n, 2 * n); n]);
                let pulls = |share: fn(f64) -> f64| {
                    nodes.iter().fold(none.clone(), |sum, &(c, b)| {
                        let q = stacked(&(&q0 * (1.0 - c) + &q1 * c), &Matrix::zeros(n, 2 * n));
                        sum.plus(&pull.at(&q), h * b * share(c))
                    })
                };
                let by_q = pulls(|c| 1.0 - c).under(&solve);
                let by_p = by_q.under(&end).plus(&pulls(|c| c), 1.0);
                (stacked(&q1, &p1), Quadratic([by_q.0, by_p.0].concat()))
            }
            // B = e^{hX} h (1 + hX·/2! + (hX·)²/3! + …) b, X· the bracket.
            Method::Exact => {
                let a = (&x * h).exp();
                let mut term = self.pull();
                let mut sum = term.clone();
                for order in 2..24 {
                    term = Quadratic(term.bracket(&x).0.iter().map(|q| q * (h / f64::from(order))).collect());
                    sum = sum.plus(&term, 1.0);
                }
                let b = sum.under(&(&a * h));
                (a, b)
            }
        }
    }

    /// The modified field Yz + εb(z, z) of a step.
    fn field(&self, method: Method, h: f64) -> (Matrix, Quadratic) {
        let (a, step) = self.step(method, h);
        let all = Matrix::identity(a.nrows(), a.nrows());
        // log A = 2 artanh((A − 1)/(A + 1)).
        let ratio = (&a - &all) * (&a + &all).try_inverse().unwrap();
        let square = &ratio * &ratio;
        let mut y = Matrix::zeros(a.nrows(), a.nrows());
        let mut power = &ratio * (2.0 / h);
        for order in 0..40 {
            y += &power / f64::from(2 * order + 1);
            power = &power * &square;
        }
        // b = (1/h) Σ (Bₖ/k!) (hY·)ᵏ A⁻¹B, Bernoulli's numbers Bₖ.
        let mut term = step.under(&(a.try_inverse().unwrap() / h));
        let mut field = term.clone();
        for share in bernoulli().into_iter().skip(1) {
            term = Quadratic(term.bracket(&y).0.iter().map(|q| q * h).collect());
            field = field.plus(&term, share);
        }
        (y, field)
    }

    /// The modified system as an equation of second order.
    pub fn modified(&self, method: Method, h: f64) -> Modified {
        let n = self.n();
        let (y, field) = self.field(method, h);
        let block = |i: usize, j: usize| y.view((i * n, j * n), (n, n)).into_owned();
        let (b, d) = (block(0, 1), block(1, 1));
        let mass = b.clone().try_inverse().unwrap();
        let by_q = -&mass * block(0, 0);
        // (q, p) from (q, v), and (v, q̈) from (q, v).
        let state = stacked(&beside(&Matrix::identity(n, n), &Matrix::zeros(n, n)), &beside(&by_q, &mass));
        let rate = state.clone().try_inverse().unwrap() * &y * &state;
        let bent = field.at(&state);
        // With p = b⁻¹(v − aq − εb_q): εg = ε(b b_p − b d b⁻¹ b_q + d/dt b_q).
        let (at_q, at_p) = (bent.part(0..n), bent.part(n..2 * n));
        let g = at_p.under(&b).plus(&at_q.under(&(&b * d * &mass)), -1.0).plus(&at_q.along(&rate), 1.0);
        Modified { rate, force: g.under(&mass) }
    }

    /// The map (L₃, R₃) ↦ equations, and the equations to be met.
    pub fn equations(&self, method: Method, h: f64) -> (Matrix, DVector<f64>) {
        let Modified { rate, force } = self.modified(method, h);
        let n = self.n();
        let size = 2 * n;
        let mut columns = Vec::new();
        for (i, j, k) in triples(size) {
            // The Hessian of zᵢzⱼzₖ is linear: its derivatives along each coordinate.
            let slices = slices_of(size, [i, j, k]);
            let gradient = Quadratic(slices.iter().map(|slice| slice * 0.5).collect());
            let (by_q, by_v) = (gradient.part(0..n), gradient.part(n..size));
            columns.push(by_v.along(&rate).plus(&by_q, -1.0).coefficients());
            columns.push(by_v.coefficients());
        }
        (Matrix::from_columns(&columns), -force.coefficients())
    }
}

/// Bₖ/k!: x/(eˣ − 1) as a power series.
fn bernoulli() -> Vec<f64> {
    let mut shares = vec![1.0];
    for k in 1..32 {
        let mut factorial = 1.0;
        let sum = (1..=k).fold(0.0, |sum, j| {
            factorial *= f64::from(j as u32 + 1);
            sum + shares[k - j] / factorial
        });
        shares.push(-sum);
    }
    shares
}

/// i ≤ j ≤ k below `size`.
pub fn triples(size: usize) -> impl Iterator<Item = (usize, usize, usize)> {
    (0..size).flat_map(move |i| (i..size).flat_map(move |j| (j..size).map(move |k| (i, j, k))))
}

/// ∂³/∂zₐ∂z∂z of zᵢzⱼzₖ, by a.
fn slices_of(size: usize, [i, j, k]: [usize; 3]) -> Cubic {
    let mut slices = vec![Matrix::zeros(size, size); size];
    for [a, b, c] in [[i, j, k], [i, k, j], [j, i, k], [j, k, i], [k, i, j], [k, j, i]] {
        slices[a][(b, c)] += 1.0;
    }
    slices
}

/// V‴ with the entry of each monomial, in the order of [`triples`].
pub fn third(n: usize, entries: &[f64]) -> Cubic {
    let mut slices = vec![Matrix::zeros(n, n); n];
    for ([i, j, k], &entry) in triples(n).map(|(i, j, k)| [i, j, k]).zip(entries) {
        for [a, b, c] in [[i, j, k], [i, k, j], [j, i, k], [j, k, i], [k, i, j], [k, j, i]] {
            slices[a][(b, c)] = entry;
        }
    }
    slices
}
