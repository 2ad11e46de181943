//! Derivatives of random expressions, lowered from source text, against num-dual.
//!
//! The two round differently, so that they are held to what rounding can do: the graph is evaluated with
//! every result moved by about an ulp at random, and the spread over several such evaluations, with 128 ulps
//! of the largest intermediate for what num-dual rounds on its own way, is what they may differ by.

use nalgebra::SVector;
use num_dual::{Dual2SVec64, DualNum, DualStruct, hessian};

use crate::rayleigh_system::differentiate::Differentiation;
use crate::rayleigh_system::differentiate::partials::fault;
use crate::rayleigh_system::graph::{Function, Node, Operation, interpret};
use crate::rayleigh_system::lower::{self, Lowered};
use crate::rayleigh_system::{Runtime, attribute, check, diagnostics::Report, parse};

type Number = Dual2SVec64<4>;

/// SplitMix64: expressions must be the same on every machine.
pub(super) struct Random(pub(super) u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub(super) fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    pub(super) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// An expression that can be written and evaluated over num-dual's numbers.
pub(super) enum Expression {
    Variable(usize),
    Constant(f64),
    Binary(char, Box<Self>, Box<Self>),
    Negated(Box<Self>),
    Function(Function, Box<Self>),
    Power(Box<Self>, i32),
    RealPower(Box<Self>, f64),
    /// (1 + a²)ᵇ.
    PowerOfBoth(Box<Self>, Box<Self>),
    Choice([Box<Self>; 4]),
    Larger(Box<Self>, Box<Self>),
    Angle(Box<Self>, Box<Self>),
    Distance(Box<Self>, Box<Self>),
    /// `{ let x = a; x * x + x * b }`, a shared subexpression.
    Shared(Box<Self>, Box<Self>),
}

use Expression::*;

impl Expression {
    pub(super) fn random(random: &mut Random, depth: usize) -> Self {
        let part = |random: &mut Random| Box::new(Self::random(random, depth.saturating_sub(1)));
        if depth == 0 {
            return match random.below(5) {
                4 => Constant((random.unit() * 400.0).round() / 100.0 + 0.25),
                index => Variable(index),
            };
        }
        match random.below(20) {
            0..=2 => Binary('+', part(random), part(random)),
            3..=4 => Binary('-', part(random), part(random)),
            5..=7 => Binary('*', part(random), part(random)),
            8 => {
                let (a, b) = (part(random), part(random));
                // num-dual's a/a is 1 to rounding; the graph's has no derivative at all.
                if a.text() == b.text() { Negated(a) } else { Binary('/', a, b) }
            }
            9 => Negated(part(random)),
            10..=12 => {
                let function = Function::ALL[random.below(Function::ALL.len())];
                Function(function, part(random))
            }
            13 => Power(part(random), [-3, -2, -1, 0, 1, 2, 3, 4, 5][random.below(9)]),
            14 => RealPower(part(random), [0.5, 1.5, 2.0, -0.7, 3.0, 0.0, 1.0][random.below(7)]),
            15 => PowerOfBoth(part(random), part(random)),
            16 => Choice([part(random), part(random), part(random), part(random)]),
            17 => Larger(part(random), part(random)),
            18 if random.below(2) == 0 => Angle(part(random), part(random)),
            18 => Distance(part(random), part(random)),
            _ => Shared(part(random), part(random)),
        }
    }

    pub(super) fn text(&self) -> String {
        match self {
            Variable(index @ 0..=1) => format!("q[{index}]"),
            Variable(index) => format!("v[{}]", index - 2),
            Constant(value) => format!("{value:?}_f64"),
            Binary(symbol, a, b) => format!("({} {symbol} {})", a.text(), b.text()),
            Negated(a) => format!("(-{})", a.text()),
            Function(function, a) => format!("({}).{}()", a.text(), function.name()),
            Power(a, n) => format!("({}).powi({n})", a.text()),
            RealPower(a, n) => format!("({}).powf({n:?})", a.text()),
            PowerOfBoth(a, b) => {
                format!("{{ let base = {}; (1.0 + base * base).powf({}) }}", a.text(), b.text())
            }
            Choice([a, b, c, d]) => {
                format!("if {} < {} {{ {} }} else {{ {} }}", a.text(), b.text(), c.text(), d.text())
                    .replacen("if", "(if", 1)
                    + ")"
            }
            Larger(a, b) => format!("({}).max({})", a.text(), b.text()),
            Angle(a, b) => format!("({}).atan2({})", a.text(), b.text()),
            Distance(a, b) => format!("({}).hypot({})", a.text(), b.text()),
            Shared(a, b) => format!("{{ let x = {}; x * x + x * {} }}", a.text(), b.text()),
        }
    }

    fn value(&self, at: &[Number; 4]) -> Number {
        match self {
            Variable(index) => at[*index],
            Constant(value) => Number::from(*value),
            Binary(symbol, a, b) => {
                let (a, b) = (a.value(at), b.value(at));
                match symbol {
                    '+' => a + b,
                    '-' => a - b,
                    '*' => a * b,
                    _ => a / b,
                }
            }
            Negated(a) => -a.value(at),
            Function(function, a) => elementary(*function, a.value(at)),
            Power(a, n) => a.value(at).powi(*n),
            RealPower(a, n) => {
                let base = a.value(at);
                // num-dual's own value at 0 is NaN, and a comparison with it goes the other way.
                let mut power = base.powf(*n);
                power.re = base.re().powf(*n);
                power
            }
            PowerOfBoth(a, b) => {
                let base = a.value(at);
                let base = base * base + 1.0;
                let exponent = b.value(at);
                // A NaN to the power 0 is 1.
                let value = base.re().powf(exponent.re());
                let mut power = (base.ln() * exponent).exp();
                power.re = value;
                power
            }
            Choice([a, b, c, d]) => {
                if a.value(at).re() < b.value(at).re() {
                    c.value(at)
                } else {
                    d.value(at)
                }
            }
            Larger(a, b) => {
                let (a, b) = (a.value(at), b.value(at));
                if b.re() > a.re() || a.re().is_nan() { b } else { a }
            }
            Angle(a, b) => {
                let (y, x) = (a.value(at), b.value(at));
                let angle = y.re().atan2(x.re());
                let quotient = if x.re().abs() >= y.re().abs() { (y / x).atan() } else { -(x / y).atan() };
                let turn = angle - quotient.re();
                quotient + turn
            }
            Distance(a, b) => {
                let (a, b) = (a.value(at), b.value(at));
                (a * a + b * b).sqrt()
            }
            Shared(a, b) => {
                let x = a.value(at);
                x * x + x * b.value(at)
            }
        }
    }
}

fn elementary(function: Function, x: Number) -> Number {
    match function {
        Function::Recip => x.recip(),
        Function::Exp => x.exp(),
        Function::Exp2 => x.exp2(),
        Function::ExpM1 => x.exp_m1(),
        Function::Ln => x.ln(),
        Function::Log2 => x.log2(),
        Function::Log10 => x.log10(),
        Function::Ln1p => x.ln_1p(),
        Function::Sin => x.sin(),
        Function::Cos => x.cos(),
        Function::Tan => x.tan(),
        Function::Asin => x.asin(),
        Function::Acos => x.acos(),
        Function::Atan => x.atan(),
        Function::Sinh => x.sinh(),
        Function::Cosh => x.cosh(),
        // num-dual's own loses the derivative beyond |x| ≈ 20.
        Function::Tanh => {
            let sign = x.re().signum();
            let twice = x * (-2.0 * sign);
            -twice.exp_m1() / (twice.exp() + 1.0) * sign
        }
        Function::Asinh => x.asinh(),
        Function::Acosh => x.acosh(),
        Function::Atanh => x.atanh(),
        Function::Sqrt => x.sqrt(),
        Function::Cbrt => x.cbrt(),
        Function::Abs => {
            if x.re() < 0.0 {
                -x
            } else {
                x
            }
        }
        Function::Signum => Number::from(x.re().signum()),
    }
}

/// L = the expression, by the stages of the pipeline.
fn lowered(text: &str) -> Lowered {
    let item =
        format!("impl Random {{ fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {{ {text} }} }}");
    let mut report = Report::default();
    let options = attribute::options(Default::default(), Runtime::STD, &mut report);
    let source =
        parse::source(item.parse().expect("the text is made of tokens"), &mut report).expect("a block");
    let system = check::system(&source, &options, &mut report).expect("a system");
    lower::system(&system).unwrap_or_else(|refusal| panic!("{}: {text}", refusal.reason))
}

/// Value, gradient and Hessian by num-dual.
fn reference(expression: &Expression, point: [f64; 4]) -> Vec<f64> {
    let (value, gradient, hessian) = hessian(
        |x: SVector<Number, 4>| expression.value(&std::array::from_fn(|i| x[i])),
        &SVector::from(point),
    );
    let second = (0..4).flat_map(|i| (i..4).map(move |j| (i, j))).map(|(i, j)| hessian[(i, j)]);
    std::iter::once(value).chain(gradient.iter().copied()).chain(second).collect()
}

/// The same by the graph.
fn expressions(lowered: &mut Lowered) -> Vec<Node> {
    let graph = &mut lowered.graph;
    let written = graph.len();
    let derivatives = Differentiation::default().hessian(graph, lowered.lagrangian, "l");
    let variables =
        [Operation::Coordinate(0), Operation::Coordinate(1), Operation::Velocity(0), Operation::Velocity(1)]
            .map(|operation| graph.node(operation));
    let zero = graph.constant(0.0);
    let mut outputs = vec![lowered.lagrangian];
    outputs.extend(variables.map(|variable| *derivatives.gradient.get(&variable).unwrap_or(&zero)));
    for i in 0..4 {
        for j in i..4 {
            let (a, b) = (variables[i].min(variables[j]), variables[i].max(variables[j]));
            outputs.push(*derivatives.hessian.get(&(a, b)).unwrap_or(&zero));
        }
    }
    graph.factored(&outputs, written)
}

/// How the comparison of one expression at one point went.
enum Outcome {
    Agrees,
    /// Not a finite number, or too sensitive to compare.
    Skipped,
    Differs(String),
}

fn compare(expression: &Expression, point: [f64; 4], random: &mut Random) -> Outcome {
    let reference = reference(expression, point);
    let text = expression.text();
    let mut lowered = lowered(&text);
    let outputs = expressions(&mut lowered);
    let (q, v) = point.split_at(2);
    let mut scale = 1.0_f64;
    let exact = interpret::values(&lowered.graph, &outputs, [q, v], |x| {
        scale = scale.max(x.abs());
        x
    });
    if reference.iter().any(|x| !x.is_finite() || x.abs() > 1e6) {
        return Outcome::Skipped;
    }
    let mut spread = vec![0.0_f64; exact.len()];
    for _ in 0..6 {
        let moved = interpret::values(&lowered.graph, &outputs, [q, v], |x| {
            x * (1.0 + (random.unit() - 0.5) * 4.0 * f64::EPSILON)
        });
        for (spread, (moved, exact)) in spread.iter_mut().zip(moved.iter().zip(&exact)) {
            // A rounding away from a singular point, such as acos of x⁻²x²: num-dual rounds to its other
            // side.
            let change =
                if moved.is_finite() && !exact.is_finite() { f64::INFINITY } else { (moved - exact).abs() };
            *spread = spread.max(change);
        }
    }
    if spread.iter().zip(&exact).any(|(spread, x)| !spread.is_finite() || *spread > 1e-6 * (1.0 + x.abs())) {
        return Outcome::Skipped;
    }
    for (index, ((exact, reference), spread)) in exact.iter().zip(&reference).zip(&spread).enumerate() {
        // num-dual may form large terms that cancel where the graph knows a zero.
        let is_zero = lowered.graph.constant_value(outputs[index]) == Some(0.0);
        let floor = if is_zero { 1e-9 } else { 128.0 * f64::EPSILON };
        let tolerance = 40.0 * spread + floor * scale;
        // A NaN does not agree.
        let agrees = (exact - reference).abs() <= tolerance;
        if !agrees {
            return Outcome::Differs(format!(
                "output {index} of {text} at {point:?}: {exact:e}, num-dual {reference:e}, tolerance {tolerance:e}"
            ));
        }
    }
    Outcome::Agrees
}

#[test]
fn random_expressions_have_the_derivatives_of_num_dual() {
    let count = if cfg!(debug_assertions) { 1_000 } else { 10_000 };
    let mut random = Random(1);
    let (mut agreed, mut skipped) = (0, 0);
    while agreed < count {
        let depth = 1 + random.below(5);
        let expression = Expression::random(&mut random, depth);
        let point = std::array::from_fn(|_| random.unit() * 2.4 - 0.8);
        match compare(&expression, point, &mut random) {
            Outcome::Agrees => agreed += 1,
            Outcome::Skipped => skipped += 1,
            Outcome::Differs(difference) => panic!("after {agreed}: {difference}"),
        }
    }
    println!("{agreed} agree, {skipped} without finite values");
    assert!(skipped < count, "too many expressions say nothing: {skipped}");
}

/// The control: each rule made wrong by one part in 10⁹, each order in turn, is found out.
#[test]
fn a_wrong_rule_is_detected() {
    for &function in Function::ALL {
        let orders = match function {
            Function::Signum => 0,
            Function::Abs => 1,
            _ => 2,
        };
        for order in 0..orders {
            let detected = (0..20).any(|seed| {
                let mut random = Random(seed);
                let point = std::array::from_fn(|_| 0.2 + 0.6 * random.unit());
                // 1.5 + q₀ v₁ for acosh, q₀ v₁ for the others.
                let product = Box::new(Binary('*', Box::new(Variable(0)), Box::new(Variable(3))));
                let argument = match function {
                    Function::Acosh => Binary('+', Box::new(Constant(1.5)), product),
                    _ => *product,
                };
                let expression = Function(function, Box::new(argument));
                fault::FAULT.set(None);
                let right = compare(&expression, point, &mut random);
                fault::FAULT.set(Some((function, order)));
                let wrong = compare(&expression, point, &mut random);
                fault::FAULT.set(None);
                matches!((right, wrong), (Outcome::Agrees, Outcome::Differs(_)))
            });
            assert!(detected, "{function:?}, derivative {}", order + 1);
        }
    }
}

/// `if x > 0.0 { x.sqrt() } else { 0.0 }` for x ≤ 0.
#[test]
fn a_rejected_branch_leaves_no_trace() {
    let mut chosen = lowered("let x = q[0] * v[1]; if x > 0.0 { x.sqrt() } else { 0.0 }");
    let outputs = expressions(&mut chosen);
    for q in [0.0, -1.0] {
        let values = interpret::values(&chosen.graph, &outputs, [&[q, 0.3], &[0.2, 2.0]], |x| x);
        assert!(values.iter().all(|&x| x == 0.0), "{values:?}");
    }
    // The control: without the selection the same point has none.
    let mut bare = lowered("let x = q[0] * v[1]; x.sqrt()");
    let outputs = expressions(&mut bare);
    let values = interpret::values(&bare.graph, &outputs, [&[0.0, 0.3], &[0.2, 2.0]], |x| x);
    assert!(values.iter().any(|x| !x.is_finite()), "{values:?}");
}
