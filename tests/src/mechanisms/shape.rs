//! Mechanisms as data: what is joined to what, and by which numbers.

/// A constraint, by the bodies that it joins. Numbers are those of its [`JointValues`]: a factor u, a
/// length ℓ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Joint {
    /// A rod, u ½(|xᵢ − xⱼ|² − ℓ²).
    Square(usize, usize),
    /// A rod, u (|xᵢ − xⱼ| − ℓ).
    Length(usize, usize),
    /// A rod to a point of the ground, u ½(|xᵢ − a|² − ℓ²).
    Ground(usize),
    /// A rail or a plane, u (a·xᵢ − ℓ).
    Plane(usize),
    /// A hinge of two bars, first line: u (xᵢ + s cos θᵢ − xⱼ − s′ cos θⱼ).
    HingeAlong(usize, usize),
    /// Its second line, with y and the sine.
    HingeAcross(usize, usize),
    /// A pin of a bar in the ground, first line: u (xᵢ + s cos θᵢ − a₁).
    PinAlong(usize),
    /// Its second line, with y, the sine and a₂.
    PinAcross(usize),
}

/// A force, by the bodies between which it acts. Numbers are those of its [`ForceValues`]: k, r, c, a
/// place a.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Force {
    /// A spring with a dashpot: V = ½k(|d| − r)², R = ½c (d·ḋ)²/|d|², d = xᵢ − xⱼ.
    Spring(usize, usize),
    /// A spring to a place: V = ½k|xᵢ − a|² + ¼r|xᵢ − a|⁴.
    Tether(usize),
    /// A spring and friction in a joint of two bars: V = ½k(θᵢ − θⱼ − r)², R = ½c(ωᵢ − ωⱼ)².
    Twist(usize, usize),
}

/// What a mechanism is made of.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    /// Its name.
    pub name: &'static str,
    /// Coordinates of a body: its place, and an angle if it is a bar.
    pub per_body: usize,
    /// Coordinates of a place.
    pub space: usize,
    /// The constraints.
    pub joints: &'static [Joint],
    /// The forces.
    pub forces: &'static [Force],
}

/// Numbers of a constraint.
#[derive(Clone, Copy, Debug, Default)]
pub struct JointValues {
    /// u: its unit, or 0 for none.
    pub unit: f64,
    /// ℓ.
    pub length: f64,
    /// s and s′, the places of a hinge along its bars.
    pub along: [f64; 2],
    /// a.
    pub place: [f64; 3],
}

impl JointValues {
    /// In the order of the system's field.
    #[must_use]
    pub fn numbers(&self) -> [f64; 7] {
        let Self { unit, length, along: [first, second], place: [x, y, z] } = *self;
        [unit, length, first, second, x, y, z]
    }
}

/// Numbers of a force.
#[derive(Clone, Copy, Debug, Default)]
pub struct ForceValues {
    /// k, r, c.
    pub numbers: [f64; 3],
    /// a.
    pub place: [f64; 3],
}

impl ForceValues {
    /// In the order of the system's field.
    #[must_use]
    pub fn numbers(&self) -> [f64; 6] {
        let Self { numbers: [k, r, c], place: [x, y, z] } = *self;
        [k, r, c, x, y, z]
    }
}

/// The numbers of a mechanism.
#[derive(Clone, Debug)]
pub struct Values {
    /// Of each coordinate.
    pub mass: Vec<f64>,
    /// R = ½cv² of each coordinate.
    pub drag: Vec<f64>,
    /// R = ¼cv⁴ of each coordinate.
    pub cubic: Vec<f64>,
    /// L = m g·x of each body.
    pub gravity: [f64; 3],
    /// Of each constraint.
    pub joints: Vec<JointValues>,
    /// Of each force.
    pub forces: Vec<ForceValues>,
}
