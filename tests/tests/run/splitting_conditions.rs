//! The conditions of order of the splittings: by trees, to the digits published, and with damping.

use dalembert::Splitting;
use double_double::DoubleDouble;

type Number = DoubleDouble;

/// An elementary differential of q̈ = g(q): a derivative of g, of which so many arguments are q̇ and the
/// others elementary differentials themselves, by their place in a list.
///
/// E. Hairer, S. P. Nørsett and G. Wanner, Solving Ordinary Differential Equations I, II.14.
struct Tree {
    order: usize,
    velocities: usize,
    forces: Vec<usize>,
}

/// Those up to an order, by order.
fn trees(order: usize) -> Vec<Tree> {
    /// Adds those of this order that hold `chosen` and, of `left` more, trees from `from` on.
    fn grow(
        all: &[Tree],
        order: usize,
        left: usize,
        from: usize,
        chosen: &mut Vec<usize>,
        found: &mut Vec<Tree>,
    ) {
        found.push(Tree { order, velocities: left, forces: chosen.clone() });
        for (i, tree) in all.iter().enumerate().skip(from) {
            if tree.order < left {
                chosen.push(i);
                grow(all, order, left - 1 - tree.order, i, chosen, found);
                chosen.pop();
            }
        }
    }
    let mut all = Vec::new();
    for order in 1..=order {
        let mut found = Vec::new();
        grow(&all, order, order - 1, 0, &mut Vec::new(), &mut found);
        all.extend(found);
    }
    all
}

/// What is left of the conditions of each order, the largest, from 1 to `order`.
fn left_of_conditions(kicks: &[Number], nodes: &[Number], order: usize) -> Vec<f64> {
    let all = trees(order);
    let one = Number::new(1.0);
    let mut weights: Vec<Vec<Number>> = Vec::new();
    // Along the motion a tree of order k + 1 is such a multiple of the time to the power k.
    let mut exact: Vec<Number> = Vec::new();
    let mut left = vec![0.0_f64; order + 1];
    for tree in &all {
        let (mut weight, mut share): (Vec<Number>, _) =
            (nodes.iter().map(|node| node.powi(tree.velocities as i32)).collect(), one);
        for &force in &tree.forces {
            let k = all[force].order as f64;
            share = share * exact[force] / Number::new(k * (k + 1.0));
            for (i, weight) in weight.iter_mut().enumerate() {
                let moved = (0..i)
                    .fold(Number::ZERO, |sum, j| sum + kicks[j] * (nodes[i] - nodes[j]) * weights[force][j]);
                *weight = *weight * moved;
            }
        }
        let sum = |of: &dyn Fn(usize) -> Number| {
            (0..kicks.len()).fold(Number::ZERO, |sum, i| sum + kicks[i] * of(i) * weight[i])
        };
        let k = tree.order as f64;
        let in_velocity = sum(&|_| one) - share / Number::new(k);
        let in_position = sum(&|i| one - nodes[i]) - share / Number::new(k * (k + 1.0));
        left[tree.order - 1] = left[tree.order - 1].max(in_velocity.high.abs());
        left[tree.order] = left[tree.order].max(in_position.high.abs());
        weights.push(weight);
        exact.push(share);
    }
    left.truncate(order);
    left
}

/// The kicks and where they are, from what begins a step.
fn kicks_and_nodes(drifts: &[Number], kicks: &[Number]) -> [Vec<Number>; 2] {
    let drifts_first = drifts.len() > kicks.len();
    let mut at = Number::ZERO;
    let mut nodes = Vec::new();
    for i in 0..kicks.len() {
        if drifts_first {
            at = at + drifts[i];
        } else if i > 0 {
            at = at + drifts[i - 1];
        }
        nodes.push(at);
    }
    [kicks.to_vec(), nodes]
}

/// (drifts, kicks), with what closes the step.
fn whole<const S: usize>(splitting: Splitting<S>) -> [Vec<Number>; 2] {
    let numbers = |shares: &[f64; S]| shares.map(Number::new).to_vec();
    let (mut drifts, mut kicks) = (numbers(splitting.drifts()), numbers(splitting.kicks()));
    let closed = if S == 19 { &mut drifts } else { &mut kicks };
    closed.push(closed[0]);
    [drifts, kicks]
}

