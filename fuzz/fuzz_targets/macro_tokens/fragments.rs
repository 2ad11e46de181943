//! Pieces that mutations put in: what bodies of systems are made of, and what they should not be made of.

/// Expressions.
pub const EXPRESSIONS: &[&str] = &[
    "q[0]", "v[0]", "q[1]", "v[q.len() - 1]", "q", "v", "&q", "q[..]", "q[0..=1][0]", "self.k", "self.m[0]", "self.x.0", "self",
    "0.0", "1.0", "-0.0", "1e400", "f64::NAN", "f64::MAX", "5e-324", "0", "1", "3", "usize::MAX", "i64::MIN", "1_000_000_000",
    "u8::MAX", "0x_1", "1u8", "1f32", "true", "'a'", "\"text\"", "()", "[]", "[0.0; 2]", "[q; 3]", "[0.0; usize::MAX]",
    "0..3", "0..=usize::MAX", "..", "(1..=3).rev().step_by(2)", "(0..4).map(|i| q[i % 2])", "(0..0).sum::<f64>()",
    "q.iter().zip(&v).map(|(q, v)| q * v).sum::<f64>()", "q.iter().sum::<f64>()", "v.map(|v| v * v).iter().product::<f64>()",
    "q.windows(2).map(|w| w[1] - w[0]).fold(0.0, |a, b| a + b)", "q.chunks(0)", "q.windows(0)", "q.iter().step_by(0)",
    "q.iter().enumerate().skip(1).take(2).rev()", "q.iter().max_by(|a, b| a.total_cmp(b))", "q.first()", "q.get(9)",
    "q[0].powi(2)", "q[0].powi(-2147483648)", "q[0].powi(i32::MAX)", "q[0].powi(n)", "v[0].powf(q[0])", "q[0].sqrt()",
    "q[0].sin_cos().1", "q[0].atan2(v[0])", "q[0].hypot(v[0])", "q[0].mul_add(v[0], 1.0)", "q[0].clamp(1.0, -1.0)",
    "q[0].min(v[0])", "q[0].abs()", "q[0].signum()", "q[0].copysign(v[0])", "q[0].exp_m1()", "f64::cosh(q[0])",
    "q[0].partial_cmp(&v[0])", "q[0] < v[0]", "q[0] == q[0] && v[0] != 0.0", "!true", "1 << 64", "1 / 0", "0 % 0", "-128i8 / -1",
    "i32::MIN.abs()", "usize::MAX + 1", "0usize - 1", "2usize.pow(70)", "1.0 / 0.0", "q[0] % 2.0", "q[0] as i32", "300 as u8 as f64",
    "-1i32 as usize", "f64::INFINITY as u8", "{ let x = q[0]; x * x }", "if q[0] > 0.0 { q[0] } else { -q[0] }",
    "match q { [a, b] => a * b, _ => 0.0 }", "match 3 { 0 => 1.0, 1..=5 => 2.0, _ => 3.0 }", "(|x: f64| x * x)(q[0])",
    "{ let f = |x: f64, n: usize| if n == 0 { x } else { x * x }; f(q[0], 3) }", "return q[0]", "break", "continue", "loop {}",
    "loop { break q[0] }", "'a: { break 'a 1.0 }", "while true {}", "unsafe { q[0] }", "async { q[0] }", "println!(\"{}\", q[0])",
    "Self::helper(q[0])", "self.helper(q[0])", "self.lagrangian(q, v)", "Self::K", "std::f64::consts::PI", "helper(q[0])",
    "Some(q[0]).unwrap_or(0.0)", "q[0]?", "q[0].await", "&mut q", "*&q[0]", "&&q[0]", "(q, v).0[0]", "[q[0], v[0]][1]", "q[[0][0]]",
    "q[usize::MAX]", "q[q[0] as usize]", "vec![q[0]]", "Box::new(q[0])", "System { k: q[0] }.k", "const { 1.0 }", "x", "t", "u", "u[0]",
];

