//! The second program beside a third: steps in angles, without constraints, and a reference in 40 digits.

use double_double::DoubleDouble;

use super::elimination::{Factors, Rows};
use super::equations::{Rule, dot};
use super::oracle::{Curve, Equations, Problem, numbers};
use super::{Joint, JointValues, Shape, Values};

/// Points in a row in the plane, each on a rod of length 1 from the one before, the first from 0.
const ROW: Shape = Shape {
    name: "row",
    per_body: 2,
    space: 2,
    joints: &[Joint::Ground(0), Joint::Square(0, 1), Joint::Length(1, 2)],
    forces: &[],
};

fn values(mass: Vec<f64>, drag: f64, gravity: [f64; 3], joints: usize) -> Values {
    let count = mass.len();
    let rod = JointValues { unit: 1.0, length: 1.0, ..JointValues::default() };
    let joints = vec![rod; joints];
    Values { mass, drag: vec![drag; count], cubic: vec![0.3 * drag; count], gravity, joints, forces: vec![] }
}

fn places(angles: &[DoubleDouble]) -> (Vec<DoubleDouble>, Rows) {
    let (mut at, mut q, mut turns) = ([DoubleDouble::ZERO; 2], Vec::new(), Rows::new());
    for angle in angles {
        let (sine, cosine) = angle.sin_cos();
        at = [at[0] + cosine, at[1] + sine];
        q.extend(at);
        turns.push(vec![-sine, cosine]);
    }
    (q, turns)
}

/// The step in the angles of the rods, Tᵀ(p0(v̄) − p) = 0 with T = ∂q/∂angles at q0, which has neither
/// constraints nor multipliers, is that in the places.
#[test]
fn a_row_of_rods_steps_as_its_angles_do() {
    let values = values(vec![1.0, 1.0, 0.4, 0.4, 2.0, 2.0], 0.2, [0.0, -9.81, 0.0], 3);
    let start: Vec<DoubleDouble> = numbers(&[0.4, -0.9, 1.3]);
    let (q, turns) = places(&start);
    let h = 0.04;
    // On the circle to 32 digits, not to 16: the two are compared as they are.
    let rates = [0.7, -0.4, 1.1].map(DoubleDouble::new);
    let mut v = [DoubleDouble::ZERO; 6];
    for (j, (turn, rate)) in turns.iter().zip(rates).enumerate() {
        (j..3).for_each(|i| (0..2).for_each(|a| v[2 * i + a] = v[2 * i + a] + turn[a] * rate));
    }
    let p: Vec<DoubleDouble> = v.iter().zip(&values.mass).map(|(v, m)| *v * DoubleDouble::new(*m)).collect();
    let rounded = |of: &[DoubleDouble]| of.iter().map(|x| x.high).collect::<Vec<_>>();
    for rule in [Rule::Midpoint, Rule::Trapezoidal] {
        let (q_rounded, p_rounded) = (rounded(&q), rounded(&p));
        let problem = Problem { shape: &ROW, values: &values, rule, q: &q_rounded, p: &p_rounded, h };
        let mut equations = Equations::of(problem);
        (equations.q, equations.p) = (q.clone(), p.clone());
        (equations.g0, equations.directions) = ROW.constraints(&values, &q);
        let Curve::Root(root) = equations.followed() else { panic!("the curve ends") };
        let left = |angles: &[DoubleDouble]| -> Vec<DoubleDouble> {
            let (end, _) = places(angles);
            let v: Vec<DoubleDouble> =
                end.iter().zip(&q).map(|(end, q)| (*end - *q) / DoubleDouble::new(h)).collect();
            let [p0, _] = equations.momenta(&v, 1.0);
            let off: Vec<DoubleDouble> = p0.iter().zip(&p).map(|(p0, p)| *p0 - *p).collect();
            (0..3)
                .map(|j| {
                    (j..3).fold(DoubleDouble::ZERO, |sum, i| sum + dot(&turns[j], &off[2 * i..2 * i + 2]))
                })
                .collect()
        };
        let mut angles = start.clone();
        for _ in 0..8 {
            let now = left(&angles);
            let mut rows = vec![vec![DoubleDouble::ZERO; 3]; 3];
            for j in 0..3 {
                let mut moved = angles.clone();
                moved[j] = moved[j] + DoubleDouble::new(1e-12);
                for (row, (after, now)) in rows.iter_mut().zip(left(&moved).iter().zip(&now)) {
                    row[j] = (*after - *now) / DoubleDouble::new(1e-12);
                }
            }
            let correction = Factors::of(rows).unwrap().solve(&now);
            angles.iter_mut().zip(correction).for_each(|(angle, by)| *angle = *angle - by);
        }
        let end = equations.end(&root.x[..6], 1.0);
        for (end, other) in end.iter().zip(places(&angles).0) {
            assert!((*end - other).high.abs() < 1e-26, "{rule:?}: {:e}", (*end - other).high);
        }
        // Positive control: the motion is no straight line.
        assert!((end[5] - (q[5] + DoubleDouble::new(h) * v[5])).high.abs() > 1e-4);
    }
}

/// A step of another program in 40 digits, of a mass of 1.3 on the unit sphere.
#[test]
fn a_step_on_the_sphere_is_that_of_the_reference() {
    let sphere = Shape { name: "sphere", per_body: 3, space: 3, joints: &[Joint::Ground(0)], forces: &[] };
    let mut values = values(vec![1.3; 3], 0.4, [0.0, 0.0, -9.81], 1);
    values.cubic = vec![0.0; 3];
    let ((a, b), (da, db)) = ((1.1_f64, 0.2_f64), (0.4, 1.5));
    let q = [a.sin() * b.cos(), a.sin() * b.sin(), -a.cos()];
    let v = [
        a.cos() * b.cos() * da - a.sin() * b.sin() * db,
        a.cos() * b.sin() * da + a.sin() * b.cos() * db,
        a.sin() * da,
    ];
    let p = v.map(|v| 1.3 * v);
    let problem = Problem { shape: &sphere, values: &values, rule: Rule::Midpoint, q: &q, p: &p, h: 0.05 };
    let equations = Equations::of(problem);
    let root = equations.root_next_to(&v).unwrap();
    let reference = [0.8623077318288648, 0.2424778317902618, -0.4445558195755084];
    for (end, reference) in equations.end(&root.x[..3], 1.0).iter().zip(reference) {
        assert!((end.high - reference).abs() < 3e-16, "{:e}", end.high - reference);
    }
}