#[test]
fn the_trees_are_as_many_as_are_known() {
    let all = trees(8);
    let count = |order| all.iter().filter(|tree| tree.order == order).count();
    // Hairer, Nørsett and Wanner, table II.14.1.
    assert_eq!([1, 2, 3, 4, 5, 6, 7, 8].map(count), [1, 1, 2, 3, 6, 10, 20, 36]);
}

#[test]
fn the_conditions_hold_to_rounding_up_to_the_order_and_not_beyond() {
    fn check<const S: usize>(splitting: Splitting<S>) {
        let [drifts, kicks] = whole(splitting);
        let [kicks, nodes] = kicks_and_nodes(&drifts, &kicks);
        let order = splitting.order() as usize;
        let left = left_of_conditions(&kicks, &nodes, order + 1);
        assert!(left[..order].iter().all(|left| *left < 2e-15), "{order}: {left:?}");
        assert!(left[order] > 1e-6, "{order}: {left:?}");
    }
    check(Splitting::blanes_moan_4());
    check(Splitting::blanes_moan_6());
    check(Splitting::blanes_casas_escorihuela_8());
}

/// A₁₉ as published.
const DRIFTS: [&str; 9] = [
    "0.0505805",
    "0.149999",
    "-0.0551795510771615573511026950361",
    "0.423755898835337951482264998051",
    "-0.213495353584659048059672194633",
    "-0.0680769774574032619111630736274",
    "0.227917056974013435948887201671",
    "-0.235373619381058906524740047732",
    "0.387413869179878047816794031058",
];
const KICKS: [&str; 9] = [
    "0.129478606560536730662493794395",
    "0.222257260092671143423043559581",
    "-0.0577514893325147204757023246320",
    "-0.0578312262103924910221345032763",
    "0.103087297437175356747933252265",
    "-0.140819612554090768205554103887",
    "0.0234462603492826276699713718626",
    "0.134854517356684096617882205068",
    "0.0287973821073779306345172160211",
];

fn decimal(text: &str) -> Number {
    let (sign, digits) = match text.strip_prefix("-0.") {
        Some(digits) => (-1.0, digits),
        None => (1.0, text.strip_prefix("0.").unwrap()),
    };
    let (mut value, mut unit) = (Number::ZERO, Number::new(1.0));
    for digit in digits.bytes() {
        unit = unit / Number::new(10.0);
        value = value + unit * Number::new(f64::from(digit - b'0'));
    }
    value * Number::new(sign)
}

/// (drifts, kicks) of A₁₉ to 30 digits.
fn published() -> [Vec<Number>; 2] {
    let [mut drifts, mut kicks] = [DRIFTS, KICKS].map(|digits| digits.map(decimal).to_vec());
    let sum = |shares: &[Number]| shares.iter().fold(Number::ZERO, |sum, share| sum + *share);
    drifts.push(Number::new(0.5) - sum(&drifts));
    let mirrored: Vec<_> = drifts.iter().rev().copied().collect();
    drifts.extend(mirrored);
    let middle = Number::new(1.0) - sum(&kicks) * Number::new(2.0);
    let mirrored: Vec<_> = kicks.iter().rev().copied().collect();
    kicks.push(middle);
    kicks.extend(mirrored);
    [drifts, kicks]
}

#[test]
fn the_published_digits_meet_the_conditions_of_order_8() {
    let [drifts, kicks] = published();
    let [weights, nodes] = kicks_and_nodes(&drifts, &kicks);
    let left = left_of_conditions(&weights, &nodes, 9);
    assert!(left[..8].iter().all(|left| *left < 2e-30), "{left:?}");
    assert!(left[8] > 1e-6, "{left:?}");
    // What is stepped with are these, rounded.
    for (published, used) in [drifts, kicks].iter().zip(whole(Splitting::blanes_casas_escorihuela_8())) {
        assert_eq!(published.len(), used.len());
        for (published, used) in published.iter().zip(used) {
            assert!((*published - used).high.abs() < 1e-16, "{used:?}");
        }
    }
    // Control: the last digit of one of them is missed.
    let mut spoilt = nodes.clone();
    spoilt[4] = spoilt[4] + Number::new(1e-28);
    let left = left_of_conditions(&weights, &spoilt, 8);
    assert!(left.iter().any(|left| *left > 4e-30), "{left:?}");
}

