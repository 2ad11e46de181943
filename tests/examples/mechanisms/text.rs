//! Shapes of mechanisms at random, as the text of programs.

use std::fmt::Write as _;

use dalembert_tests::draws::Draws;

/// Families of shapes, in the order in which seeds take them.
const FAMILIES: [Family; 10] = [
    Family::Chain,
    Family::Tree,
    Family::Loop,
    Family::BarChain,
    Family::Strip,
    Family::BarLoop,
    Family::Slider,
    Family::Net,
    Family::Doubled,
    Family::SpatialTree,
];

/// What a shape is like.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Family {
    /// Points in a row, hung at one end.
    Chain,
    /// Points, each on one before it.
    Tree,
    /// Points in a row between two places of the ground: four-bars, six-bars, taut ropes.
    Loop,
    /// Bars in a row, pinned at one end.
    BarChain,
    /// Triangles side by side.
    Strip,
    /// Bars in a row, pinned at both ends.
    BarLoop,
    /// A chain whose last point is held by a rail or a plane.
    Slider,
    /// Four points with all six rods in the plane, one of them redundant, and points hung from them.
    Net,
    /// A chain with rods that are said twice, once as a length.
    Doubled,
    /// A tree in space with a tetrahedron.
    SpatialTree,
}

impl Family {
    fn name(self) -> &'static str {
        match self {
            Self::Chain => "chain",
            Self::Tree => "tree",
            Self::Loop => "loop",
            Self::BarChain => "chain of bars",
            Self::Strip => "triangles",
            Self::BarLoop => "loop of bars",
            Self::Slider => "slider",
            Self::Net => "net",
            Self::Doubled => "doubled rods",
            Self::SpatialTree => "tetrahedron",
        }
    }
}

/// A shape as text.
pub struct Text {
    /// The name of its family.
    pub family: &'static str,
    /// The name of the system.
    pub name: String,
    /// Coordinates.
    pub coordinates: usize,
    /// Constraints.
    pub constraints: usize,
    /// The declaration.
    pub declared: String,
}

/// Joints by kind.
#[derive(Default)]
struct Joints {
    rods: Vec<(usize, usize)>,
    lengths: Vec<(usize, usize)>,
    grounds: Vec<usize>,
    planes: Vec<usize>,
    hinges: Vec<(usize, usize)>,
    pins: Vec<usize>,
}

impl Joints {
    /// A rod, by its square or by its length.
    fn rod(&mut self, i: usize, j: usize, draws: &mut Draws) {
        if draws.below(4) == 0 { self.lengths.push((i, j)) } else { self.rods.push((i, j)) }
    }

    fn count(&self) -> usize {
        let Self { rods, lengths, grounds, planes, hinges, pins } = self;
        rods.len() + lengths.len() + grounds.len() + planes.len() + 2 * hinges.len() + 2 * pins.len()
    }
}

