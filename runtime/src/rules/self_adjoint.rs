//! The marker of rules that a step back undoes.

/// A self-adjoint rule: its step of −h undoes its step of h, Φ₋ₕ = Φₕ⁻¹. Its order is even, and
/// [`Composition`](crate::Composition)s raise it.
///
/// A rule of one's own states it where its nodes and weights are symmetric about ½. Nothing checks it: a
/// composition of a rule for which it is false has the order of the rule, not that of the composition.
///
/// ```compile_fail
/// use dalembert::{Composition, OneSided};
/// let _ = Composition::kahan_li_6(OneSided); // its step back is another rule's
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not stated to be self-adjoint",
    label = "compositions raise the order of self-adjoint rules alone",
    note = "where the step of −h undoes the step of h, as with nodes symmetric about ½, state it: `impl dalembert::rules::SelfAdjoint for {Self} {{}}`"
)]
pub trait SelfAdjoint {}