/// Statements.
pub const STATEMENTS: &[&str] = &[
    "let x = q[0];", "let mut x = 0.0;", "let [a, b] = q;", "let (a, b) = (q[0], v[0]);", "let x: f64;", "let _ = q;", "let ref x = q;",
    "let [first, .., last] = q;", "let [x @ ..] = v;", "let Some(x) = Some(q[0]) else { return 0.0 };", "let mut y = q;", "y[0] = v[0];",
    "x += q[0];", "x *= x;", "x = x;", "y[9] = 0.0;", "self.k = 1.0;", "let n = 3;", "n += 1;", "let mut n = 0;",
    "for i in 0..3 { x += q[i % 2]; }", "for i in 0..usize::MAX { x += 1.0; }", "for (i, v) in v.iter().enumerate() { x += v * i as f64; }",
    "for q in &mut y { *q *= 2.0; }", "while n < 3 { n += 1; }", "while x < 3.0 { x += q[0]; }", "loop { n += 1; if n > 3 { break; } }",
    "'a: loop { loop { break 'a; } }", "if q[0] > 0.0 { x = q[0]; } else { x = v[0]; }", "if q[0] > 0.0 { return v[0]; }",
    "match n { 0 => x = 1.0, _ => {} }", "const C: f64 = 2.0;", "use std::f64::consts::PI;", "fn inner() {}", "struct Inner;", ";",
    "let f = |x: f64| x * q[0];", "let f = |f: f64| f;", "macro_rules! m { () => {} }", "{ let x = 1.0; x };", "return;",
    "let (s, c) = q[0].sin_cos();", "let q = v;", "let v = q.map(|x| x + 1.0);", "let mut a = [[0.0; 2]; 2]; a[1][0] += q[0];",
];

/// Items of a block.
pub const FUNCTIONS: &[&str] = &[
    "fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 { 0.5 * v[0] * v[0] + 0.5 * v[1] * v[1] - q[0] * q[1] }",
    "fn rayleigh(&self, v: [f64; 2]) -> f64 { 0.5 * self.k * v[0] * v[0] }",
    "fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 { q[0] * v[0].powi(2) }",
    "fn rayleigh(&self, v: [f64; 2], t: f64) -> f64 { t * v[0].powi(2) }",
    "fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] { [v[1], -q[0]] }",
    "fn force(&self, q: [f64; 2], v: [f64; 2], u: [f64; 1]) -> [f64; 2] { [u[0], v[0]] }",
    "fn force(&self, q: [f64; 2], v: [f64; 2], u: [f64; 3], t: f64) -> [f64; 2] { [u[2] * t, v[0]] }",
    "fn helper(&self, x: f64) -> f64 { x * x }",
    "fn helper(x: f64) -> f64 { Self::helper(x) }",
    "fn helper<T>(x: T) -> T { x }",
    "fn helper(x: f64) -> (f64, [f64; 2]) { (x, [x; 2]) }",
    "const K: f64 = 2.0;",
    "const N: usize = 2;",
    "type T = f64;",
    "fn driven() {}",
];

/// Types of parameters and results.
pub const TYPES: &[&str] = &[
    "f64", "f32", "usize", "[f64; 1]", "[f64; 2]", "[f64; 3]", "[f64; 0]", "[f64; N]", "[f64; Self::N]", "[f64; 1 + 1]", "[f32; 2]",
    "[f64; 18446744073709551616]", "[f64; 65]", "[[f64; 2]; 2]", "(f64, f64)", "()", "&[f64]", "&[f64; 2]", "&f64", "!", "Self", "impl Fn(f64) -> f64",
    "bool", "i32", "String", "[f64; _]", "_", "dyn Copy", "fn(f64) -> f64",
];

/// Options of the attribute.
pub const OPTIONS: &[&str] = &[
    "", "rule = midpoint", "rule = trapezoidal", "rule = gauss", "rule = fitted", "rule = one_sided", "rule = fitted_trapezoidal",
    "rule = [midpoint, trapezoidal, gauss]", "rule = [fitted, one_sided]", "rule = []", "derivatives = expanded", "derivatives = num_dual",
    "derivatives = auto", "parameters = [k]", "parameters = [k, m[0]]", "parameters = [q]", "parameters = []",
    "step_derivatives = second", "rule = [midpoint, trapezoidal], parameters = [k], step_derivatives = second", "rule = midpoint, rule = gauss",
    "parameters = k.0.1, derivatives = num_dual", "rules", "= 3",
];

/// Single tokens.
pub const TOKENS: &[&str] = &[
    "q", "v", "self", "Self", "f64", "f32", "usize", "0", "1", "2", "0.5", "+", "-", "*", "/", "%", "=", "<", ">", "!", "&", "|", ".", ",",
    ";", ":", "::", "..", "..=", "=>", "->", "?", "#", "'a", "_", "mut", "ref", "let", "if", "else", "match", "for", "while", "loop", "in",
    "return", "break", "fn", "impl", "const", "unsafe", "async", "move", "as", "r#fn", "powi", "sin", "sum", "iter", "map", "lagrangian",
    "rayleigh", "force", "System", "Real", "D", "Dual", "()", "[]", "{}", "\"s\"", "b'x'", "1u8", "1e400", "340282366920938463463374607431768211456",
];
