//! What the code of a program computed.

/// Values and derivatives at one point.
#[derive(Clone, Debug, Default)]
pub struct Computed {
    /// L, R and f of the plain functions; nothing where one of them panicked.
    pub plain: Option<Vec<f64>>,
    /// The same of the functions that the attribute leaves, where they stand beside plain ones.
    pub own: Option<Vec<f64>>,
    /// L, R and f of the generated code, from each function that tells a value.
    pub values: Vec<(&'static str, Vec<f64>)>,
    /// Gradients by (q, v) of L, R and every component of f.
    pub gradients: Vec<Vec<f64>>,
    /// Hessians of L and R, row by row.
    pub hessians: Vec<Vec<f64>>,
    /// Differences of the plain copy, and of the generated gradients: those of a row, then their errors.
    pub slopes: Vec<Vec<f64>>,
    pub curvatures: Vec<Vec<f64>>,
    /// Whether a run would tell that derivatives belong to another function.
    pub is_told: bool,
    /// Of each lane 0 where it is not what its member does alone, else 1, or 2 where it was moved; nothing
    /// where a member panicked.
    pub lanes: Option<Vec<f64>>,
}