/// (q, p) with M = diag(1, ⅔): q̈ᵢ is the force less what C = (0.9, −0.4; −0.4, 1.3) takes, over the mass.
type Phase = [Number; 4];

/// The exponential of the drift's field over `time`, by its series.
fn drift(time: Number) -> [[Number; 4]; 4] {
    let number = Number::new;
    let per_mass = [number(1.0), number(1.5)];
    let damping = [[0.9, -0.4], [-0.4, 1.3]];
    let mut field = [[Number::ZERO; 4]; 4];
    for i in 0..2 {
        field[i][i + 2] = per_mass[i];
        for j in 0..2 {
            field[i + 2][j + 2] = -(number(damping[i][j]) * per_mass[j]);
        }
    }
    let mut sum: [[Number; 4]; 4] =
        std::array::from_fn(|i| std::array::from_fn(|j| number(f64::from(u8::from(i == j)))));
    let mut term = sum;
    for k in 1..30 {
        let share = time / number(f64::from(k));
        term = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                (0..4).fold(Number::ZERO, |sum, l| sum + term[i][l] * field[l][j]) * share
            })
        });
        for (row, term) in sum.iter_mut().zip(&term) {
            for (entry, term) in row.iter_mut().zip(term) {
                *entry = *entry + *term;
            }
        }
    }
    sum
}

/// A coupled anharmonic potential, and a force without one.
fn force([q0, q1, ..]: &Phase) -> [Number; 2] {
    let number = Number::new;
    let stretch = *q1 - *q0;
    let pull = stretch + stretch * stretch * stretch;
    [pull - *q0 + *q0 * *q1 * number(0.3), -pull - *q1 * *q1 * number(0.7) - *q0 * number(0.2)]
}

/// The end after time 1 in so many steps.
fn end([drifts, kicks]: &[Vec<Number>; 2], steps: u32) -> Phase {
    let h = Number::new(1.0) / Number::new(f64::from(steps));
    let flows: Vec<_> = drifts.iter().map(|share| drift(*share * h)).collect();
    let mut y = [0.7, -0.3, 0.5, 0.4].map(Number::new);
    for _ in 0..steps {
        for (i, flow) in flows.iter().enumerate() {
            y = flow.map(|row| (0..4).fold(Number::ZERO, |sum, j| sum + row[j] * y[j]));
            if let Some(kick) = kicks.get(i) {
                let force = force(&y);
                y[2] = y[2] + *kick * h * force[0];
                y[3] = y[3] + *kick * h * force[1];
            }
        }
    }
    y
}

/// With friction that does not commute with the masses, and no rounding in sight: the conditions of the
/// undamped system suffice.
#[test]
fn damping_leaves_order_8_as_it_is() {
    let order = |shares: &[Vec<Number>; 2]| {
        let [coarse, middle, fine] = [16, 32, 64].map(|steps| end(shares, steps));
        let gap =
            |a: &Phase, b: &Phase| a.iter().zip(b).fold(0.0_f64, |x, (a, b)| x.max((*a - *b).high.abs()));
        (gap(&coarse, &middle) / gap(&middle, &fine)).log2()
    };
    let shares = published();
    let found = order(&shares);
    assert!((found - 8.0).abs() < 0.05, "{found}");
    // Control: two kicks in 1e-6 of which the sum is kept, and the symmetry.
    let [drifts, mut kicks] = shares;
    for (i, change) in [(0, 1e-6), (18, 1e-6), (5, -1e-6), (13, -1e-6)] {
        kicks[i] = kicks[i] + Number::new(change);
    }
    let spoilt = order(&[drifts, kicks]);
    assert!((spoilt - 2.0).abs() < 0.2, "{spoilt}");
}