impl Text {
    /// The shape of this seed.
    pub fn of(seed: u64) -> Self {
        let mut draws = Draws::new(seed.wrapping_mul(0x9e37) + 11);
        let family = FAMILIES[seed as usize % FAMILIES.len()];
        let is_bars = matches!(family, Family::BarChain | Family::BarLoop);
        let space = match family {
            Family::SpatialTree => 3,
            Family::Chain | Family::Tree | Family::Slider | Family::Doubled => 2 + draws.below(2),
            _ => 2,
        };
        let per = if is_bars { 3 } else { space };
        let mut bodies = 2 + draws.below(7);
        let mut joints = Joints::default();
        match family {
            Family::Chain | Family::Slider | Family::Doubled => {
                joints.grounds.push(0);
                (1..bodies).for_each(|i| joints.rod(i - 1, i, &mut draws));
                if family == Family::Slider {
                    joints.planes.push(bodies - 1);
                }
                if family == Family::Doubled {
                    let again = draws.below(bodies - 1);
                    joints.rods.push((again, again + 1));
                    joints.lengths.push((0, 1));
                }
            }
            Family::Tree => {
                joints.grounds.push(0);
                for i in 1..bodies {
                    joints.rod(draws.below(i), i, &mut draws);
                }
            }
            Family::Loop => {
                (1..bodies).for_each(|i| joints.rod(i - 1, i, &mut draws));
                joints.grounds.extend([0, bodies - 1]);
            }
            Family::Strip => {
                bodies = bodies.max(3);
                joints.rod(0, 1, &mut draws);
                for i in 2..bodies {
                    joints.rod(i - 2, i, &mut draws);
                    joints.rod(i - 1, i, &mut draws);
                }
                joints.grounds.push(0);
            }
            Family::Net => {
                bodies = bodies.clamp(4, 6);
                for i in 0..4 {
                    (0..i).for_each(|j| joints.rod(j, i, &mut draws));
                }
                for i in 4..bodies {
                    joints.rod(draws.below(i), i, &mut draws);
                }
                joints.grounds.push(0);
            }
            Family::SpatialTree => {
                bodies = bodies.max(5);
                for i in 0..4 {
                    (0..i).for_each(|j| joints.rod(j, i, &mut draws));
                }
                for i in 4..bodies {
                    joints.rod(draws.below(i), i, &mut draws);
                }
                joints.grounds.push(bodies - 1);
            }
            Family::BarChain | Family::BarLoop => {
                if family == Family::BarLoop {
                    bodies = bodies.max(3);
                }
                joints.hinges.extend((1..bodies).map(|i| (i - 1, i)));
                joints.pins.push(0);
                if family == Family::BarLoop {
                    joints.pins.push(bodies - 1);
                }
            }
        }
        let (mut springs, mut twists) = (Vec::new(), Vec::new());
        for i in 1..bodies {
            if is_bars {
                twists.push((i - 1, i));
            } else if i > 1 && draws.below(2) == 0 {
                springs.push((i - 2, i));
            }
        }
        let tethers: Vec<usize> = (0..bodies).filter(|_| draws.below(4) == 0).collect();
        let (coordinates, constraints) = (per * bodies, joints.count());
        let forces = springs.len() + tethers.len() + twists.len();
        let name = format!("S{seed}");
        let mut declared = format!(
            "dalembert_tests::mechanism! {{\n    /// {}.\n    {name}: {coordinates} coordinates, \
             {per} of a body in {space}, {constraints} joints, {forces} forces,\n",
            family.name()
        );
        let Joints { rods, lengths, grounds, planes, hinges, pins } = joints;
        let mut k = 0;
        let mut list = |kind: &str, width: usize, of: Vec<String>| {
            write!(declared, "    {kind} [").expect("a string takes all");
            for bodies in of {
                let numbers: Vec<String> = (k..k + width).map(|k| k.to_string()).collect();
                write!(declared, "({}: {bodies})", numbers.join(" ")).expect("a string takes all");
                k += width;
            }
            declared.push_str("]\n");
            k
        };
        let pair = |of: &[(usize, usize)]| of.iter().map(|(i, j)| format!("{i} {j}")).collect::<Vec<_>>();
        let single = |of: &[usize]| of.iter().map(ToString::to_string).collect::<Vec<_>>();
        list("square", 1, pair(&rods));
        list("length", 1, pair(&lengths));
        list("ground", 1, single(&grounds));
        list("plane", 1, single(&planes));
        list("hinge", 2, pair(&hinges));
        let all = list("pin", 2, single(&pins));
        assert_eq!(all, constraints, "each constraint has a number");
        k = 0;
        let mut list = |kind: &str, of: Vec<String>| {
            write!(declared, "    {kind} [").expect("a string takes all");
            for bodies in of {
                write!(declared, "({k}: {bodies})").expect("a string takes all");
                k += 1;
            }
            declared.push_str("]\n");
        };
        list("spring", pair(&springs));
        list("tether", single(&tethers));
        list("twist", pair(&twists));
        declared.push_str("}\n");
        Self { family: family.name(), name, coordinates, constraints, declared }
    }
}
